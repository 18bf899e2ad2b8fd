#include "tests/twins/host.hpp"

#include <deque>
#include <optional>
#include <utility>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/jog.hpp"
#include "sim_controller/link_faults.hpp"

namespace twins {
namespace {

constexpr int kHeartbeatTicks = 25;
/// A host tries again when the controller has not seen the end of the last connection yet.
constexpr int kConnectTicksMax = 500;
constexpr double kLastSeconds = 0.5;
constexpr cs8::Hello kHello{.heartbeat_timeout_ms = 500};

/// What the arm and the probe did since the last look.
class CabinetEyes {
 public:
  std::vector<Moment> look(const sim::Cabinet& cabinet) {
    std::vector<Moment> seen;
    const auto note = [&seen](bool& was, bool is, std::optional<Moment> on, std::optional<Moment> off) {
      if (is && !was && on) seen.push_back(*on);
      if (!is && was && off) seen.push_back(*off);
      was = is;
    };
    note(moves_, cabinet.drives.rate > 0.0, Moment::kMoveBegins, Moment::kMoveEnds);
    note(is_tripped_, cabinet.world.probe.inputs.contact, Moment::kProbeTrips, std::nullopt);
    note(is_open_, !cabinet.world.probe.inputs.loop, Moment::kLoopOpens, std::nullopt);
    note(rests_, cabinet.arm_rests(), Moment::kArmRests, std::nullopt);
    note(is_free_, cabinet.probe_free(), Moment::kProbeIsFree, std::nullopt);
    return seen;
  }

 private:
  bool moves_ = false;
  bool is_tripped_ = false;
  bool is_open_ = false;
  bool rests_ = true;
  bool is_free_ = true;
};

class HostScript {
 public:
  HostScript(const Scenario& scenario, Twin& twin) : scenario_(scenario), twin_(twin) {}

  Record run() {
    prepare_cell();
    std::size_t next = 0;
    while (next < scenario_.steps.size()) {
      if (std::visit([this](const auto& step) { return take(step); }, scenario_.steps[next])) {
        ++next;
        begun_at_.reset();
      } else {
        tick();
      }
    }
    for (double left = kLastSeconds; left > 0.0; left -= sim::kTickSeconds) tick();
    record_.joints = sim::wire_from_joints(twin_.cabinet().drives.joints);
    for (const Watched& at : watched_) {
      if (at.left > 0) record_.unfired.push_back("moment " + std::to_string(static_cast<int>(at.at.moment)));
    }
    return std::move(record_);
  }

 private:
  struct Watched {
    At at;
    int left = 0;
  };
  struct Due {
    Deed deed;
    int ticks = 0;
  };
  struct Late {
    cs8::Message message;
    int ticks = 0;
  };

  // ---- the cell before the host comes ----

  void prepare_cell() {
    twin_.person().duties = {
        .powers_up = false, .touches_probe = false, .confirms = scenario_.confirms, .frees_arm = false};
    twin_.person().confirms_after_s = scenario_.confirms_after_s;
    seconds(0.1);
    if (scenario_.touch_tested) {
      act(sim::Act::kTouchStylus);
      seconds(0.1);
      act(sim::Act::kReleaseStylus);
      seconds(0.1);
    }
    if (scenario_.powered) act(sim::Act::kPowerOn);
    seconds(0.1);
  }

  void act(sim::Act act) { twin_.plan().add({.what = act}); }
  void seconds(double s) {
    for (double left = s; left > sim::kTickSeconds / 2.0; left -= sim::kTickSeconds) tick();
  }

  // ---- steps: true when done ----

  bool take(const Connect& step) {
    if (twin_.is_connected()) return true;
    if (twin_.connect()) {
      was_connected_ = true;
      twin_.plan().faults_at_connection();
      if (step.says_hello) send(0, kHello);
      return true;
    }
    return has_waited(kConnectTicksMax * sim::kTickSeconds, "no connection");
  }
  bool take(const Disconnect&) {
    disconnect();
    return true;
  }
  bool take(const Send& step) {
    send(step.sequence, step.payload);
    return true;
  }
  bool take(const Await& step) {
    while (!inbox_.empty()) {
      const cs8::Message message = inbox_.front();
      inbox_.pop_front();
      if (cs8::type_of(message) == step.type) return true;
    }
    return !twin_.is_connected() ||
           has_waited(step.within_s, std::string("no ") + std::string(cs8::name(step.type)));
  }
  bool take(const AwaitResult& step) {
    while (!inbox_.empty()) {
      const cs8::Message message = inbox_.front();
      inbox_.pop_front();
      if (message.sequence == step.sequence && cs8::type_of(message) != cs8::MessageType::kAccepted)
        return true;
    }
    return !twin_.is_connected() || has_waited(step.within_s, "no result");
  }
  bool take(const Wait& step) { return has_waited(step.seconds, ""); }
  bool take(const Heartbeats& step) {
    heartbeats_ = step.on;
    return true;
  }
  bool take(const SecondClient&) {
    note(twin_.connect() ? "a second host was taken" : "a second host was refused");
    return true;
  }
  bool take(const Strike& step) {
    twin_.plan().add({.what = step.what});
    return true;
  }
  bool take(const Jog& step) {
    if (const auto refused = sim::begin_jog(plant(), twin_.cabinet(), step.order))
      note("no jog: " + *refused);
    return true;
  }
  bool take(const At& step) {
    watched_.push_back({step, step.nth});
    return true;
  }

  bool has_waited(double s, const std::string& if_over) {
    if (!begun_at_) begun_at_ = ticks_;
    if (static_cast<double>(ticks_ - *begun_at_) * sim::kTickSeconds < s) return false;
    if (!if_over.empty()) note(if_over);
    return true;
  }

  // ---- time ----

  void tick() {
    twin_.tick();
    ++ticks_;
    give_late();
    look_at_link();
    if (heartbeats_ && is_welcome_ && ticks_ % kHeartbeatTicks == 0) send(0, cs8::Heartbeat{});
    strike();
  }

  void strike() {
    for (const Moment moment : eyes_.look(twin_.cabinet())) {
      if (moment == Moment::kProbeTrips || moment == Moment::kLoopOpens)
        record_.trips_s.push_back(twin_.clock_s());
      for (Watched& watched : watched_) {
        if (watched.at.moment == moment && watched.left > 0 && --watched.left == 0)
          due_.push_back({watched.at.deed, watched.at.ticks_after});
      }
    }
    std::vector<Due> later;
    for (Due& due : std::exchange(due_, {})) {
      if (due.ticks-- > 0) {
        later.push_back(due);
      } else {
        std::visit([this](const auto& deed) { do_it(deed); }, due.deed);
      }
    }
    due_.insert(due_.end(), later.begin(), later.end());
  }
  void do_it(const Send& deed) {
    if (twin_.is_connected()) send(deed.sequence, deed.payload);
  }
  void do_it(const Disconnect&) { disconnect(); }
  /// The last one goes now: both twins count the silence from here.
  void do_it(const Heartbeats& deed) {
    if (is_welcome_) send(0, cs8::Heartbeat{});
    heartbeats_ = deed.on;
  }
  void do_it(const Strike& deed) { twin_.plan().add({.what = deed.what}); }

  // ---- the link ----

  void disconnect() {
    twin_.disconnect();
    was_connected_ = is_welcome_ = is_cut_ = false;
    late_.clear();
    inbox_.clear();
    heartbeats_ = true;
  }

  /// With the faults that apply to what is on its way.
  void send(std::uint32_t sequence, const cs8::Payload& payload) {
    if (!twin_.is_connected() || is_cut_) return;
    cs8::Message message{sequence, payload};
    int copies = 1;
    for (const sim::LinkFault& fault : twin_.plan().faults_at(cs8::type_of(message))) {
      if (fault.kind == sim::Fault::kCloseSocket) return disconnect();
      if (fault.kind == sim::Fault::kDrop) copies = 0;
      if (fault.kind == sim::Fault::kDelay) {
        late_.push_back({message, static_cast<int>(fault.seconds / sim::kTickSeconds)});
        copies = 0;
      }
      if (fault.kind == sim::Fault::kDuplicate) copies = 2;
      sim::alter_message(fault.kind, message, std::nullopt);
    }
    for (int i = 0; i < copies; ++i) twin_.give(message);
    look_at_link();
  }

  /// Messages that a fault has held up; they go with their connection.
  void give_late() {
    for (Late& late : std::exchange(late_, {})) {
      if (late.ticks-- > 0)
        late_.push_back(late);
      else if (twin_.is_connected() && !is_cut_)
        twin_.give(late.message);
    }
  }

  void look_at_link() {
    take_messages();
    if (!was_connected_ || twin_.is_connected()) return;
    record_.entries.push_back({now_s(), Closed{}});
    was_connected_ = is_welcome_ = is_cut_ = false;
    late_.clear();
  }

  void take_messages() {
    for (cs8::Message& message : twin_.take()) {
      if (is_cut_) continue;
      if (const auto* state = std::get_if<cs8::State>(&message.payload)) {
        record_.states.push_back({now_s(), *state});
        continue;
      }
      record_.entries.push_back({now_s(), message});
      is_welcome_ = is_welcome_ || std::holds_alternative<cs8::Welcome>(message.payload);
      inbox_.push_back(message);
      for (const sim::LinkFault& fault : twin_.plan().faults_at(cs8::type_of(message))) {
        if (fault.kind == sim::Fault::kDrop) inbox_.pop_back();
        if (fault.kind == sim::Fault::kCloseSocket) return disconnect();
        is_cut_ = is_cut_ || fault.kind == sim::Fault::kHalfOpen;
      }
    }
  }

  void note(const std::string& what) { record_.entries.push_back({now_s(), Noted{what}}); }
  [[nodiscard]] double now_s() const { return static_cast<double>(ticks_) * sim::kTickSeconds; }

  const Scenario& scenario_;
  Twin& twin_;
  Record record_;
  CabinetEyes eyes_;
  std::vector<Watched> watched_;
  std::vector<Due> due_;
  std::vector<Late> late_;
  std::deque<cs8::Message> inbox_;
  std::int64_t ticks_ = 0;
  std::optional<std::int64_t> begun_at_;
  bool heartbeats_ = true;
  bool was_connected_ = false;
  bool is_welcome_ = false;
  bool is_cut_ = false;  // as with the cable pulled: nothing passes, and nobody was told
};

}  // namespace

Record carry_out(const Scenario& scenario, Twin& twin) { return HostScript(scenario, twin).run(); }

}  // namespace twins
