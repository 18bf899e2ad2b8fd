#include "sim_controller/frame_stream.hpp"

#include <utility>

#include "cs8_protocol/codec.hpp"

namespace sim {

std::vector<FrameStream::Piece> FrameStream::feed(std::span<const std::uint8_t> bytes) {
  rest_.insert(rest_.end(), bytes.begin(), bytes.end());
  std::vector<Piece> pieces;
  std::span<const std::uint8_t> left(rest_);
  while (!is_lost_ && left.size() >= cs8::kHeaderSize) {
    const auto checked = cs8::decode_header(left.first<cs8::kHeaderSize>());
    const auto* header = std::get_if<cs8::Header>(&checked);
    is_lost_ = header == nullptr;
    if (is_lost_) break;
    const std::size_t size = cs8::kHeaderSize + header->payload_length;
    if (left.size() < size) break;
    Piece piece{.bytes = {left.begin(), left.begin() + static_cast<std::ptrdiff_t>(size)}, .message = {}};
    const cs8::DecodeResult decoded =
        cs8::decode(*header, left.subspan(cs8::kHeaderSize, header->payload_length));
    if (const auto* message = std::get_if<cs8::Message>(&decoded)) piece.message = *message;
    pieces.push_back(std::move(piece));
    left = left.subspan(size);
  }
  if (is_lost_ && !left.empty()) {
    pieces.push_back({.bytes = {left.begin(), left.end()}, .message = {}});
    left = {};
  }
  rest_ = std::vector<std::uint8_t>(left.begin(), left.end());
  return pieces;
}

std::vector<std::uint8_t> FrameStream::take_rest() { return std::exchange(rest_, {}); }

}  // namespace sim
