#include "tests/twins/comparison.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <optional>
#include <set>
#include <tuple>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/cabinet.hpp"
#include "tests/twins/twin.hpp"

namespace twins {
namespace {

/// Both sides have 0.1 s for each answer (PROTOCOL.md 5); the VAL3 application sends each 20 ms.
constexpr double kAnswerSeconds = 0.1;
/// A result, and what stands behind one, comes after moves: their speeds are caps (PROTOCOL.md 4, touch), and
/// how an arm gets to them is its descriptor's, which has no acceleration of the tool (manual 6, page 155).
/// The C++ twin's has.
constexpr double kMovesSeconds = 1.2;
/// A trigger is in the cycle that saw it or in the next.
constexpr double kTriggerSeconds = 0.009;
/// Two latch steps of 0.2 ms, and what the warmth of the arm and the encoders' step add. Both twins touch the
/// same face with the same draw of chance.
constexpr double kLatchSecondsOff = 0.0004;
constexpr double kContactMetres = 1e-6;
/// A polled position is late by up to a cycle of 4 ms (PROTOCOL.md 4, sources).
constexpr double kPolledSecondsOff = 0.008;
/// From a cause to the brakes a controller has 20 ms (PROTOCOL.md 5, Stop), and the ramps differ.
constexpr double kBrakeSeconds = 0.030;
constexpr double kTravelMetresPerSecond = 0.25;
constexpr double kApproachMetresPerSecond = 0.02;
constexpr double kSearchMetresPerSecond = 0.008;
constexpr std::int64_t kOvertravelDmm = 700;  // 8 ms of the search
/// An arm at the end of a move stands where the wire's micro-degrees say.
constexpr double kArrivedMetres = 2e-6;
/// What a State shows for a shorter time may fall between two of them: one each 20 ms, made by tasks that
/// answer within 0.1 s.
constexpr double kShownSeconds = 0.1;

double place_off_m(const cs8::JointsMicrodeg& a, const cs8::JointsMicrodeg& b) {
  return sim::tip_distance_m(plant(), sim::joints_from_wire(a), sim::joints_from_wire(b));
}

double broken_off_tolerance_m(cs8::Phase phase) {
  if (phase == cs8::Phase::kIdle) return kArrivedMetres;
  return kBrakeSeconds * (phase == cs8::Phase::kTravel ? kTravelMetresPerSecond : kApproachMetresPerSecond);
}

class Comparison {
 public:
  Comparison(const Record& fast, const Record& val3) : fast_(fast), val3_(val3) {}

  std::vector<Difference> run() {
    compare_entries();
    compare_states();
    const double off_m = place_off_m(fast_.joints, val3_.joints);
    if (off_m > end_tolerance_m_) differ_in_place("place", off_m, end_tolerance_m_);
    for (const std::string& moment : fast_.unfired) differ("unfired", moment, "");
    for (const std::string& moment : val3_.unfired) differ("unfired", "", moment);
    return std::move(found_);
  }

 private:
  void differ(const std::string& where, const std::string& fast, const std::string& val3) {
    found_.push_back({where, fast, val3});
  }

  void differ_in_place(const std::string& where, double off_m, double tolerance_m) {
    differ(where, std::to_string(off_m * 1e3) + " mm off",
           "tolerance " + std::to_string(tolerance_m * 1e3) + " mm");
  }

  // ---- messages ----

  static std::string kind_of(const Entry& entry) {
    if (std::holds_alternative<Closed>(entry.what)) return "closed";
    if (const auto* noted = std::get_if<Noted>(&entry.what)) return noted->what;
    return std::string(cs8::name(cs8::type_of(std::get<cs8::Message>(entry.what))));
  }

  static std::string kind_at(const std::vector<Entry>& entries, std::size_t i) {
    return i < entries.size() ? kind_of(entries[i]) : "nothing";
  }

  /// A result and the Permit that its cause ends, the other way round.
  bool swapped(std::size_t i) const {
    const std::string first = kind_at(fast_.entries, i);
    const std::string second = kind_at(fast_.entries, i + 1);
    return (first == "permit" || second == "permit") && first == kind_at(val3_entries_, i + 1) &&
           second == kind_at(val3_entries_, i);
  }

  void compare_entries() {
    const std::size_t count = std::max(fast_.entries.size(), val3_.entries.size());
    double fast_s = 0.0;
    double val3_s = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string fast = kind_at(fast_.entries, i);
      const std::string val3 = kind_at(val3_entries_, i);
      if (fast != val3) {
        if (!swapped(i)) return differ("order", fast, val3);
        differ("swapped", fast, val3);
        std::swap(val3_entries_[i], val3_entries_[i + 1]);
      }
      const Entry& a = fast_.entries[i];
      const Entry& b = val3_entries_[i];
      const double tolerance_s = a.at_s - fast_s > kAnswerSeconds ? kMovesSeconds : kAnswerSeconds;
      if (std::abs((a.at_s - fast_s) - (b.at_s - val3_s)) > tolerance_s)
        differ("time." + fast, std::to_string(a.at_s - fast_s), std::to_string(b.at_s - val3_s));
      fast_s = a.at_s;
      val3_s = b.at_s;
      if (std::holds_alternative<Closed>(a.what))
        end_tolerance_m_ = broken_off_tolerance_m(cs8::Phase::kApproach);
      if (const auto* message = std::get_if<cs8::Message>(&a.what))
        compare(fast, *message, std::get<cs8::Message>(b.what));
    }
  }

  void compare(const std::string& kind, const cs8::Message& a, const cs8::Message& b) {
    const std::vector<Field> of_a = fields_of(a);
    const std::vector<Field> of_b = fields_of(b);
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      const Field& x = of_a[i];
      const Field& y = of_b[i];
      const auto begins = [&x](const char* with) { return x.name.starts_with(with); };
      // Places and instants are compared elsewhere.
      if (begins("clock_ms") || begins("stopped") || begins("joints") || begins("contact") ||
          begins("first_contact"))
        continue;
      const std::int64_t tolerance = begins("overtravel") ? kOvertravelDmm : 0;
      if (std::abs(x.value - y.value) > tolerance)
        differ(kind + "." + x.name, std::to_string(x.value), std::to_string(y.value));
    }
    compare_places(kind, a, b);
  }

  void compare_contacts(const cs8::TouchResult& a, const cs8::TouchResult& b) {
    const auto compare = [this](const char* name, cs8::CaptureSource source, double speed_m_s,
                                const cs8::JointsMicrodeg& x, const cs8::JointsMicrodeg& y) {
      const double seconds = source == cs8::CaptureSource::kLatched ? kLatchSecondsOff : kPolledSecondsOff;
      const double tolerance_m = seconds * speed_m_s + kContactMetres;
      const double off_m = place_off_m(x, y);
      if (off_m > tolerance_m) differ_in_place(name, off_m, tolerance_m);
    };
    const double speed_m_s = a.search_speed_um_s * 1e-6;
    compare("touch_result.contact", a.source, speed_m_s, a.contact, b.contact);
    compare("touch_result.first_contact", a.first_source, kSearchMetresPerSecond, a.first_contact,
            b.first_contact);
    compare_trigger(fast_, a);
    compare_trigger(val3_, b);
  }

  /// Each twin's clock against its own probe.
  void compare_trigger(const Record& record, const cs8::TouchResult& touched) {
    if (touched.contact_clock_ms == 0) return;
    const double at_s = touched.contact_clock_ms * 1e-3 - kStartSeconds;
    const bool is_one = std::ranges::any_of(
        record.trips_s, [at_s](double trip_s) { return std::abs(at_s - trip_s) < kTriggerSeconds; });
    if (!is_one) differ("touch_result.contact_clock_ms", std::to_string(at_s), "no trip then");
  }

  void compare_places(const std::string& kind, const cs8::Message& a, const cs8::Message& b) {
    double off_m = 0.0;
    double tolerance_m = 0.0;
    if (const auto* touched = std::get_if<cs8::TouchResult>(&a.payload)) {
      compare_contacts(*touched, std::get<cs8::TouchResult>(b.payload));
      off_m = place_off_m(touched->stopped, std::get<cs8::TouchResult>(b.payload).stopped);
      end_tolerance_m_ = broken_off_tolerance_m(touched->phase);
      // Behind a trigger it is the place of the stop, two ticks more or less.
      tolerance_m = std::max(end_tolerance_m_, kBrakeSeconds * touched->search_speed_um_s * 1e-6);
    } else if (const auto* moved = std::get_if<cs8::MoveResult>(&a.payload)) {
      off_m = place_off_m(moved->joints, std::get<cs8::MoveResult>(b.payload).joints);
      tolerance_m = end_tolerance_m_ = broken_off_tolerance_m(moved->phase);
    }
    if (off_m > tolerance_m) differ_in_place(kind + ".place", off_m, tolerance_m);
  }

  // ---- what States show ----

  using Channel = std::function<std::int64_t(const cs8::State&)>;

  struct Shown {
    std::int64_t value = 0;
    double from_s = 0.0;
    double to_s = 0.0;

    [[nodiscard]] bool is_short() const { return to_s - from_s < kShownSeconds; }
  };

  static std::vector<Shown> shown(const Record& record, const Channel& channel) {
    std::vector<Shown> all;
    for (const Record::SeenState& seen : record.states) {
      const std::int64_t value = channel(seen.state);
      if (all.empty() || all.back().value != value) all.push_back({value, seen.at_s, seen.at_s});
      all.back().to_s = seen.at_s;
    }
    return all;
  }

  /// The same values one after another; what was there shortly need not be seen by both.
  class Alignment {
   public:
    Alignment(const std::vector<Shown>& a, const std::vector<Shown>& b) : a_(a), b_(b) {}

    bool exists(std::size_t i = 0, std::size_t j = 0, std::optional<std::int64_t> last = {}) {
      if (i == a_.size() && j == b_.size()) return true;
      if (!tried_.insert({i, j, last}).second) return false;
      const auto may_pass = [last](const std::vector<Shown>& all, std::size_t at) {
        return at < all.size() && (all[at].is_short() || all[at].value == last);
      };
      if (i < a_.size() && j < b_.size() && a_[i].value == b_[j].value && exists(i + 1, j + 1, a_[i].value))
        return true;
      return (may_pass(a_, i) && exists(i + 1, j, last)) || (may_pass(b_, j) && exists(i, j + 1, last));
    }

   private:
    const std::vector<Shown>& a_;
    const std::vector<Shown>& b_;
    std::set<std::tuple<std::size_t, std::size_t, std::optional<std::int64_t>>> tried_;
  };

  void compare_channel(const std::string& name, const Channel& channel) {
    const auto fast = shown(fast_, channel);
    const auto val3 = shown(val3_, channel);
    const auto text = [](const std::vector<Shown>& all) {
      std::string joined;
      for (const Shown& it : all) joined += std::to_string(it.value) + (it.is_short() ? "' " : " ");
      return joined;
    };
    if (!Alignment(fast, val3).exists()) differ("state." + name, text(fast), text(val3));
  }

  void compare_states() {
    compare_channel("phase", [](const cs8::State& s) { return static_cast<std::int64_t>(s.phase); });
    compare_channel("active_sequence", [](const cs8::State& s) { return s.active_sequence; });
    compare_channel("permit", [](const cs8::State& s) { return static_cast<std::int64_t>(s.permit); });
    compare_channel("mode", [](const cs8::State& s) { return static_cast<std::int64_t>(s.mode); });
    compare_channel("emergency_stop", [](const cs8::State& s) { return s.emergency_stop; });
    compare_channel("monitor_speed", [](const cs8::State& s) { return s.monitor_speed_percent; });
    compare_channel("task_error", [](const cs8::State& s) { return s.task_error; });
    compare_channel("overruns", [](const cs8::State& s) { return s.overruns; });
    compare_channel("session", [](const cs8::State& s) { return s.session; });
    for (const auto& [name, bit] : {std::pair{"powered", cs8::kPowered},
                                    {"held", cs8::kHeld},
                                    {"arm_calibrated", cs8::kArmCalibrated},
                                    {"settled", cs8::kSettled},
                                    {"queue_empty", cs8::kQueueEmpty},
                                    {"probe_touched", cs8::kProbeTouched},
                                    {"retract_due", cs8::kRetractDue},
                                    {"probe_loop_closed", cs8::kProbeLoopClosed},
                                    {"touch_tested", cs8::kTouchTested},
                                    {"cell_closed", cs8::kCellClosed}}) {
      compare_channel(name, [bit = bit](const cs8::State& s) { return (s.flags & bit) != 0 ? 1 : 0; });
    }
  }

  const Record& fast_;
  const Record& val3_;
  std::vector<Entry> val3_entries_ = val3_.entries;
  std::vector<Difference> found_;
  double end_tolerance_m_ = kArrivedMetres;
};

}  // namespace

std::vector<Difference> differences(const Record& fast, const Record& val3) {
  return Comparison(fast, val3).run();
}

std::string side_by_side(const Record& fast, const Record& val3) {
  std::string text;
  for (std::size_t i = 0; i < std::max(fast.entries.size(), val3.entries.size()); ++i) {
    text += "  C++  " + (i < fast.entries.size() ? text_of(fast.entries[i]) : std::string("-")) + "\n";
    text += "  VAL3 " + (i < val3.entries.size() ? text_of(val3.entries[i]) : std::string("-")) + "\n";
  }
  return text;
}

}  // namespace twins
