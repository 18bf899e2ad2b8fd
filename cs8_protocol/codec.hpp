#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "cs8_protocol/messages.hpp"

/// Bytes to messages and back, by the one declaration in messages.hpp. Byte order and bounds are known here
/// only. No serialization library (Protocol Buffers and the like): the other end is a VAL 3 program, which
/// reads and writes bytes of a socket and has no such library.
namespace cs8 {

enum class DecodeErrorKind {
  kBadMagic,       // `detail` is the first two bytes, the first one high
  kVersion,        // `detail` is the version in the frame
  kUnknownType,    // `detail` is the type in the frame
  kLength,         // `detail` is the payload length in the frame
  kUnlistedValue,  // an enumeration's value is not in its list; `detail` is the payload word, from 1
  kBadCount,       // via_count is not 0..kViaCountMax; `detail` is the payload word, from 1
  kNotText,        // a text field is not printable ASCII padded with NUL; `detail` is its first payload word
};

/// What is wrong with bytes from outside.
struct DecodeError {
  DecodeErrorKind kind{};
  MessageType type{};  // of the frame; meaningless for kBadMagic, kVersion and kUnknownType
  std::uint32_t detail = 0;

  [[nodiscard]] std::string text() const;
  friend bool operator==(const DecodeError&, const DecodeError&) = default;
};

/// A header that was found right: the type is known and the length is the type's.
struct Header {
  MessageType type{};
  std::uint32_t sequence = 0;
  std::uint16_t payload_length = 0;
};

using DecodeResult = std::variant<Message, DecodeError>;

/// Bytes of the payload of a known type; at most kPayloadSizeMax.
std::size_t payload_size(MessageType type);

/// True for the messages that only the controller sends.
constexpr bool is_from_controller(MessageType type) { return type >= MessageType::kWelcome; }

MessageType type_of(const Message& message);

/// The whole frame.
std::vector<std::uint8_t> encode(const Message& message);
/// Appends the whole frame to `buffer`; takes no memory when its capacity suffices.
void encode(const Message& message, std::vector<std::uint8_t>& buffer);

std::variant<Header, DecodeError> decode_header(std::span<const std::uint8_t, kHeaderSize> bytes);
/// `payload` is what follows the header; any length but the type's is kLength.
DecodeResult decode(const Header& header, std::span<const std::uint8_t> payload);

/// What the controller says to a host that sent such bytes, before it closes the connection.
Fault fault_for(const DecodeError& error);

}  // namespace cs8
