#include "service/acquisition/refused_contacts.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include "service/store/refused_result.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class RefusedContactsTest : public ::testing::Test, public OwnersBench {
 protected:
  std::optional<std::string> settle(const cs8::TouchResult& result) {
    return run(refused_.settle(run_id_, here(5), result, "it is too deep"));
  }
  [[nodiscard]] AnsweredCommand here(std::uint32_t sequence) const { return {session.number(), sequence}; }

  std::int64_t run_id_ = store.begin_run({.recipe = "few", .started_at = "start"});
  RefusedContacts refused_{queue, session, time.clocks()};
};

TEST_F(RefusedContactsTest, AContactIsKeptWithItsReasonAndThenForgottenByTheController) {
  const cs8::TouchResult result = contact_at(cell_of_owners().park_joints);
  EXPECT_FALSE(settle(result));
  const auto kept = refused_results(store, run_id_);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].sequence, 5u);
  EXPECT_EQ(kept[0].joints, result.contact);
  EXPECT_EQ(kept[0].reason, "it is too deep");
  EXPECT_FALSE(kept[0].at.empty());
  EXPECT_THAT(controller.asked, ElementsAre("acknowledge 5"));
}

TEST_F(RefusedContactsTest, OneThatCannotBeStoredStaysWithTheController) {
  sqlite3_commit_hook(
      store.database()->getHandle(), [](void*) { return 1; }, nullptr);
  EXPECT_TRUE(settle(contact_at(cell_of_owners().park_joints)));
  EXPECT_THAT(controller.asked, IsEmpty());
  sqlite3_commit_hook(store.database()->getHandle(), nullptr, nullptr);
  EXPECT_FALSE(settle(contact_at(cell_of_owners().park_joints)));
  EXPECT_THAT(controller.asked, ElementsAre("acknowledge 5"));
}

TEST_F(RefusedContactsTest, AnAnswerWithoutAContactLeavesNothingToKeep) {
  cs8::TouchResult nothing;
  nothing.outcome = cs8::Outcome::kNoContact;
  EXPECT_FALSE(settle(nothing));
  EXPECT_THAT(refused_results(store, run_id_), IsEmpty());
  EXPECT_THAT(controller.asked, ElementsAre("acknowledge 5"));
}

TEST_F(RefusedContactsTest, AContactOfAnEarlierSessionIsKeptAndNothingOfThisOneIsForgotten) {
  const cs8::TouchResult result = contact_at(cell_of_owners().park_joints);
  const AnsweredCommand earlier{.session = session.number() + 1, .sequence = 5};
  EXPECT_FALSE(run(refused_.settle(run_id_, earlier, result, "it is too deep")));
  ASSERT_EQ(refused_results(store, run_id_).size(), 1u);
  EXPECT_EQ(refused_results(store, run_id_)[0].session, earlier.session);
  EXPECT_THAT(controller.asked, IsEmpty());
}

TEST_F(RefusedContactsTest, AContactOfNoRunOfThisDaemonIsKeptWithTheNewestInTheStore) {
  const cs8::TouchResult result = contact_at(cell_of_owners().park_joints);
  EXPECT_FALSE(run(refused_.settle(std::nullopt, here(5), result, "nobody asked")));
  ASSERT_EQ(refused_results(store, run_id_).size(), 1u);
  EXPECT_EQ(refused_results(store, run_id_)[0].joints, result.contact);
  EXPECT_THAT(controller.asked, ElementsAre("acknowledge 5"));
}

TEST_F(RefusedContactsTest, WhereTheStoreHasNoRunTheLogAloneHasItAndTheControllerIsFreeOfIt) {
  store.withdraw_run(run_id_);
  EXPECT_FALSE(
      run(refused_.settle(std::nullopt, here(5), contact_at(cell_of_owners().park_joints), "no run")));
  EXPECT_THAT(controller.asked, ElementsAre("acknowledge 5"));
}

}  // namespace
}  // namespace cell
