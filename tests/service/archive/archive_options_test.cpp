#include "service/archive/archive_options.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

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

TEST(ArchiveOptions, NoOtherMachineIsTakenForThisOne) {
  for (const char* url :
       {"postgresql://127.example.org/touchcal", "postgresql://127.0.0.1.example.org/touchcal",
        "postgresql://128.0.0.1/touchcal", "postgresql:///touchcal?host=127.example.org",
        "postgresql:///touchcal?host=%2Frun%2Fpostgresql,db.plant",
        "postgresql:///touchcal?host=", "postgresql:///touchcal?service=plant",
        "postgresql://127.0.0.1/touchcal?service=plant", "postgresql://127.0.0.1/touchcal?hostaddr=10.0.0.1",
        "postgresql://db.plant/touchcal?sslmode=verify-full&ssl=true"})
    EXPECT_FALSE(archive_from_url(url)) << url;
  EXPECT_TRUE(archive_from_url("postgresql://127.1.2.3/touchcal"));
  EXPECT_TRUE(archive_from_url("postgresql://[::1]/touchcal"));
  EXPECT_TRUE(archive_from_url("postgresql:///touchcal?service=plant&sslmode=verify-full"));
}

TEST(ArchiveOptions, TheEnvironmentLeadsNoUnverifiedConnectionElsewhere) {
  struct Case {
    const char* name;
    const char* value;
    bool without_host;
    bool with_host;
  };
  for (const Case& one :
       {Case{"PGHOST", "db.plant", false, true}, Case{"PGHOST", "/run/postgresql", true, true},
        Case{"PGHOST", "", true, true}, Case{"PGHOSTADDR", "10.0.0.1", false, false},
        Case{"PGHOSTADDR", "127.0.0.1", true, true}, Case{"PGSERVICE", "plant", false, false}}) {
    ::setenv(one.name, one.value, 1);
    const bool without_host = archive_from_url("postgresql:///touchcal").has_value();
    const bool with_host = archive_from_url("postgresql://127.0.0.1/touchcal").has_value();
    const bool verified = archive_from_url("postgresql:///touchcal?sslmode=verify-full").has_value();
    ::unsetenv(one.name);
    EXPECT_EQ(without_host, one.without_host) << one.name << '=' << one.value;
    EXPECT_EQ(with_host, one.with_host) << one.name << '=' << one.value;
    EXPECT_TRUE(verified);
  }
}

TEST(ArchiveOptions, BoundsAreThoseGivenOrOurs) {
  EXPECT_EQ(with_archive_bounds("postgresql://h/d"),
            "postgresql://h/d?connect_timeout=5&tcp_user_timeout=15000&client_encoding=UTF8");
  EXPECT_EQ(with_archive_bounds("postgresql://h/d?connect_timeout=1"),
            "postgresql://h/d?connect_timeout=1&tcp_user_timeout=15000&client_encoding=UTF8");
}

}  // namespace
}  // namespace cell
