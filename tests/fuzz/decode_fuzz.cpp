#include <cstdlib>

#include "cs8_protocol/codec.hpp"

/// Arbitrary bytes, read as a stream of frames: nothing crashes, and what is taken is written again byte by
/// byte.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::uint8_t> bytes(data, size);
  while (bytes.size() >= cs8::kHeaderSize) {
    const auto checked = cs8::decode_header(bytes.first<cs8::kHeaderSize>());
    if (const auto* error = std::get_if<cs8::DecodeError>(&checked)) {
      if (error->text().empty()) std::abort();
      return 0;
    }
    const auto header = std::get<cs8::Header>(checked);
    const std::size_t frame_size = cs8::kHeaderSize + header.payload_length;
    const bool whole = frame_size <= bytes.size();
    const auto frame = whole ? bytes.first(frame_size) : bytes;
    const auto decoded = cs8::decode(header, frame.subspan(cs8::kHeaderSize));
    if (const auto* error = std::get_if<cs8::DecodeError>(&decoded)) {
      if (error->text().empty()) std::abort();
      return 0;
    }
    const auto again = cs8::encode(std::get<cs8::Message>(decoded));
    if (!whole || !std::equal(again.begin(), again.end(), frame.begin(), frame.end())) std::abort();
    bytes = bytes.subspan(frame_size);
  }
  return 0;
}
