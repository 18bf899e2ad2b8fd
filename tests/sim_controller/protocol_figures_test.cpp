// The figures that PROTOCOL.md states in its text, against the constants of both sides. What stands in its
// tables and examples is in protocol_page_test, what the VAL3 application has in val3_numbers_test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "cs8_protocol/client.hpp"
#include "sim_controller/connection.hpp"
#include "sim_controller/controller.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/motion_task.hpp"
#include "sim_controller/permit.hpp"
#include "sim_controller/plant.hpp"

namespace sim {
namespace {

using ::testing::HasSubstr;

/// The page in one line.
std::string protocol_page() {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/cs8_protocol/PROTOCOL.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  return std::regex_replace(page, std::regex("\\s+"), " ");
}

std::string text(std::chrono::milliseconds time) {
  const bool is_whole = time.count() % 1000 == 0;
  return std::to_string(is_whole ? time.count() / 1000 : time.count()) + (is_whole ? " s" : " ms");
}
std::string text_of_seconds(double seconds) {
  return text(std::chrono::milliseconds(std::lround(seconds * 1e3)));
}

TEST(ProtocolFigures, OfTheLinkAreThoseOfBothSides) {
  const std::string page = protocol_page();
  const cs8::ClientOptions host;
  EXPECT_THAT(page, HasSubstr("| Hello | within " + text(kHelloTimeout) + " of the connection |"));
  EXPECT_THAT(page, HasSubstr("clamped to " + std::to_string(kHeartbeatTimeoutMin.count()) + ".." +
                              std::to_string(kHeartbeatTimeoutMax.count()) + " |"));
  EXPECT_THAT(page,
              HasSubstr("| heartbeat | the host sends one every " + text(host.heartbeat_period) + " and "));
  EXPECT_THAT(page, HasSubstr("| State | every " + text(kStatePeriod) + " from Welcome on |"));
  EXPECT_THAT(page, HasSubstr("within 100 ms of the command; the host gives up after " +
                              text(host.answer_deadline) + " |"));
  EXPECT_THAT(
      page, HasSubstr("the host gives up " + text(host.result_margin) + " after the command's own deadline"));
  EXPECT_THAT(page, HasSubstr("keeps reading for up to " + text(Connection::kLingerMax) + " after Fault"));
  EXPECT_THAT(page, HasSubstr("clamped to " + std::to_string(kConfirmWithinMinMs) + ".." +
                              std::to_string(kConfirmWithinMaxMs) + " |"));
}

TEST(ProtocolFigures, OfAControllerThatCannotSendAreThoseOfTheSimulated) {
  const std::string page = protocol_page();
  EXPECT_THAT(page, HasSubstr("A controller whose connection takes no more bytes drops States. Answers wait, "
                              "16 at least; one too many ends the connection as if it were lost."));
  EXPECT_GE(Connection::kQueueMax, 16U);
}

TEST(ProtocolFigures, OfMotionsAreThoseOfTheSimulatedController) {
  const std::string page = protocol_page();
  const std::string standstill = text_of_seconds(kStandstillSecondsMax);
  EXPECT_THAT(page, HasSubstr("; " + std::to_string(kTimeoutError) +
                              ": the arm stood still before its target, or did not come to rest within " +
                              standstill + " of a trigger or a stop"));
  EXPECT_THAT(page, HasSubstr("; " + std::to_string(kImpossibleMoveError) +
                              ": a move that it did not begin within " + standstill + " |"));
  EXPECT_THAT(page, HasSubstr("wait until the probe has been free for 20 ms (" +
                              text_of_seconds(kReseatSecondsMax) + " at most, else `probe_stuck`)"));
  EXPECT_THAT(page, HasSubstr("with t = " + text_of_seconds(kStopLatencySeconds) + ", a = " +
                              std::to_string(std::lround(kAccelerationMetresPerSecond2 * 1e3)) + " mm/s^2"));
}

/// Without these nobody can write the other side.
TEST(ProtocolFigures, StandBesideWhatAHostAndAControllerHaveToKnow) {
  const std::string page = protocol_page();
  for (
      const char* sentence :
      {// where the tool centre is, and in whose kinematics
       "The *tool centre* is the centre of the stylus ball: the flange frame, then the tool data of the "
       "controller's application",
       "frame j is Rot(y, beta) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r), the leftmost applied "
       "last",
       "`approach` and `search_end` have one orientation of the tool in the host's kinematics, and by up to "
       "1 mrad another one in the controller's. The controller does not check this",
       // which of several is told
       "Of several faults in one frame the first of these is told: `bad_magic`, `version`, `unknown_type`, "
       "`no_handshake`, `wrong_side`, `length`, `bad_value`.",
       "Of several reasons to reject a command, the first in the order of section 6.",
       // a second touch that was not reached
       "the first trigger is in `first_contact` only: `source` is none, `contact` all 0, `stopped` where the "
       "arm stands, `overtravel_dmm` that of the first touch, `edges` those of the last trigger.",
       // Permit and result
       "Where the outcome ends the permit, Permit follows the result. Where its cause does (lost permission, "
       "open cell, probe fault, a task that failed), Permit is sent at once and the result when the arm "
       "stands.",
       "A host takes either order."})
    EXPECT_THAT(page, HasSubstr(sentence));
}

}  // namespace
}  // namespace sim
