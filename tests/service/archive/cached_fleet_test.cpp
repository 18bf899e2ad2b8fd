#include "service/archive/cached_fleet.hpp"

#include <gmock/gmock.h>

#include "tests/service/archive/archive_bench.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class CachedFleetTest : public ArchiveTest {
 protected:
  std::chrono::steady_clock::time_point now_{};
  CachedFleet fleet_{owner_, [this] { return now_; }};
};

TEST_F(CachedFleetTest, AsksTheArchiveOnceInAWhile) {
  EXPECT_THAT(fleet_.fleet(), Not(HasSubstr("edf")));
  run_of(store_);
  connect()->deliver(facts(), {});
  now_ += CachedFleet::kKept - std::chrono::milliseconds(1);
  EXPECT_THAT(fleet_.fleet(), Not(HasSubstr("edf")));
  EXPECT_THAT(fleet_.trends(240), HasSubstr("2026-01")) << "it was not asked for before";
  now_ += std::chrono::milliseconds(1);
  EXPECT_THAT(fleet_.fleet(), HasSubstr("edf"));
}

TEST_F(CachedFleetTest, AnArchiveThatIsAwayIsNotAskedForEachWhoLooks) {
  sql("ALTER TABLE touchcal_schema RENAME TO away");
  EXPECT_THROW(fleet_.fleet(), std::runtime_error);
  sql("ALTER TABLE away RENAME TO touchcal_schema");
  EXPECT_THROW(fleet_.fleet(), std::runtime_error) << "as it was found a moment ago";
  EXPECT_THROW(fleet_.trends(3), std::runtime_error) << "whatever is asked for";
  now_ += CachedFleet::kKept;
  EXPECT_THAT(fleet_.fleet(), HasSubstr("touchcal/fleet/1"));
}

}  // namespace
}  // namespace cell
