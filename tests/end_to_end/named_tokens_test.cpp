// Operate tokens with names, from their files to what the audit and its exports tell of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/service/raw_http.hpp"

namespace touchcal::testing {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class NamedTokens : public ::testing::Test {
 protected:
  NamedTokens() {
    folder_.directory("state/operators");
    write("anna", std::string(64, '1'));
    write("bert", std::string(64, '2'));
  }
  ~NamedTokens() override { unsetenv("TOUCHCAL_TOKEN"); }

  void write(const std::string& name, const std::string& token) const {
    const auto file = state_ / "operators" / name;
    std::ofstream(file) << token << "\n";
    std::filesystem::permissions(file, std::filesystem::perms(0600));
  }
  [[nodiscard]] std::vector<std::string> daemon(const std::vector<std::string>& more = {}) const {
    const std::string cell = std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json";
    std::vector<std::string> arguments{"touchcald", "--cell", cell, "--state", state_.string()};
    arguments.insert(arguments.end(), {"--listen", "127.0.0.1:0", "--controller", "127.0.0.1:9"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  /// touchcal with this token; with that of the state directory if there is none.
  Finished run(const std::string& token, std::vector<std::string> arguments) {
    if (token.empty()) {
      unsetenv("TOUCHCAL_TOKEN");
    } else {
      setenv("TOUCHCAL_TOKEN", token.c_str(), 1);
    }
    arguments.insert(arguments.begin(), "touchcal");
    arguments.insert(arguments.end(), {"--state", state_.string()});
    return Process(arguments, folder_ / "call.err").wait();
  }

  Folder folder_;
  const std::filesystem::path state_ = folder_ / "state";
};

TEST_F(NamedTokens, TheAuditTellsWhichTokenACommandCameWith) {
  Process served(daemon(), folder_ / "touchcald.err");
  served.wait_for_address();
  for (const std::string& token : {std::string(64, '1'), std::string(64, '2'), std::string()})
    run(token, {"acknowledge"});

  const Finished audit = run("", {"audit", "--json"});
  ASSERT_EQ(audit.exit_code, cell::kExitDone) << audit.err;
  // What came of a command may be written a little later; that it was asked for is there before it is
  // executed.
  std::vector<nlohmann::json> asked;
  const auto document = nlohmann::json::parse(audit.out);
  for (const auto& row : document.at("rows"))
    if (row.at("outcome") == "asked") asked.push_back(row);
  ASSERT_EQ(asked.size(), 3U) << audit.out;
  EXPECT_TRUE(asked[0].at("token").is_null()) << "newest first; operate.token has no name";
  EXPECT_EQ(asked[1].at("token"), "bert");
  EXPECT_EQ(asked[2].at("token"), "anna");
  EXPECT_EQ(asked[2].at("role"), "operate");
  EXPECT_THAT(run("", {"audit"}).out, AllOf(ContainsRegex("operate +anna +- "), HasSubstr(" bert ")));
  EXPECT_THAT(run("", {"audit", "--csv"}).out, HasSubstr("\"operate\",\"anna\",\"\","));
  served.signal(SIGTERM);
  EXPECT_EQ(served.wait().exit_code, cell::kExitDone);
}

TEST_F(NamedTokens, OneThatIsRemovedEndsAndANewOneCountsWithoutARestart) {
  const std::string bert(64, '2'), cora(64, '3');
  Process served(daemon(), folder_ / "touchcald.err");
  served.wait_for_address();
  ASSERT_EQ(run(bert, {"acknowledge"}).exit_code, cell::kExitDone);
  EXPECT_NE(run(cora, {"acknowledge"}).exit_code, cell::kExitDone);
  std::filesystem::remove(state_ / "operators" / "bert");
  write("cora", cora);
  constexpr int kCallsMax = 1000;  // each takes a while
  int calls = 0;
  while (run(bert, {"acknowledge"}).exit_code == cell::kExitDone && calls < kCallsMax) ++calls;
  while (run(cora, {"acknowledge"}).exit_code != cell::kExitDone && calls < kCallsMax) ++calls;
  EXPECT_LT(calls, kCallsMax);
  EXPECT_THAT(run(bert, {"acknowledge"}).err, HasSubstr("requires its token"));
  EXPECT_EQ(run(std::string(64, '1'), {"acknowledge"}).exit_code, cell::kExitDone) << "anna's is as before";
  served.signal(SIGTERM);
  EXPECT_EQ(served.wait().exit_code, cell::kExitDone);
}

TEST_F(NamedTokens, AStreamOfEventsEndsWithItsToken) {
  Process served(daemon(), folder_ / "touchcald.err");
  const std::string address = served.wait_for_address();
  const std::string port = address.substr(address.rfind(':') + 1);
  cell::RawClient reader(
      {boost::asio::ip::address_v4::loopback(), static_cast<boost::asio::ip::port_type>(std::stoi(port))});
  reader.send("GET /api/v1/events HTTP/1.1\r\nHost: " + address + "\r\nAuthorization: Bearer " +
              std::string(64, '2') + "\r\n\r\n");
  ASSERT_EQ(reader.receive(true).status, 200U);
  std::filesystem::remove(state_ / "operators" / "bert");
  reader.receive_until("no event ends so");
  EXPECT_TRUE(reader.closed()) << "sooner than a stream says that it lives";
  served.signal(SIGTERM);
  EXPECT_EQ(served.wait().exit_code, cell::kExitDone);
}

TEST_F(NamedTokens, TheTokensWithoutANameAreReadAgainToo) {
  Process served(daemon(), folder_ / "touchcald.err");
  served.wait_for_address();
  const std::string token = "0f1e2d3c4b5a69788796a5b4c3d2e1f00f1e2d3c4b5a69788796a5b4c3d2e1f0";
  EXPECT_NE(run(token, {"acknowledge"}).exit_code, cell::kExitDone);
  std::ofstream(state_ / "new") << token << "\n";
  std::filesystem::permissions(state_ / "new", std::filesystem::perms(0600));
  std::filesystem::rename(state_ / "new", state_ / "operate.token");
  constexpr int kCallsMax = 1000;  // each takes a while
  int calls = 0;
  while (run(token, {"acknowledge"}).exit_code != cell::kExitDone && calls < kCallsMax) ++calls;
  std::filesystem::remove(state_ / "operate.token");
  while (run(token, {"acknowledge"}).exit_code == cell::kExitDone && calls < kCallsMax) ++calls;
  EXPECT_LT(calls, kCallsMax);
  EXPECT_EQ(run("", {"acknowledge"}).exit_code, cell::kExitDone) << "with the one that was made anew";
  served.signal(SIGTERM);
  EXPECT_EQ(served.wait().exit_code, cell::kExitDone);
}

TEST_F(NamedTokens, EachRefusalOfAFloodIsInTheAuditOrCountedThereOnceTheDaemonHasEnded) {
  constexpr int kFlood = 300;
  {
    Process served(daemon(), folder_ / "touchcald.err");
    const std::string address = served.wait_for_address();
    const std::string port = address.substr(address.rfind(':') + 1);
    cell::RawClient stranger(
        {boost::asio::ip::address_v4::loopback(), static_cast<boost::asio::ip::port_type>(std::stoi(port))});
    for (int i = 0; i < kFlood; ++i) {
      stranger.send("POST /api/v1/cell/reset HTTP/1.1\r\nHost: " + address + "\r\nContent-Length: 0\r\n\r\n");
      ASSERT_EQ(stranger.receive().status, 401U);
    }
    served.signal(SIGTERM);
    EXPECT_EQ(served.wait().exit_code, cell::kExitDone);
  }
  Process served(daemon(), folder_ / "touchcald.err");
  served.wait_for_address();
  const Finished audit = run("", {"audit", "--json", "--limit", "500"});
  int rows = 0, told = 0;
  const auto document = nlohmann::json::parse(audit.out);
  for (const auto& row : document.at("rows")) {
    if (row.at("role") != "none") continue;
    ++rows;
    told += 1 + std::atoi(row.at("detail").get<std::string>().c_str());
  }
  EXPECT_EQ(told, kFlood) << audit.out;
  EXPECT_LT(rows, kFlood) << "the rest is counted";
  served.signal(SIGTERM);
  EXPECT_EQ(served.wait().exit_code, cell::kExitDone);
}

TEST_F(NamedTokens, ABadOneKeepsTheDaemonFromStartingAndTheCheckTellsIt) {
  write("cora", std::string(64, '1'));
  for (const bool checks : {true, false}) {
    const auto more = checks ? std::vector<std::string>{"--check"} : std::vector<std::string>{};
    const Finished refused = Process(daemon(more), folder_ / "touchcald.err").wait();
    EXPECT_EQ(refused.exit_code, checks ? cell::kExitBadInput : cell::kExitFailed);
    EXPECT_THAT(refused.err,
                AllOf(HasSubstr("operators/anna"), HasSubstr("operators/cora: holds the token")));
  }
}

}  // namespace
}  // namespace touchcal::testing
