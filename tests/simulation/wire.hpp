#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cs8_protocol/messages.hpp"

namespace simulation {

/// One direction of a connection, read along: frames in, messages out. Behind bytes that are no frame it
/// reads no more until the next connection.
class WireReader {
 public:
  explicit WireReader(std::function<void(const cs8::Message&)> on_message)
      : on_message_(std::move(on_message)) {}

  void take(std::span<const std::uint8_t> bytes);
  void begin_connection();

 private:
  std::function<void(const cs8::Message&)> on_message_;
  std::vector<std::uint8_t> bytes_;
  bool is_lost_ = false;
};

}  // namespace simulation
