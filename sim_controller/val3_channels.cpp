#include "sim_controller/val3_channels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {
namespace {

/// Answers of sioCtrl.
enum Answer : int {
  kTaken = 0,
  kUnknownName = -1,
  kWrongType = -2,
  kRefused = -3,
  kBusy = -4,
  kNotForThis = -5
};

enum class SettingType { kNumber, kTruth, kText };

struct Setting {
  std::string_view name;
  SettingType type;
  bool of_sockets;
  bool of_serial;
};

constexpr Setting kSettings[] = {
    {"port", SettingType::kNumber, true, false},       {"target", SettingType::kText, true, false},
    {"clients", SettingType::kNumber, true, false},    {"nagle", SettingType::kTruth, true, false},
    {"endOfString", SettingType::kNumber, true, true}, {"timeout", SettingType::kNumber, true, true},
    {"baudRate", SettingType::kNumber, false, true},   {"parity", SettingType::kText, false, true},
    {"bits", SettingType::kNumber, false, true},       {"stopBits", SettingType::kNumber, false, true},
    {"mode", SettingType::kText, false, true},         {"flowControl", SettingType::kText, false, true},
};

bool is_whole(double number, double from, double to) {
  return number >= from && number <= to && number == std::floor(number);
}

/// A serial port is always active and has its cable.
bool names_serial_port(std::string_view link) {
  const std::size_t slash = link.find('\\');
  return link.substr(0, slash).starts_with("Serial");
}

}  // namespace

Val3Channel::Val3Channel(std::string link) : link_(std::move(link)), is_socket_(!names_serial_port(link_)) {
  if (!is_socket_) {
    is_active_ = true;
    peer_ = Peer::kConnected;
  }
}

bool Val3Channel::connect() {
  is_active_ = true;
  is_requested_ = peer_ == Peer::kNone;
  return peer_ == Peer::kConnected;
}

std::size_t Val3Channel::receive(std::span<std::uint8_t> bytes) {
  const std::size_t count = std::min(bytes.size(), in_.size());
  const auto end = in_.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(in_.begin(), end, bytes.begin());
  in_.erase(in_.begin(), end);
  return count;
}

std::size_t Val3Channel::send(std::span<const std::uint8_t> bytes) {
  if (peer_ != Peer::kConnected) return 0;
  const std::size_t count = std::min(bytes.size(), kBufferedMax - std::min(kBufferedMax, out_.size()));
  out_.insert(out_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

bool Val3Channel::close() {
  in_.clear();
  is_requested_ = false;
  if (!is_socket_) return true;
  return std::exchange(peer_, Peer::kNone) != Peer::kNone;
}

int Val3Channel::set(std::string_view name, std::optional<double> number, std::optional<bool> truth,
                     const std::string* text) {
  const auto* setting = std::ranges::find(kSettings, name, &Setting::name);
  if (setting == std::end(kSettings)) return kUnknownName;
  if (!(is_socket_ ? setting->of_sockets : setting->of_serial)) return kNotForThis;
  const bool fits = setting->type == SettingType::kNumber  ? number.has_value()
                    : setting->type == SettingType::kTruth ? truth.has_value()
                                                           : text != nullptr;
  if (!fits) return kWrongType;
  if (is_socket_ && peer_ != Peer::kNone) return kBusy;
  if (name == "timeout") {
    if (!(*number >= 0.0 || *number == -1.0) || std::isinf(*number)) return kRefused;
    timeout_s_ = *number;
  } else if (name == "endOfString") {
    if (!is_whole(*number, 0.0, 255.0)) return kRefused;
    end_of_string_ = static_cast<std::uint8_t>(*number);
  } else if (name == "clients") {
    if (*number != 1.0) return kRefused;
  } else if (name == "port") {
    if (!is_whole(*number, 0.0, 65'535.0)) return kRefused;
    port_ = static_cast<std::uint16_t>(*number);
  } else if (name == "nagle") {
    nagle_ = *truth;
  } else if (name == "target") {
    target_ = *text;
  }
  return kTaken;
}

bool Val3Channel::accept() {
  if (peer_ != Peer::kNone) return false;
  peer_ = Peer::kConnected;
  is_requested_ = false;
  in_.clear();
  out_.clear();
  return true;
}

std::size_t Val3Channel::give(std::span<const std::uint8_t> bytes) {
  if (peer_ != Peer::kConnected) return 0;
  const std::size_t count = std::min(bytes.size(), room());
  in_.insert(in_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

std::vector<std::uint8_t> Val3Channel::take() { return std::exchange(out_, {}); }

void Val3Channel::leave() {
  if (peer_ == Peer::kConnected) peer_ = Peer::kGone;
}

std::optional<int> Val3Channels::find(std::string_view link) {
  if (link.empty()) return std::nullopt;
  if (const auto known = ids_.find(link); known != ids_.end()) return known->second;
  if (channels_.size() >= kChannelsMax) return std::nullopt;
  const int id = count();
  channels_.emplace_back(std::string(link));
  ids_.emplace(link, id);
  return id;
}

std::optional<int> Val3Channels::known(std::string_view name) const {
  if (const auto link = ids_.find(name); link != ids_.end()) return link->second;
  std::optional<int> found;
  for (const auto& [link, id] : ids_) {
    if (link.substr(link.rfind('\\') + 1) != name) continue;
    if (found) return std::nullopt;
    found = id;
  }
  return found;
}

}  // namespace sim
