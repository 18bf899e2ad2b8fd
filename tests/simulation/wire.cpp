#include "tests/simulation/wire.hpp"

#include "cs8_protocol/codec.hpp"

namespace simulation {

void WireReader::take(std::span<const std::uint8_t> bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  std::size_t at = 0;
  while (!is_lost_ && bytes_.size() - at >= cs8::kHeaderSize) {
    const std::span<const std::uint8_t> rest = std::span(bytes_).subspan(at);
    const auto checked = cs8::decode_header(rest.first<cs8::kHeaderSize>());
    const auto* const header = std::get_if<cs8::Header>(&checked);
    is_lost_ = header == nullptr;
    if (is_lost_ || rest.size() < cs8::kHeaderSize + header->payload_length) break;
    const auto frame = cs8::decode(*header, rest.subspan(cs8::kHeaderSize, header->payload_length));
    const auto* const message = std::get_if<cs8::Message>(&frame);
    is_lost_ = message == nullptr;
    at += cs8::kHeaderSize + header->payload_length;
    if (message != nullptr) on_message_(*message);
  }
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
}

void WireReader::begin_connection() {
  bytes_.clear();
  is_lost_ = false;
}

}  // namespace simulation
