#include "service/archive/archive_options.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(ArchiveOptions, TakeAServerWhoseNameIsVerifiedOrThisMachine) {
  for (const char* url :
       {"postgresql://cell-1@db.plant/touchcal?sslmode=verify-full&sslcert=a.crt&sslkey=a.key",
        "postgres://db.plant:5433/touchcal?sslmode=verify-full", "postgresql://127.0.0.1/touchcal",
        "postgresql://edf@/touchcal?host=%2Frun%2Fpostgresql"})
    EXPECT_EQ(archive_from_url(url), url);
  for (const char* url :
       {"", "db.plant", "http://db.plant/touchcal", "postgresql://db.plant/touchcal",
        "postgresql://db.plant/touchcal?sslmode=require", "postgresql://a:word@127.0.0.1/touchcal",
        "postgresql://127.0.0.1/touchcal?password=word", "postgresql://127.0.0.1", "postgresql://127.0.0.1/",
        "postgresql:///touchcal?host=db.plant", "postgresql://127.0.0.1/touchcal#x"})
    EXPECT_FALSE(archive_from_url(url)) << url;
}

TEST(ArchiveOptions, BoundsAreThoseGivenOrOurs) {
  EXPECT_EQ(with_archive_bounds("postgresql://h/d"),
            "postgresql://h/d?connect_timeout=5&tcp_user_timeout=15000");
  EXPECT_EQ(with_archive_bounds("postgresql://h/d?connect_timeout=1"),
            "postgresql://h/d?connect_timeout=1&tcp_user_timeout=15000");
}

}  // namespace
}  // namespace cell
