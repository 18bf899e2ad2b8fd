#pragma once

#include <array>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <cstdint>
#include <span>
#include <variant>

#include "cs8_protocol/codec.hpp"

/// Whole frames on any asynchronous stream. A broken or ended stream is boost::system::system_error; an end
/// inside a frame is boost::asio::error::eof like any other end. One reader and one writer at a time.
namespace cs8 {

/// The next frame. After a DecodeError the stream must be closed: where the next frame begins is not known. A
/// header is checked before the payload is read, and no length from outside ever sizes memory.
template <class AsyncStream>
boost::asio::awaitable<DecodeResult> read_frame(AsyncStream& stream) {
  std::array<std::uint8_t, kHeaderSize + kPayloadSizeMax> bytes;
  co_await boost::asio::async_read(stream, boost::asio::buffer(bytes, kHeaderSize),
                                   boost::asio::use_awaitable);
  const std::span<std::uint8_t, kHeaderSize + kPayloadSizeMax> all(bytes);
  const std::variant<Header, DecodeError> checked = decode_header(all.template first<kHeaderSize>());
  if (const auto* error = std::get_if<DecodeError>(&checked)) co_return *error;
  const Header header = std::get<Header>(checked);
  const std::span<std::uint8_t> payload = all.subspan(kHeaderSize, header.payload_length);
  co_await boost::asio::async_read(stream, boost::asio::buffer(payload.data(), payload.size()),
                                   boost::asio::use_awaitable);
  co_return decode(header, payload);
}

template <class AsyncStream>
boost::asio::awaitable<void> write_frame(AsyncStream& stream, Message message) {
  const std::vector<std::uint8_t> frame = encode(message);
  co_await boost::asio::async_write(stream, boost::asio::buffer(frame), boost::asio::use_awaitable);
}

}  // namespace cs8
