#include "cs8_protocol/codec.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "cs8_protocol/names.hpp"

namespace cs8 {
namespace {

constexpr std::uint8_t kMagic[] = {'T', 'C'};

template <class Number>
  requires std::is_integral_v<Number>
Number little_endian(const std::uint8_t* bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
  return static_cast<Number>(value);
}

/// Every field is a whole number of words without padding between, so its size in memory is that on the wire.
struct SizeCounter {
  std::size_t size = 0;
  template <class... Field>
  constexpr void operator()(const Field&...) {
    size = (std::size_t{0} + ... + sizeof(Field));
  }
};

template <class Body>
constexpr std::size_t size_of_payload() {
  const Body body{};
  SizeCounter counter;
  Body::visit(body, counter);
  return counter.size;
}

/// There must be room for as many bytes as the fields take.
class Writer {
 public:
  explicit Writer(std::uint8_t* bytes) : at_(bytes) {}

  template <class... Field>
  void operator()(const Field&... fields) {
    (put(fields), ...);
  }

 private:
  template <class Number>
    requires std::is_integral_v<Number>
  void put(Number number) {
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      at_[i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(number) >> (8 * i));
    }
    at_ += sizeof(Number);
  }
  template <class Enum>
    requires std::is_enum_v<Enum>
  void put(Enum value) {
    put(static_cast<std::underlying_type_t<Enum>>(value));
  }
  template <class Element, std::size_t n>
  void put(const std::array<Element, n>& elements) {
    for (const Element& element : elements) put(element);
  }

  std::uint8_t* at_;
};

/// The bytes must be as many as the fields take.
class Reader {
 public:
  Reader(MessageType type, const std::uint8_t* bytes) : type_(type), begin_(bytes), at_(bytes) {}

  template <class... Field>
  void operator()(Field&... fields) {
    (get(fields), ...);
  }

  /// The first thing that was wrong.
  [[nodiscard]] const std::optional<DecodeError>& error() const { return error_; }

 private:
  template <class Number>
    requires std::is_integral_v<Number>
  void get(Number& number) {
    number = little_endian<Number>(at_);
    at_ += sizeof(Number);
  }
  template <class Enum>
    requires std::is_enum_v<Enum>
  void get(Enum& value) {
    const std::uint32_t word = current_word();
    std::underlying_type_t<Enum> number{};
    get(number);
    value = static_cast<Enum>(number);
    if (name(value).empty()) refuse(DecodeErrorKind::kUnlistedValue, word);
  }
  void get(Text16& text) {
    const std::uint32_t word = current_word();
    for (char& character : text) character = static_cast<char>(*at_++);
    const auto end_of_text = std::find(text.begin(), text.end(), '\0');
    const bool printable =
        std::all_of(text.begin(), end_of_text, [](char c) { return c >= ' ' && c <= '~'; });
    const bool padded = std::all_of(end_of_text, text.end(), [](char c) { return c == '\0'; });
    if (!printable || !padded) refuse(DecodeErrorKind::kNotText, word);
  }
  template <class Element, std::size_t n>
  void get(std::array<Element, n>& elements) {
    for (Element& element : elements) get(element);
  }

  [[nodiscard]] std::uint32_t current_word() const {
    return static_cast<std::uint32_t>((at_ - begin_) / 4 + 1);
  }
  void refuse(DecodeErrorKind kind, std::uint32_t word) {
    if (!error_) error_ = DecodeError{kind, type_, word};
  }

  MessageType type_;
  const std::uint8_t* begin_;
  const std::uint8_t* at_;
  std::optional<DecodeError> error_;
};

template <class Body>
DecodeResult read_payload(const Header& header, std::span<const std::uint8_t> payload) {
  Body body{};
  Reader reader(header.type, payload.data());
  Body::visit(body, reader);
  if (reader.error()) return *reader.error();
  if constexpr (requires { body.via_count; }) {
    constexpr std::uint32_t kWordOfViaCount = 1;
    if (body.via_count < 0 || body.via_count > static_cast<std::int32_t>(kViaCountMax)) {
      return DecodeError{DecodeErrorKind::kBadCount, header.type, kWordOfViaCount};
    }
  }
  return Message{header.sequence, body};
}

/// Calls `use.operator()<Body>()` for the message type with this number, if there is one.
template <class Use>
void with_body_of(MessageType type, const Use& use) {
  [&]<class... Body>(std::type_identity<std::variant<Body...>>) {
    ((Body::kType == type ? use.template operator()<Body>() : void()), ...);
  }(std::type_identity<Payload>{});
}

}  // namespace

std::size_t payload_size(MessageType type) {
  std::size_t size = 0;
  with_body_of(type, [&]<class Body>() {
    size = size_of_payload<Body>();
    static_assert(size_of_payload<Body>() <= kPayloadSizeMax);
    static_assert(std::is_empty_v<Body> || size_of_payload<Body>() == sizeof(Body),
                  "visit() left a field out");
  });
  return size;
}

MessageType type_of(const Message& message) {
  return std::visit([](const auto& body) { return body.kType; }, message.payload);
}

std::vector<std::uint8_t> encode(const Message& message) {
  std::vector<std::uint8_t> frame;
  encode(message, frame);
  return frame;
}

void encode(const Message& message, std::vector<std::uint8_t>& buffer) {
  std::visit(
      [&]<class Body>(const Body& body) {
        const std::size_t before = buffer.size();
        buffer.resize(before + kHeaderSize + size_of_payload<Body>());
        Writer writer(buffer.data() + before);
        writer(kMagic[0], kMagic[1], kProtocolVersion, Body::kType, message.sequence,
               static_cast<std::uint16_t>(size_of_payload<Body>()));
        Body::visit(body, writer);
      },
      message.payload);
}

std::variant<Header, DecodeError> decode_header(std::span<const std::uint8_t, kHeaderSize> bytes) {
  if (bytes[0] != kMagic[0] || bytes[1] != kMagic[1]) {
    return DecodeError{DecodeErrorKind::kBadMagic, {}, std::uint32_t{bytes[0]} << 8 | bytes[1]};
  }
  if (bytes[2] != kProtocolVersion) return DecodeError{DecodeErrorKind::kVersion, {}, bytes[2]};
  const Header header{.type = static_cast<MessageType>(bytes[3]),
                      .sequence = little_endian<std::uint32_t>(&bytes[4]),
                      .payload_length = little_endian<std::uint16_t>(&bytes[8])};
  if (name(header.type).empty()) return DecodeError{DecodeErrorKind::kUnknownType, {}, bytes[3]};
  if (header.payload_length != payload_size(header.type)) {
    return DecodeError{DecodeErrorKind::kLength, header.type, header.payload_length};
  }
  return header;
}

DecodeResult decode(const Header& header, std::span<const std::uint8_t> payload) {
  DecodeResult result =
      DecodeError{DecodeErrorKind::kUnknownType, {}, static_cast<std::uint32_t>(header.type)};
  with_body_of(header.type, [&]<class Body>() {
    if (payload.size() == size_of_payload<Body>()) {
      result = read_payload<Body>(header, payload);
    } else {
      result = DecodeError{DecodeErrorKind::kLength, header.type, static_cast<std::uint32_t>(payload.size())};
    }
  });
  return result;
}

std::string DecodeError::text() const {
  const std::string number = std::to_string(detail);
  const std::string frame = "a " + std::string(name(type)) + " frame";
  switch (kind) {
    case DecodeErrorKind::kBadMagic:
      return "the bytes are not a frame of this protocol: it would begin with 'TC', not with " +
             std::to_string(detail >> 8) + " " + std::to_string(detail & 0xff);
    case DecodeErrorKind::kVersion:
      return "protocol version " + number + "; this side speaks version " + std::to_string(kProtocolVersion);
    case DecodeErrorKind::kUnknownType:
      return "message type " + number + " is not known";
    case DecodeErrorKind::kLength:
      return frame + " with a payload of " + number + " bytes; it has " + std::to_string(payload_size(type));
    case DecodeErrorKind::kUnlistedValue:
      return frame + " whose payload word " + number + " has a value that is not in its list";
    case DecodeErrorKind::kBadCount:
      return frame + " whose via_count is not in 0 to " + std::to_string(kViaCountMax);
    case DecodeErrorKind::kNotText:
      return frame + " whose text at payload word " + number + " is not ASCII padded with NUL";
  }
  return {};
}

Fault fault_for(const DecodeError& error) {
  const auto detail = static_cast<std::int32_t>(error.detail);
  switch (error.kind) {
    case DecodeErrorKind::kBadMagic:
      return {FaultCode::kBadMagic, 0};
    case DecodeErrorKind::kVersion:
      return {FaultCode::kVersion, kProtocolVersion};
    case DecodeErrorKind::kUnknownType:
      return {FaultCode::kUnknownType, detail};
    case DecodeErrorKind::kLength:
      return {FaultCode::kLength, static_cast<std::int32_t>(payload_size(error.type))};
    case DecodeErrorKind::kUnlistedValue:
    case DecodeErrorKind::kBadCount:
    case DecodeErrorKind::kNotText:
      return {FaultCode::kBadValue, detail};
  }
  return {};
}

}  // namespace cs8
