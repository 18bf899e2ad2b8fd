#include "service/archive/archive_schema.hpp"

#include <gmock/gmock.h>

#include "service/archive/fleet_reader.hpp"
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

TEST_F(ArchiveTest, WhatAnEarlierOneGotIsCountedOnceItIsPreparedAgain) {
  sql("DROP VIEW fleet, fleet_cell; ALTER TABLE event DROP COLUMN counted, DROP COLUMN told_arm, DROP COLUMN "
      "told_verdict, DROP COLUMN told_figure");
  sql("INSERT INTO event(cell, seq, instance, kind, at, previous, body, sha256) VALUES('edf', 1, 1, 'check', "
      "to_char(now() AT TIME ZONE 'UTC', 'YYYY-MM-DD'), '', "
      "'{\"arm\":\"tx90\",\"verdict\":\"rejected\",\"growth_ppm\":4.5}', '')");
  EXPECT_THAT(prepare_archive(owner_), HasSubstr("already"));
  const auto trends = trends_of(owner_, 1).trends;
  ASSERT_EQ(trends.size(), 1U);
  EXPECT_EQ(trends[0].arm, "tx90");
  EXPECT_EQ(trends[0].alarms, 1);
  EXPECT_EQ(trends[0].growth_ppm, 4.5);
}

TEST_F(ArchiveTest, IsInADatabaseOfUnicode) {
  {
    pqxx::connection connection(owner_);
    pqxx::nontransaction(connection)
        .exec0("CREATE DATABASE latin ENCODING 'LATIN1' LOCALE 'C' TEMPLATE template0");
  }
  std::string latin = owner_;
  latin.replace(latin.find("/postgres?"), 10, "/latin?");
  EXPECT_THAT([&] { prepare_archive(latin); }, ThrowsMessage<ArchiveRefused>(HasSubstr("LATIN1")));
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
