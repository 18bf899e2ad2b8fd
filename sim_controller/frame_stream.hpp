#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cs8_protocol/messages.hpp"

namespace sim {

/// One direction of a connection for who only looks on: its bytes cut into frames. What is no frame goes
/// through as it came, and so does all that follows it.
class FrameStream {
 public:
  struct Piece {
    std::vector<std::uint8_t> bytes;
    std::optional<cs8::Message> message;  // nothing for bytes that are no valid frame
  };

  /// What is complete with these bytes. The rest waits; it is shorter than a frame.
  std::vector<Piece> feed(std::span<const std::uint8_t> bytes);
  /// The part of a frame that waits, at the end of the connection.
  std::vector<std::uint8_t> take_rest();
  /// Another connection begins.
  void reset() { *this = {}; }

 private:
  std::vector<std::uint8_t> rest_;
  bool is_lost_ = false;
};

}  // namespace sim
