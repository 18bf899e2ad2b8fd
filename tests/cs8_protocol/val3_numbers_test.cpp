#include <gtest/gtest.h>

#include <algorithm>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"
#include "val3_project.hpp"

/// The numbers of the VAL3 application are those of messages.hpp.
namespace cs8 {
namespace {

/// The payload word of a field, from 1, as visit() orders them.
class WordCounter {
 public:
  explicit WordCounter(const void* wanted) : wanted_(wanted) {}
  template <class... Values>
  void operator()(const Values&... values) {
    (count(values), ...);
  }
  std::size_t word = 0;

 private:
  template <class T>
  void count(const T& value) {
    if (static_cast<const void*>(&value) == wanted_) word = next_;
    next_ += sizeof(T) / 4;
  }
  const void* wanted_;
  std::size_t next_ = 1;
};

template <class Body, class Field>
std::size_t word_of(Field Body::*field) {
  const Body body{};
  WordCounter counter(&(body.*field));
  Body::visit(body, counter);
  return counter.word;
}
/// As an index of VAL3's arrays, which begin with 0.
template <class Body, class Field>
std::string index_of(Field Body::*field) {
  return std::to_string(word_of(field) - 1);
}
std::string text(std::size_t number) { return std::to_string(number); }

void expect_code(const std::string& program, const std::string& line) {
  EXPECT_NE(code_of(program).find(line), std::string::npos) << program << " has no " << line;
}

TEST(Val3Application, HasTheNumberAndSizeOfEachMessage) {
  const std::map<MessageType, std::string> constants{{MessageType::kHello, "Hello"},
                                                     {MessageType::kTouch, "Touch"},
                                                     {MessageType::kTravel, "Travel"},
                                                     {MessageType::kRetract, "Retract"},
                                                     {MessageType::kStop, "Stop"},
                                                     {MessageType::kResultQuery, "Query"},
                                                     {MessageType::kResultAcknowledge, "Ack"},
                                                     {MessageType::kBegin, "Begin"},
                                                     {MessageType::kFinish, "Finish"},
                                                     {MessageType::kWelcome, "Welcome"},
                                                     {MessageType::kState, "State"},
                                                     {MessageType::kAccepted, "Accepted"},
                                                     {MessageType::kRejected, "Rejected"},
                                                     {MessageType::kTouchResult, "TouchRes"},
                                                     {MessageType::kMoveResult, "MoveRes"},
                                                     {MessageType::kResultUnknown, "Unknown"},
                                                     {MessageType::kFault, "Fault"},
                                                     {MessageType::kPermit, "Permit"}};
  double last_ask = 0;
  double last_reply = 0;
  for (int number = 0; number < 256; ++number) {
    const auto type = static_cast<MessageType>(number);
    if (name(type).empty()) continue;
    SCOPED_TRACE(name(type));
    const auto size = static_cast<double>(payload_size(type));
    if (number < 64) {
      EXPECT_EQ(constant("kAskSize", number), size);
      last_ask = number;
    } else {
      EXPECT_EQ(constant("kReplySize", number - static_cast<int>(constant("kReplyFirst"))), size);
      last_reply = number;
    }
    if (type == MessageType::kHeartbeat) continue;  // any frame counts as a sign of life: nothing asks for it
    ASSERT_TRUE(constants.contains(type));
    EXPECT_EQ(constant("kMsg" + constants.at(type)), number);
  }
  EXPECT_EQ(constant("kAskLast"), last_ask);
  EXPECT_EQ(constant("kReplyLast"), last_reply);
}

/// The constants whose names begin so, by value, with the protocol's names for the values that have none.
template <class Enum>
void expect_values(const std::string& prefix, const std::map<Enum, std::string>& constants,
                   const std::set<Enum>& without = {}) {
  Names expected;
  for (int number = 0; number < 100; ++number) {
    const auto value = static_cast<Enum>(number);
    if (name(value).empty() || without.contains(value)) continue;
    SCOPED_TRACE(name(value));
    ASSERT_TRUE(constants.contains(value));
    expected.insert(prefix + constants.at(value));
    EXPECT_EQ(constant(prefix + constants.at(value)), number);
  }
  Names found;
  const std::regex of_prefix(prefix + "[A-Z]\\w*");
  for (const auto& [variable, unused] : variables())
    if (std::regex_match(variable, of_prefix)) found.insert(variable);
  EXPECT_EQ(found, expected);
}

TEST(Val3Application, HasTheValuesOfTheProtocol) {
  using R = RejectReason;
  expect_values<R>("kRej", {{R::kBusy, "Busy"},
                            {R::kResultUnacknowledged, "Unacked"},
                            {R::kStaleSequence, "Stale"},
                            {R::kNotRemote, "Mode"},
                            {R::kNotPowered, "Power"},
                            {R::kHold, "Hold"},
                            {R::kEmergencyStop, "Es"},
                            {R::kNotCalibrated, "Calibrated"},
                            {R::kOutOfRange, "Range"},
                            {R::kProbeTriggered, "Triggered"},
                            {R::kMonitorSpeed, "Speed"},
                            {R::kSearchTooLong, "Long"},
                            {R::kSearchTooFast, "Fast"},
                            {R::kBadField, "Field"},
                            {R::kNothingToRetract, "NoRetract"},
                            {R::kRetractPending, "RetractDue"},
                            {R::kNotPermitted, "Permit"},
                            {R::kProbeInputs, "Inputs"},
                            {R::kCellOpen, "Cell"},
                            {R::kTouchTestMissing, "Test"},
                            {R::kTaskFailed, "Task"}});
  using O = Outcome;
  // VAL3 cannot tell a collision from power that was taken: permission_lost
  expect_values<O>("kOut",
                   {{O::kContact, "Contact"},
                    {O::kNoContact, "NoContact"},
                    {O::kArrived, "Arrived"},
                    {O::kUnexpectedContact, "Unexpected"},
                    {O::kProbeStuck, "Stuck"},
                    {O::kStopped, "Stopped"},
                    {O::kHeartbeatLost, "Link"},
                    {O::kPermissionLost, "Lost"},
                    {O::kMotionError, "Motion"},
                    {O::kDeadline, "Deadline"},
                    {O::kOvertravel, "Over"},
                    {O::kProbeFault, "Probe"},
                    {O::kTaskFailed, "Task"}},
                   {O::kCollision});
  using P = Phase;
  expect_values<P>("kPh", {{P::kIdle, "Idle"},
                           {P::kTravel, "Travel"},
                           {P::kApproach, "Approach"},
                           {P::kSearch, "Search"},
                           {P::kRetract, "Retract"}});
  using C = CaptureSource;
  expect_values<C>("kSrc", {{C::kNone, "None"}, {C::kLatched, "Latched"}, {C::kPolled, "Polled"}});
  using S = PermitState;
  expect_values<S>(
      "kPerm",
      {{S::kNone, "None"}, {S::kAwaited, "Awaited"}, {S::kGranted, "Granted"}, {S::kRetractOnly, "Retract"}});
  using W = PermitReason;
  expect_values<W>("kWhy", {{W::kNone, "None"},
                            {W::kRefused, "Refused"},
                            {W::kNotConfirmed, "Unconfirm"},
                            {W::kFinished, "Finished"},
                            {W::kBrokenOff, "Broken"},
                            {W::kPermissionLost, "Lost"},
                            {W::kProbeFault, "Probe"}});
  using F = FaultCode;
  // one client at a time is all a socket of a CS8 knows
  expect_values<F>("kFlt",
                   {{F::kBadMagic, "Magic"},
                    {F::kVersion, "Version"},
                    {F::kUnknownType, "Type"},
                    {F::kLength, "Length"},
                    {F::kNoHandshake, "Handshake"},
                    {F::kWrongSide, "WrongSide"},
                    {F::kBadValue, "Value"},
                    {F::kStopping, "Stopping"}},
                   {F::kOccupied});
}

TEST(Val3Application, HasTheLimitsOfTheProtocol) {
  EXPECT_EQ(constant("kProtocol"), kProtocolVersion);
  EXPECT_EQ(constant("kHeader"), kHeaderSize);
  EXPECT_EQ(constant("kViaMax"), kViaCountMax);
  double longest_ask = 0;
  for (int type = 0; type < 64; ++type) longest_ask = std::max(longest_ask, constant("kAskSize", type));
  EXPECT_GE(constant("kRxSize"), longest_ask);
  EXPECT_EQ(constant("kWords"), longest_ask / 4);
  EXPECT_GE(constant("kTxSize"), kHeaderSize + payload_size(MessageType::kWelcome));
  expect_code("readHeader", "nIn[l_nAt]!=" + text('T') + " or nIn[l_nAt+1]!=" + text('C'));
}

TEST(Val3Application, TakesTheFieldsOfCommandsFromTheirWords) {
  const auto joints_at = [](std::size_t word) { return "call toJoint(" + text(word - 1) + ","; };
  expect_code("checkFields", "call toJoint(" + index_of(&Touch::via) + "+6*l_nI,jWay[l_nI])");
  expect_code("checkFields", joints_at(word_of(&Touch::clear)) + "jWay[nWord[0]])");
  EXPECT_EQ(word_of(&Touch::clear), word_of(&Travel::target));
  expect_code("checkFields", joints_at(word_of(&Touch::approach)) + "jWay[nWord[0]+1])");
  expect_code("checkSearch", joints_at(word_of(&Touch::search_end)) + "jEnd)");
  expect_code("checkSearch", "nDetail=" + text(word_of(&Touch::search_end)));

  const auto speeds = [](std::size_t travel, std::size_t approach, std::size_t search, std::size_t deadline) {
    return "call checkSpeeds(" + text(travel) + "," + text(approach) + "," + text(search) + "," +
           text(deadline) + ")";
  };
  expect_code("checkFields", speeds(word_of(&Touch::travel_speed_um_s), word_of(&Touch::approach_speed_um_s),
                                    word_of(&Touch::search_speed_um_s), word_of(&Touch::deadline_ms)));
  expect_code("checkFields",
              speeds(word_of(&Travel::travel_speed_um_s), 0, 0, word_of(&Travel::deadline_ms)));
  expect_code("checkFields",
              speeds(0, word_of(&Retract::approach_speed_um_s), 0, word_of(&Retract::deadline_ms)));
  EXPECT_EQ(word_of(&Touch::second_speed_um_s), word_of(&Touch::search_speed_um_s) + 1);
  EXPECT_EQ(word_of(&Touch::second_backoff_dmm), word_of(&Touch::search_speed_um_s) + 2);

  expect_code("takeCommand", "nTravel=nWord[" + index_of(&Touch::travel_speed_um_s) + "]");
  expect_code("takeCommand", "nApproach=nWord[" + index_of(&Touch::approach_speed_um_s) + "]");
  expect_code("takeCommand", "nSearch=nWord[" + index_of(&Touch::search_speed_um_s) + "]");
  expect_code("takeCommand", "nSecond=nWord[" + index_of(&Touch::second_speed_um_s) + "]");
  expect_code("takeCommand", "nBackoff=nWord[" + index_of(&Touch::second_backoff_dmm) + "]");
  expect_code("takeCommand", "l_nAt=" + index_of(&Touch::deadline_ms) + "\n");
  expect_code("takeCommand", "nTravel=nWord[" + index_of(&Travel::travel_speed_um_s) + "]");
  expect_code("takeCommand", "l_nAt=" + index_of(&Travel::deadline_ms) + "\n");
  expect_code("takeCommand", "nApproach=nWord[" + index_of(&Retract::approach_speed_um_s) + "]");
  expect_code("takeCommand", "l_nAt=" + index_of(&Retract::deadline_ms) + "\n");
}

TEST(Val3Application, PutsResultsAndStateIntoTheirWords) {
  const auto put = [](const std::string& array, const std::string& index, const std::string& value) {
    return array + "[" + index + "]=" + value;
  };
  using T = TouchResult;
  expect_code("touchResult", put("nResult", index_of(&T::outcome), "nOutcome"));
  expect_code("touchResult", put("nResult", index_of(&T::phase), "nBrokenIn"));
  expect_code("touchResult", put("nResult", index_of(&T::source), "nSource"));
  expect_code("touchResult", "putJoint(jContact,nResult[" + index_of(&T::contact) + "])");
  expect_code("touchResult", "putJoint(jStopped,nResult[" + index_of(&T::stopped) + "])");
  expect_code("touchResult", put("nResult", index_of(&T::overtravel_dmm), "round(nOver*10000)"));
  expect_code("touchResult", put("nResult", index_of(&T::search_speed_um_s), "nSpeedNow"));
  expect_code("touchResult", put("nResult", index_of(&T::monitor_speed_percent), "nMonitor"));
  expect_code("touchResult", put("nResult", index_of(&T::contact_clock_ms), "nContactMs"));
  expect_code("touchResult", put("nResult", index_of(&T::error_number), "nErrNumber"));
  expect_code("touchResult", put("nResult", index_of(&T::first_source), "nFirstSource"));
  expect_code("touchResult", "putJoint(jFirst,nResult[" + index_of(&T::first_contact) + "])");
  expect_code("touchResult", put("nResult", index_of(&T::edges), "nEdges"));
  expect_code("moveResult", "putJoint(herej(),nResult[" + index_of(&MoveResult::joints) + "])");
  expect_code("moveResult", put("nResult", index_of(&MoveResult::error_number), "nErrNumber"));

  expect_code("makeState", put("nPay", index_of(&State::flags), "l_nFlags"));
  expect_code("makeState", put("nPay", index_of(&State::mode), "nMode"));
  expect_code("makeState", put("nPay", index_of(&State::emergency_stop), "nEs"));
  expect_code("makeState", "putJoint(herej(),nPay[" + index_of(&State::joints) + "])");
  expect_code("makeState", "toSigned(nRunning,nPay[" + index_of(&State::active_sequence) + "])");
  expect_code("makeState", put("nPay", index_of(&State::phase), "nPhase"));
  expect_code("makeState", put("nPay", index_of(&State::task_error), "nTaskError"));
  expect_code("makeState", put("nPay", index_of(&State::permit), "nPermit"));
  expect_code("makeState", put("nPay", index_of(&State::overruns), "nOverruns"));

  expect_code("makeWelcome", put("nPay", index_of(&Welcome::application_version), "kVersion"));
  expect_code("makeWelcome", "toSigned(nSession,nPay[" + index_of(&Welcome::session) + "])");
  expect_code("makeWelcome", "toSigned(l_nOpen,nPay[" + index_of(&Welcome::open_sequence) + "])");
  expect_code("makeWelcome", "putJoint(kLower,nPay[" + index_of(&Welcome::lower_limits) + "])");
  expect_code("makeWelcome", "putJoint(kUpper,nPay[" + index_of(&Welcome::upper_limits) + "])");
  expect_code("makeWelcome", put("nPay", index_of(&Welcome::search_speed_max_um_s), "nSpeedMax"));
}

TEST(Val3Application, StateHasTheFlagsOfTheProtocol) {
  for (const auto& [expression, flag] : std::map<std::string, StateFlag>{{"bPower", kPowered},
                                                                         {"bHeld", kHeld},
                                                                         {"bCalibrated", kArmCalibrated},
                                                                         {"isSettled()", kSettled},
                                                                         {"isEmpty()", kQueueEmpty},
                                                                         {"bContactWas", kProbeTouched},
                                                                         {"bRetractDue", kRetractDue},
                                                                         {"diLoop==true", kProbeLoopClosed},
                                                                         {"nTest==3", kTouchTested},
                                                                         {"bClosed", kCellClosed}})
    expect_code("stateFlags", "addFlag(" + expression + "," + text(flag) + ",");
}

}  // namespace
}  // namespace cs8
