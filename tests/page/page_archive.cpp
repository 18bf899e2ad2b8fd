// The archive of a plant, for the tests of the page: prints "listening on URL", by which the cell `demo`
// writes its facts and reads all; another cell has told some already. The line "away" of its standard input
// takes the server away, whose end ends it.
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "service/archive/archive_schema.hpp"
#include "tests/service/archive/postgres.hpp"

namespace {

void tell(const cell::Postgres& server, int seq, const std::string& kind, const std::string& body) {
  server.sql(
      "INSERT INTO event(cell, seq, instance, kind, at, run, previous, body, sha256) SELECT "
      "'paint-shop-2', " +
      std::to_string(seq) + ", 1, '" + kind + "', to_char(now() AT TIME ZONE 'UTC', " +
      R"('YYYY-MM-DD"T"HH24:MI:SS.MS"Z"'), 1, '', ')" + body + "', ''");
}

}  // namespace

int main() try {
  cell::Postgres server;
  cell::prepare_archive(server.url());
  server.sql("CREATE ROLE demo LOGIN IN ROLE touchcal_writer, touchcal_quality");
  tell(server, 1, "run_started", R"({"recipe":"quick"})");
  tell(server, 2, "run_ended",
       R"({"arm":"tx60","kind":"calibration","recipe":"quick","outcome":"complete","verdict":"accepted"})");
  tell(
      server, 3, "approved",
      R"({"arm":"tx60","hash":"0123456789abcdef","current":"0123456789abcdef","valid_until":null,"tip_box_max_mm":0.0625})");
  tell(server, 4, "applied", R"({"hash":"fedcba9876543210","to":"pick.dtx on the robot"})");
  tell(
      server, 5, "check",
      R"({"arm":"tx60","verdict":"rejected","cause":"joint","joint":3,"growth_ppm":12.5,"every_days":7,"of_run":1})");
  std::printf("listening on %s\n", server.url("demo").c_str());
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "away") server.kill();
    std::puts(line.c_str());
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "page_archive: %s\n", error.what());
  return 1;
}
