#include "service/archive/archive_schema.hpp"

#include <gmock/gmock.h>

#include "tests/service/archive/archive_bench.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST_F(ArchiveTest, GetsAnIndexThatAnEarlierOneHasNot) {
  sql("DROP INDEX event_by_time");
  EXPECT_THAT(prepare_archive(owner_), HasSubstr("already"));
  EXPECT_EQ(value("SELECT count(*) FROM pg_indexes WHERE indexname = 'event_by_time'"), "1");
}

TEST_F(ArchiveTest, IsOfAVersionThatIsKnown) {
  EXPECT_THAT(prepare_archive(owner_), HasSubstr("already"));
  sql("UPDATE touchcal_schema SET version = 99");
  EXPECT_THAT([&] { connect(); }, ThrowsMessage<std::runtime_error>(HasSubstr("newer touchcal (schema 99")));
  EXPECT_THAT([&] { prepare_archive(owner_); },
              ThrowsMessage<std::runtime_error>(HasSubstr("newer touchcal")));
  sql("DROP TABLE touchcal_schema");
  EXPECT_THAT([&] { connect(); }, ThrowsMessage<SinkTrouble>(HasSubstr("touchcal archive prepare")));
  EXPECT_THAT([&] { look_at_archive(owner_); },
              ThrowsMessage<std::runtime_error>(HasSubstr("is not prepared")));
}

}  // namespace
}  // namespace cell
