#include "sim_controller/val3_system.hpp"

#include <cmath>
#include <utility>

#include "sim_controller/operator.hpp"
#include "sim_controller/val3_units.hpp"

namespace sim {
namespace {

constexpr double kClockStepsPerSecond = 1000.0;
constexpr int kPowerUpTicks = static_cast<int>(kPowerUpSeconds / kTickSeconds);
constexpr int kConnectionStatus = 1;

/// The number of hold is another one in each mode (manual 6, page 102).
int status_of_hold(cs8::WorkingMode mode) {
  switch (mode) {
    case cs8::WorkingMode::kManual:
      return 6;
    case cs8::WorkingMode::kTest:
      return 3;
    case cs8::WorkingMode::kLocal:
    case cs8::WorkingMode::kRemote:
      return 2;
    case cs8::WorkingMode::kNone:
      break;
  }
  return 0;
}

std::string two_digits(unsigned value) {
  return {static_cast<char>('0' + value / 10 % 10), static_cast<char>('0' + value % 10)};
}

}  // namespace

Val3System::Val3System(const Plant& plant, Cabinet& cabinet, Val3SystemOptions options)
    : plant_(plant),
      cabinet_(cabinet),
      options_(std::move(options)),
      arm_(plant, options_.wrist_to_flange_m),
      signals_(options_.links, options_.cards),
      motion_{.from = cabinet.drives.joints, .to = cabinet.drives.joints} {
  options_.versions.emplace("ArmType", plant.arm_name + "-S1");
  options_.versions.emplace("ArmSN", plant.arm_serial);
}

CabinetTick Val3System::tick() {
  ++ticks_;
  power_up();
  const bool had_failed = cabinet_.drives.error != 0;
  CabinetTick seen = sim::tick(plant_, cabinet_, program_leave(cabinet_.panel));
  motion_ = seen.motion;
  if (!had_failed && !why_move_failed().empty())
    keep("error " + std::to_string(cabinet_.drives.error) + ": " + why_move_failed());
  watch_latch(seen);
  return seen;
}

void Val3System::end_application() {
  for (int id = 0; id < channels_.count(); ++id) channels_.at(id).close();
  sim::reset_motion(cabinet_.drives);
  latch_ = {};
}

double Val3System::clock_s() const {
  const double s = options_.clock_s + static_cast<double>(ticks_) * kTickSeconds;
  return std::round(s * kClockStepsPerSecond) / kClockStepsPerSecond;
}

// ---- inputs and outputs, channels ----

std::optional<int> Val3System::find_digital(std::string_view link) { return signals_.find_digital(link); }
std::optional<int> Val3System::find_analogue(std::string_view link) { return signals_.find_analogue(link); }
bool Val3System::digital(int id) const { return signals_.digital(id, cabinet_); }
val3::RunError Val3System::set_digital(int id, bool on) { return signals_.write(id, on); }
double Val3System::analogue(int id) const { return signals_.analogue(id); }
val3::RunError Val3System::set_analogue(int id, double value) { return signals_.write(id, value); }

std::optional<int> Val3System::find_channel(std::string_view link) { return channels_.find(link); }
bool Val3System::connect(int channel) { return channels_.at(channel).connect(); }
bool Val3System::peer_is_gone(int channel) const {
  return channels_.at(channel).peer() == Val3Channel::Peer::kGone;
}
std::size_t Val3System::waiting(int channel) const { return channels_.at(channel).waiting(); }
std::size_t Val3System::receive(int channel, std::span<std::uint8_t> bytes) {
  return channels_.at(channel).receive(bytes);
}
std::size_t Val3System::send(int channel, std::span<const std::uint8_t> bytes) {
  return channels_.at(channel).send(bytes);
}
bool Val3System::close(int channel) { return channels_.at(channel).close(); }
double Val3System::channel_timeout_s(int channel) const { return channels_.at(channel).timeout_s(); }
std::uint8_t Val3System::end_of_string(int channel) const { return channels_.at(channel).end_of_string(); }
int Val3System::set_channel(int channel, std::string_view name, std::optional<double> number,
                            std::optional<bool> truth, const std::string* text) {
  const int answer = channels_.at(channel).set(name, number, truth, text);
  if (name == "clients" && number.value_or(0.0) > 1.0 && told_clients_.insert(channel).second)
    keep(channels_.at(channel).link() + ": sioCtrl gives " + std::to_string(answer) +
         " to more than one of clients: one is simulated");
  return answer;
}

// ---- latch ----

val3::RunError Val3System::arm_latch(int digital) {
  if (!signals_.has_latch(digital)) return val3::kErrorParameter;
  if (signals_.cell_signal(digital) == CellSignal::kContact) draw_for_search();
  latch_ = {.armed = digital, .was_on = signals_.digital(digital, cabinet_), .joints = {}};
  return val3::kErrorNone;
}

std::optional<val3::Joint> Val3System::latched() const {
  if (!latch_.joints) return std::nullopt;
  return val3_from_joints(*latch_.joints);
}

/// What differs from one touch to the next is drawn where a search begins: with the latch armed, at
/// standstill. A search that no joint move parts from the one before belongs to the same touch: it finds arm
/// and face as the first did.
void Val3System::draw_for_search() {
  if (cabinet_.drives.rate != 0.0 || searched_) return;
  begin_search(plant_, cabinet_.world, cabinet_.chance);
  searched_ = true;
}

/// The probe knows its edge to 0.2 ms; an input that a script sets changes between two ticks.
void Val3System::watch_latch(const CabinetTick& seen) {
  if (!latch_.armed) return;
  std::optional<double> share;
  if (signals_.cell_signal(*latch_.armed) == CellSignal::kContact) {
    share = seen.sensed.edge_share;
  } else {
    const bool is_on = signals_.digital(*latch_.armed, cabinet_);
    if (is_on && !latch_.was_on) share = 1.0;
    latch_.was_on = is_on;
  }
  if (!share) return;
  latch_.joints = encoder_reading(plant_, seen.motion.at(*share));
  latch_.armed.reset();
}

// ---- panel ----

int Val3System::working_mode() const { return static_cast<int>(cabinet_.panel.mode); }

int Val3System::mode_status() const {
  const Panel& panel = cabinet_.panel;
  if (panel.held) return status_of_hold(panel.mode);
  if (is_connecting(cabinet_.drives)) return kConnectionStatus;
  return panel.mode_status;
}

int Val3System::emergency_stop() const { return cabinet_.panel.emergency_stop; }
bool Val3System::is_powered() const { return cabinet_.panel.powered; }
bool Val3System::is_calibrated() const { return cabinet_.panel.arm_calibrated; }

void Val3System::enable_power() {
  const bool may = cabinet_.panel.mode == cs8::WorkingMode::kRemote && cabinet_.panel.emergency_stop == 0;
  if (may && !cabinet_.panel.powered && !power_up_ticks_) power_up_ticks_ = kPowerUpTicks;
}

void Val3System::disable_power() {
  power_up_ticks_.reset();
  cabinet_.panel.powered = false;
}

void Val3System::power_up() {
  if (!power_up_ticks_) return;
  if (cabinet_.panel.emergency_stop != 0 || cabinet_.panel.mode != cs8::WorkingMode::kRemote) {
    power_up_ticks_.reset();
  } else if (--*power_up_ticks_ <= 0) {
    power_up_ticks_.reset();
    cabinet_.panel.powered = true;
  }
}

double Val3System::monitor_speed() const { return cabinet_.panel.monitor_speed_percent; }

int Val3System::set_monitor_speed(double percent) {
  constexpr int kTaken = 0, kNotRemote = -1, kOwnedByOperator = -2, kOutOfRange = -3;
  if (cabinet_.panel.mode != cs8::WorkingMode::kRemote) return kNotRemote;
  if (options_.operator_owns_monitor_speed) return kOwnedByOperator;
  if (!(percent >= 0.0 && percent <= 100.0)) return kOutOfRange;
  cabinet_.panel.monitor_speed_percent = static_cast<std::int32_t>(std::lround(percent));
  return kTaken;
}

std::string Val3System::version(std::string_view item) const {
  const auto known = options_.versions.find(item);
  return known == options_.versions.end() ? std::string() : known->second;
}

std::string Val3System::date(const std::string& format) const {
  const auto passed = std::chrono::duration<double>(static_cast<double>(ticks_) * kTickSeconds);
  return date_text(format, options_.date + std::chrono::floor<std::chrono::seconds>(passed));
}

// ---- user page ----

void Val3System::show_page(bool) { page_.show(); }
void Val3System::clear_page() { page_.clear(); }
void Val3System::go_to(int column, int row) { page_.go_to(column, row); }
void Val3System::put(const std::string& text, bool new_line) { page_.put(text, new_line); }
void Val3System::title(const std::string& text) { page_.set_title(text); }
void Val3System::set_page_element(const std::string& name, const std::string& text) {
  page_.set_element(name, text);
}
std::optional<int> Val3System::take_key() { return page_.take_key(); }
bool Val3System::key_is_pressed(int code) const { return page_.is_pressed(code); }
void Val3System::pop_up(const std::string& text) { keep(text); }
void Val3System::log(const std::string& text) { keep(text); }

void Val3System::keep(const std::string& message) {
  if (messages_.size() == kMessagesMax) messages_.pop_front();
  messages_.push_back(message);
  if (options_.log) options_.log(message);
}

std::string date_text(const std::string& format, std::chrono::sys_seconds at) {
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(at - day);
  const auto hour = static_cast<unsigned>(time.hours().count());
  const std::string year = std::to_string(static_cast<int>(date.year()));
  std::string text;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] != '%' || i + 1 == format.size()) {
      text += format[i];
      continue;
    }
    switch (format[++i]) {
      case 'y':
        text += two_digits(static_cast<unsigned>(static_cast<int>(date.year())) % 100);
        break;
      case 'Y':
        text += year;
        break;
      case 'm':
        text += two_digits(static_cast<unsigned>(date.month()));
        break;
      case 'd':
        text += two_digits(static_cast<unsigned>(date.day()));
        break;
      case 'H':
        text += two_digits(hour);
        break;
      case 'I':
        text += two_digits(hour % 12 == 0 ? 12 : hour % 12);
        break;
      case 'p':
        text += hour < 12 ? "AM" : "PM";
        break;
      case 'M':
        text += two_digits(static_cast<unsigned>(time.minutes().count()));
        break;
      case 'S':
        text += two_digits(static_cast<unsigned>(time.seconds().count()));
        break;
      default:
        text += '%';
        text += format[i];
    }
  }
  return text;
}

}  // namespace sim
