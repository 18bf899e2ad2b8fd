#include "cs8_protocol/codec.hpp"

#include <gmock/gmock.h>

#include <initializer_list>
#include <set>
#include <sstream>

#include "cs8_protocol/names.hpp"
#include "tests/cs8_protocol/samples.hpp"

namespace cs8 {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes hex(const std::string& text) {
  Bytes bytes;
  std::istringstream stream(text);
  for (std::string byte; stream >> byte;)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(byte, nullptr, 16)));
  return bytes;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// `frame` holds `message` in both directions.
void expect_golden(const Message& message, const Bytes& frame) {
  EXPECT_EQ(encode(message), frame);
  const DecodeResult decoded = decode_frame(frame);
  ASSERT_TRUE(std::holds_alternative<Message>(decoded)) << std::get<DecodeError>(decoded).text();
  EXPECT_TRUE(same(std::get<Message>(decoded), message));
}

DecodeError expect_refused(const Bytes& frame) {
  const DecodeResult decoded = decode_frame(frame);
  if (const auto* error = std::get_if<DecodeError>(&decoded)) return *error;
  ADD_FAILURE() << "a frame that should be refused was taken";
  return {};
}

void put_word(Bytes& frame, std::size_t word_from_1, std::int32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    frame.at(kHeaderSize + 4 * (word_from_1 - 1) + i) =
        static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * i));
  }
}

// Golden bytes, worked by hand from PROTOCOL.md: two's complement, lowest byte first.
// 1 deg = 1000000 = 40 42 0f 00, -1 deg = c0 bd f0 ff, 90 deg = 80 4a 5d 05, -90 deg = 80 b5 a2 fa.
const char* const kOneDegree = "40 42 0f 00 ";
const char* const kMinusOneDegree = "c0 bd f0 ff ";
const char* const kNinetyDegrees = "80 4a 5d 05 ";
const char* const kMinusNinetyDegrees = "80 b5 a2 fa ";
const char* const kZero = "00 00 00 00 ";

Bytes words(std::initializer_list<const char*> parts) {
  std::string text;
  for (const char* part : parts) text += part;
  return hex(text);
}

TEST(Codec, HelloHasTheBytesWorkedByHand) {
  expect_golden({0, Hello{500}}, hex("54 43 02 01 00 00 00 00 04 00 f4 01 00 00"));
}

TEST(Codec, TouchHasTheBytesWorkedByHand) {
  Touch touch;
  touch.via_count = 1;
  touch.via[0] = {1000000, -1000000, 90000000, -90000000, 0, 1};
  touch.clear = {1000000, 0, 0, 0, 0, 0};
  touch.approach = {0, 1000000, 0, 0, 0, 0};
  touch.search_end = {0, 0, 0, 0, 0, -1000000};
  touch.travel_speed_um_s = 250000;   // 0x0003d090
  touch.approach_speed_um_s = 20000;  // 0x4e20
  touch.search_speed_um_s = 8000;     // 0x1f40
  touch.second_speed_um_s = 2000;     // 0x07d0
  touch.second_backoff_dmm = 20000;   // 0x4e20
  touch.deadline_ms = 120000;         // 0x0001d4c0
  // 220 payload bytes = 0x00dc; sequence 0x01020304
  expect_golden(
      {0x01020304, touch},
      joined({hex("54 43 02 03 04 03 02 01 dc 00"), hex("01 00 00 00"),
              words({kOneDegree, kMinusOneDegree, kNinetyDegrees, kMinusNinetyDegrees, kZero, "01 00 00 00"}),
              Bytes(4 * 24, 0), words({kOneDegree, kZero, kZero, kZero, kZero, kZero}),
              words({kZero, kOneDegree, kZero, kZero, kZero, kZero}),
              words({kZero, kZero, kZero, kZero, kZero, kMinusOneDegree}),
              hex("90 d0 03 00 20 4e 00 00 40 1f 00 00 d0 07 00 00 20 4e 00 00 c0 d4 01 00")}));
}

TEST(Codec, TouchResultHasTheBytesWorkedByHand) {
  const TouchResult result{.outcome = Outcome::kContact,
                           .phase = Phase::kRetract,
                           .source = CaptureSource::kLatched,
                           .contact = {1000000, -1000000, 90000000, -90000000, 0, 1},
                           .stopped = {-1000000, 1000000, 0, 0, 0, 0},
                           .overtravel_dmm = 1280,  // 0x0500
                           .search_speed_um_s = 8000,
                           .monitor_speed_percent = 100,
                           .contact_clock_ms = 0xfedcba98,
                           .error_number = 0,
                           .first_source = CaptureSource::kPolled,
                           .first_contact = {0, 0, -90000000, 90000000, 0, 1000000},
                           .edges = 2};
  // 112 payload bytes = 0x0070
  expect_golden(
      {17, result},
      joined({hex("54 43 02 45 11 00 00 00 70 00"), hex("01 00 00 00 04 00 00 00 01 00 00 00"),
              words({kOneDegree, kMinusOneDegree, kNinetyDegrees, kMinusNinetyDegrees, kZero, "01 00 00 00"}),
              words({kMinusOneDegree, kOneDegree, kZero, kZero, kZero, kZero}),
              hex("00 05 00 00 40 1f 00 00 64 00 00 00 98 ba dc fe 00 00 00 00 02 00 00 00"),
              words({kZero, kZero, kMinusNinetyDegrees, kNinetyDegrees, kZero, kOneDegree}),
              hex("02 00 00 00")}));
}

TEST(Codec, StateHasTheBytesWorkedByHand) {
  const State state{.session = 3,
                    .clock_ms = 65536,
                    .flags = kPowered | kArmCalibrated | kSettled | kQueueEmpty,  // 1 + 4 + 8 + 16 = 0x1d
                    .mode = WorkingMode::kRemote,
                    .mode_status = 0,
                    .emergency_stop = 2,
                    .monitor_speed_percent = 100,
                    .joints = {1000000, -1000000, 90000000, -90000000, 0, 0},
                    .active_sequence = 17,
                    .phase = Phase::kSearch,
                    .task_error = 150,
                    .permit = PermitState::kGranted,
                    .move_id_milli = 3500,  // 0x0dac
                    .overruns = 1};
  // 76 payload bytes = 0x004c
  expect_golden(
      {256, state},
      joined({hex("54 43 02 42 00 01 00 00 4c 00"),
              hex("03 00 00 00 00 00 01 00 1d 00 00 00 04 00 00 00 00 00 00 00 02 00 00 00 64 00 00 00"),
              words({kOneDegree, kMinusOneDegree, kNinetyDegrees, kMinusNinetyDegrees, kZero, kZero}),
              hex("11 00 00 00 03 00 00 00 96 00 00 00 02 00 00 00 ac 0d 00 00 01 00 00 00")}));
}

TEST(Codec, WelcomeHasTheBytesWorkedByHand) {
  const Welcome welcome{.application = text16("touchcal"),
                        .arm = text16("tx90"),
                        .application_version = 10000,  // 0x2710
                        .language_version = 70702,     // 0x0001142e
                        .session = 5,
                        .last_sequence = 12,
                        .open_sequence = 12,
                        .heartbeat_timeout_ms = 500,
                        .clock_ms = 1,
                        .lower_limits = {-90000000, -90000000, -90000000, -1000000, -1000000, -1000000},
                        .upper_limits = {90000000, 90000000, 90000000, 1000000, 1000000, 1000000},
                        .search_length_max_dmm = 400000,  // 0x00061a80
                        .search_speed_max_um_s = 20000};
  // 116 payload bytes = 0x0074
  expect_golden(
      {0, welcome},
      joined({hex("54 43 02 41 00 00 00 00 74 00"), hex("74 6f 75 63 68 63 61 6c 00 00 00 00 00 00 00 00"),
              hex("74 78 39 30 00 00 00 00 00 00 00 00 00 00 00 00"),
              hex("10 27 00 00 2e 14 01 00 05 00 00 00 0c 00 00 00 0c 00 00 00 f4 01 00 00 01 00 00 00"),
              words({kMinusNinetyDegrees, kMinusNinetyDegrees, kMinusNinetyDegrees}),
              words({kMinusOneDegree, kMinusOneDegree, kMinusOneDegree}),
              words({kNinetyDegrees, kNinetyDegrees, kNinetyDegrees, kOneDegree, kOneDegree, kOneDegree}),
              hex("80 1a 06 00 20 4e 00 00")}));
}

TEST(Codec, BeginAndPermitHaveTheBytesWorkedByHand) {
  expect_golden({0, Begin{.run = 258, .confirm_within_ms = 30000}},  // 0x0102, 0x7530
                hex("54 43 02 09 00 00 00 00 08 00 02 01 00 00 30 75 00 00"));
  expect_golden({0, Finish{}}, hex("54 43 02 0a 00 00 00 00 00 00"));
  const Permit permit{258, PermitState::kNone, PermitReason::kRefused,
                      static_cast<std::int32_t>(RejectReason::kTouchTestMissing)};  // 20
  expect_golden({0, permit},
                hex("54 43 02 49 00 00 00 00 10 00 02 01 00 00 00 00 00 00 01 00 00 00 14 00 00 00"));
}

TEST(Codec, EveryMessageComesBackAsItWent) {
  std::set<std::size_t> types;
  for (const Message& message : one_of_each()) {
    SCOPED_TRACE(name(type_of(message)));
    const Bytes frame = encode(message);
    EXPECT_EQ(frame.size(), kHeaderSize + payload_size(type_of(message)));
    const DecodeResult decoded = decode_frame(frame);
    ASSERT_TRUE(std::holds_alternative<Message>(decoded)) << std::get<DecodeError>(decoded).text();
    EXPECT_TRUE(same(std::get<Message>(decoded), message));
    types.insert(message.payload.index());
  }
  EXPECT_EQ(types.size(), std::variant_size_v<Payload>);
}

TEST(Codec, EveryTypeWithANameHasAMessageAndNoOther) {
  std::set<MessageType> with_message;
  for (const Message& message : one_of_each()) with_message.insert(type_of(message));
  for (int type = 0; type < 256; ++type) {
    EXPECT_EQ(!name(static_cast<MessageType>(type)).empty(),
              with_message.contains(static_cast<MessageType>(type)))
        << type;
  }
}

TEST(Codec, EncodingIntoABufferWithRoomTakesNoMemory) {
  Bytes buffer;
  buffer.reserve(4096);
  const std::uint8_t* const where = buffer.data();
  Bytes expected;
  for (const Message& message : one_of_each()) {
    encode(message, buffer);
    expected = joined({expected, encode(message)});
  }
  EXPECT_EQ(buffer.data(), where);
  EXPECT_EQ(buffer, expected);
}

TEST(Codec, APayloadOfAnyOtherLengthIsRefused) {
  for (const Message& message : one_of_each()) {
    SCOPED_TRACE(name(type_of(message)));
    const Bytes frame = encode(message);
    const Header header = std::get<Header>(decode_header(std::span(frame).first<kHeaderSize>()));
    Bytes payload(frame.begin() + kHeaderSize, frame.end());
    for (std::size_t length = 0; length < payload.size(); ++length) {
      const DecodeResult decoded = decode(header, std::span(payload).first(length));
      ASSERT_TRUE(std::holds_alternative<DecodeError>(decoded)) << length;
      EXPECT_EQ(std::get<DecodeError>(decoded).kind, DecodeErrorKind::kLength);
    }
    payload.push_back(0);
    EXPECT_TRUE(std::holds_alternative<DecodeError>(decode(header, payload)));
  }
}

TEST(Codec, AHeaderWithAnyOtherLengthIsRefusedAndToldTheRightOne) {
  Bytes frame = encode({0, Hello{500}});
  frame[8] = 5;
  const DecodeError error = expect_refused(frame);
  EXPECT_EQ(error, (DecodeError{DecodeErrorKind::kLength, MessageType::kHello, 5}));
  EXPECT_EQ(fault_for(error).code, FaultCode::kLength);
  EXPECT_EQ(fault_for(error).detail, 4);
}

TEST(Codec, BytesThatAreNoFrameAreRefused) {
  Bytes frame = encode({0, Hello{500}});
  frame[0] = 'G';
  EXPECT_EQ(expect_refused(frame).kind, DecodeErrorKind::kBadMagic);
  EXPECT_EQ(fault_for(expect_refused(frame)).code, FaultCode::kBadMagic);
  EXPECT_EQ(fault_for(expect_refused(frame)).detail, 0);
  frame[0] = 'T';
  frame[1] = 'X';
  EXPECT_EQ(expect_refused(frame), (DecodeError{DecodeErrorKind::kBadMagic, {}, 0x5458}));
}

TEST(Codec, AnUnknownTypeHasNoPayload) {
  EXPECT_EQ(payload_size(static_cast<MessageType>(99)), 0u);
  const DecodeResult decoded = decode({.type = static_cast<MessageType>(99)}, {});
  EXPECT_EQ(std::get<DecodeError>(decoded), (DecodeError{DecodeErrorKind::kUnknownType, {}, 99}));
}

TEST(Codec, TheFirstOfTwoErrorsIsTold) {
  Bytes frame = encode({9, TouchResult{.outcome = Outcome::kContact}});
  put_word(frame, 2, 99);
  put_word(frame, 3, 99);
  const DecodeError error = expect_refused(frame);
  EXPECT_EQ(error, (DecodeError{DecodeErrorKind::kUnlistedValue, MessageType::kTouchResult, 2}));
  EXPECT_EQ(fault_for(error).code, FaultCode::kBadValue);
  EXPECT_EQ(fault_for(error).detail, 2);
}

TEST(Codec, AnotherVersionIsRefusedAndToldOurs) {
  Bytes frame = encode({0, Hello{500}});
  frame[2] = kProtocolVersion + 1;
  const DecodeError error = expect_refused(frame);
  EXPECT_EQ(error, (DecodeError{DecodeErrorKind::kVersion, {}, kProtocolVersion + 1}));
  EXPECT_EQ(fault_for(error).code, FaultCode::kVersion);
  EXPECT_EQ(fault_for(error).detail, kProtocolVersion);
}

TEST(Codec, AnUnknownTypeIsRefused) {
  Bytes frame = encode({0, Hello{500}});
  frame[3] = 99;
  EXPECT_EQ(expect_refused(frame), (DecodeError{DecodeErrorKind::kUnknownType, {}, 99}));
  EXPECT_EQ(fault_for(expect_refused(frame)).code, FaultCode::kUnknownType);
  EXPECT_EQ(fault_for(expect_refused(frame)).detail, 99);
}

struct EnumWord {
  MessageType type;
  std::size_t word;
  std::set<std::int32_t> listed;
};

std::set<std::int32_t> from_to(std::int32_t first, std::int32_t last) {
  std::set<std::int32_t> values;
  for (std::int32_t value = first; value <= last; ++value) values.insert(value);
  return values;
}

TEST(Codec, AnEnumerationTakesItsListedValuesAndNoOther) {
  const std::vector<EnumWord> enum_words{
      {MessageType::kState, 4, from_to(0, 4)},        {MessageType::kState, 15, from_to(0, 4)},
      {MessageType::kRejected, 1, from_to(1, 21)},    {MessageType::kTouchResult, 1, from_to(1, 14)},
      {MessageType::kTouchResult, 2, from_to(0, 4)},  {MessageType::kTouchResult, 3, from_to(0, 2)},
      {MessageType::kMoveResult, 1, from_to(1, 14)},  {MessageType::kMoveResult, 2, from_to(0, 4)},
      {MessageType::kFault, 1, from_to(1, 9)},        {MessageType::kState, 17, from_to(0, 3)},
      {MessageType::kTouchResult, 21, from_to(0, 2)}, {MessageType::kPermit, 2, from_to(0, 3)},
      {MessageType::kPermit, 3, from_to(0, 6)}};
  for (const Message& message : one_of_each()) {
    for (const EnumWord& field : enum_words) {
      if (field.type != type_of(message)) continue;
      for (const std::int32_t value :
           {-2147483647 - 1, -1, 0, 1, 2, 3, 4, 5, 6, 7, 9, 10, 14, 15, 21, 22, 256, 2147483647}) {
        SCOPED_TRACE(std::string(name(field.type)) + " word " + std::to_string(field.word) + " = " +
                     std::to_string(value));
        Bytes frame = encode(message);
        put_word(frame, field.word, value);
        if (field.listed.contains(value)) {
          EXPECT_TRUE(std::holds_alternative<Message>(decode_frame(frame)));
        } else {
          EXPECT_EQ(expect_refused(frame), (DecodeError{DecodeErrorKind::kUnlistedValue, field.type,
                                                        static_cast<std::uint32_t>(field.word)}));
        }
      }
    }
  }
}

TEST(Codec, AViaCountThatDoesNotFitIsRefused) {
  for (const Message& message : one_of_each()) {
    if (type_of(message) != MessageType::kTouch && type_of(message) != MessageType::kTravel) continue;
    for (const std::int32_t count : {-1, 6, 2147483647}) {
      Bytes frame = encode(message);
      put_word(frame, 1, count);
      EXPECT_EQ(expect_refused(frame), (DecodeError{DecodeErrorKind::kBadCount, type_of(message), 1}));
      EXPECT_EQ(fault_for(expect_refused(frame)).code, FaultCode::kBadValue);
    }
    for (const std::int32_t count : {0, 5}) {
      Bytes frame = encode(message);
      put_word(frame, 1, count);
      EXPECT_TRUE(std::holds_alternative<Message>(decode_frame(frame)));
    }
  }
}

TEST(Codec, TextThatIsNotPaddedAsciiIsRefused) {
  const auto welcome_with = [](const std::string& arm) {
    Welcome welcome{.application = text16("touchcal")};
    std::copy(arm.begin(), arm.end(), welcome.arm.begin());
    return encode({0, welcome});
  };
  EXPECT_TRUE(std::holds_alternative<Message>(decode_frame(welcome_with("tx90"))));
  EXPECT_TRUE(std::holds_alternative<Message>(decode_frame(welcome_with(""))));
  EXPECT_TRUE(std::holds_alternative<Message>(decode_frame(welcome_with(" ~")))) << "the first and the last";
  for (const std::string& arm : {std::string("t\x7f"), std::string("St\xe4ubli"), std::string("a\nb"),
                                 std::string("\x1f"), std::string("tx90\0x", 6)}) {
    EXPECT_EQ(expect_refused(welcome_with(arm)),
              (DecodeError{DecodeErrorKind::kNotText, MessageType::kWelcome, 5}));
    EXPECT_EQ(fault_for(expect_refused(welcome_with(arm))).code, FaultCode::kBadValue);
  }
}

TEST(Codec, EveryErrorSaysWhatIsWrong) {
  const auto text = [](DecodeErrorKind kind, std::uint32_t detail) {
    return DecodeError{kind, MessageType::kTouch, detail}.text();
  };
  EXPECT_EQ(text(DecodeErrorKind::kBadMagic, 0x4754),
            "the bytes are not a frame of this protocol: it would begin with 'TC', not with 71 84");
  EXPECT_EQ(text(DecodeErrorKind::kVersion, 3), "protocol version 3; this side speaks version 2");
  EXPECT_EQ(text(DecodeErrorKind::kUnknownType, 99), "message type 99 is not known");
  EXPECT_EQ(text(DecodeErrorKind::kLength, 5), "a touch frame with a payload of 5 bytes; it has 220");
  EXPECT_EQ(text(DecodeErrorKind::kUnlistedValue, 2),
            "a touch frame whose payload word 2 has a value that is not in its list");
  EXPECT_EQ(text(DecodeErrorKind::kBadCount, 1), "a touch frame whose via_count is not in 0 to 5");
  EXPECT_EQ(text(DecodeErrorKind::kNotText, 5),
            "a touch frame whose text at payload word 5 is not ASCII padded with NUL");
}

TEST(Codec, AnErrorOfNoKindHasNoTextAndNoFault) {
  const DecodeError error{static_cast<DecodeErrorKind>(99), MessageType::kTouch, 1};
  EXPECT_EQ(error.text(), "");
  EXPECT_EQ(fault_for(error).code, FaultCode{});
}

TEST(Text16, KeepsWhatFitsAndGivesItBack) {
  EXPECT_EQ(text_of(text16("tx90")), "tx90");
  EXPECT_EQ(text_of(text16("")), "");
  EXPECT_EQ(text_of(text16("seventeen letters")), "seventeen letter");
}

}  // namespace
}  // namespace cs8
