// What comes to the HTTP port beside a run changes nothing of it.
#include "tests/simulation/clients.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "tests/simulation/world.hpp"

namespace simulation {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::Ne;
using ::testing::SizeIs;
using namespace std::chrono_literals;

Scenario with_clients(std::uint64_t seed, FaultKind kind, int number, Time lasts = {}) {
  Scenario scenario{.seed = seed, .speed = kQuickSpeed};
  scenario.faults.push_back({.at = 25s, .kind = kind, .number = number, .lasts = lasts});
  return scenario;
}

std::vector<HttpAnswer> answers_with_key(const Outcome& outcome, int status_from, int status_to) {
  std::vector<HttpAnswer> found;
  std::ranges::copy_if(outcome.record.http_answers, std::back_inserter(found), [&](const HttpAnswer& answer) {
    return !answer.key.empty() && answer.status >= status_from && answer.status < status_to;
  });
  return found;
}

TEST(Clients, InACrowdAreAnsweredWhileTheRunGoesOn) {
  const Outcome outcome = run_world(with_clients(1, FaultKind::kClientsFlood, 12));
  EXPECT_THAT(outcome.broken, IsEmpty()) << outcome.journal;
  EXPECT_THAT(outcome.record.http_answers,
              AllOf(SizeIs(120), Each(Field(&HttpAnswer::end, HttpAnswer::End::kAnswered)),
                    Each(Field(&HttpAnswer::status, Ne(500)))));
  EXPECT_EQ(outcome.record.stores.back().runs.front().run.verdict, cell::Verdict::kAccepted);
}

TEST(Clients, ThatDoNotReadHoldNothingUp) {
  const Outcome outcome = run_world(with_clients(1, FaultKind::kClientsStopReading, 12));
  EXPECT_THAT(outcome.broken, IsEmpty()) << outcome.journal;
  EXPECT_EQ(outcome.record.stores.back().runs.front().run.verdict, cell::Verdict::kAccepted);
}

/// Twice at once, and once more behind the death of the daemon that answered.
TEST(Clients, ThatRepeatTheirKeyHaveTheFirstAnswerAgainAlsoFromTheNextDaemon) {
  std::size_t repeated_count = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Scenario scenario = with_clients(seed, FaultKind::kClientRepeatsKey, 1, 8s);
    scenario.faults.push_back({.at = 30s, .kind = FaultKind::kKilled});
    const Outcome outcome = run_world(scenario);
    EXPECT_THAT(outcome.broken, IsEmpty()) << outcome.journal;
    const auto done = answers_with_key(outcome, 200, 300);
    repeated_count += done.size() > 1 && done.back().at > 30s ? 1U : 0U;
    EXPECT_THAT(answers_with_key(outcome, 0, 600), SizeIs(3)) << outcome.journal;
  }
  EXPECT_GT(repeated_count, 0u) << "else none of them was taken and asked for again";
}

}  // namespace
}  // namespace simulation
