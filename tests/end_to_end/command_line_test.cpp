// What a person meets first: help, manual pages, completion, and being told what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/environment.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

std::string cell_file(const std::string& name) {
  return std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/" + name + "/cell.json";
}

class CommandLine : public ::testing::Test {
 protected:
  Finished run(const std::vector<std::string>& arguments) {
    return Process(arguments, folder_ / "call.err").wait();
  }

  /// The names at the beginning of the lines of a help text that this matches.
  std::set<std::string> names_in_help(std::vector<std::string> program, const std::regex& line_of_a_name) {
    program.push_back("--help");
    std::istringstream help(run(program).out);
    std::set<std::string> names;
    std::smatch found;
    for (std::string line; std::getline(help, line);) {
      if (std::regex_search(line, found, line_of_a_name)) names.insert(found[1]);
    }
    return names;
  }
  std::set<std::string> options(const std::vector<std::string>& program) {
    return names_in_help(program, std::regex("^ +(?:-[a-zA-Z],)?(--[a-z-]+)"));
  }
  std::set<std::string> commands() { return names_in_help({"touchcal"}, std::regex("^  ([a-z][a-z-]+) ")); }

  Folder folder_;
};

/// A page without the backslashes that keep its dashes.
std::string manual_page(const std::string& name) {
  std::ifstream file(std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "service/man" / name);
  std::string page{std::istreambuf_iterator<char>(file), {}};
  std::erase(page, '\\');
  return page;
}

TEST_F(CommandLine, EveryCommandAndOptionIsInTheManualAndTheShellKnowsIt) {
  const std::string page = manual_page("touchcal.1");
  const std::string bash = run({"touchcal", "completion", "bash"}).out;
  const std::string zsh = run({"touchcal", "completion", "zsh"}).out;
  const std::set<std::string> names = commands();
  ASSERT_GE(names.size(), 20U);
  for (const std::string& command : names) {
    for (const std::string* text : {&page, &bash, &zsh}) EXPECT_THAT(*text, HasSubstr(command));
    const std::regex case_of_it("\n    " + command + "\\) ([^\n]*)");
    std::smatch options_line;
    ASSERT_TRUE(std::regex_search(bash, options_line, case_of_it)) << command;
    for (const std::string& option : options({"touchcal", command})) {
      EXPECT_THAT(page, HasSubstr(option)) << command;
      EXPECT_THAT(options_line[1].str(), HasSubstr(option)) << command;
      EXPECT_THAT(zsh, HasSubstr("'" + option + "[")) << command;
    }
  }
}

TEST_F(CommandLine, EveryOptionOfTheServersIsInTheirManual) {
  for (const auto& [program, page] : {std::pair("touchcald", "touchcald.8"), {"cs8sim", "cs8sim.1"}}) {
    const std::set<std::string> names = options({program});
    ASSERT_GE(names.size(), 5U);
    for (const std::string& option : names) EXPECT_THAT(manual_page(page), HasSubstr(option)) << program;
  }
}

TEST_F(CommandLine, HelpOfTheSimulatorSaysWhatIsWallTimeAndWhatIsSimulated) {
  const std::string help = std::regex_replace(run({"cs8sim", "--help"}).out, std::regex("\\s+"), " ");
  EXPECT_THAT(help, HasSubstr("simulated against wall time; max: motions take no time"));
  EXPECT_THAT(help,
              HasSubstr("Motions take simulated time (--speed); deadlines, the silence that ends a link "
                        "and the wait for a confirmation are wall time."));
  EXPECT_THAT(help, HasSubstr("With --val3 these are the application's and simulated too: it waits for the "
                              "host's heartbeats."));
}

TEST_F(CommandLine, ACommandThatThereIsNotIsToldWithTheOneThatWasMeant) {
  const Finished swapped = run({"touchcal", "statsu"});
  EXPECT_EQ(swapped.exit_code, cell::kExitUsage);
  EXPECT_THAT(swapped.err, AllOf(HasSubstr("there is no command 'statsu'; did you mean 'status'?"),
                                 HasSubstr("touchcal --help")));
  const Finished strange = run({"touchcal", "banana", "--json"});
  EXPECT_EQ(strange.exit_code, cell::kExitUsage);
  EXPECT_THAT(strange.err, AllOf(HasSubstr("no command 'banana'"), Not(HasSubstr("did you mean"))));
}

TEST_F(CommandLine, AnOptionThatIsNoneIsToldBeforeOneThatIsMissing) {
  const Finished finished = run({"touchcald", "--bogus"});
  EXPECT_EQ(finished.exit_code, cell::kExitUsage);
  EXPECT_THAT(finished.err, HasSubstr("--bogus"));
  EXPECT_THAT(finished.err, Not(HasSubstr("--cell")));
}

TEST_F(CommandLine, CheckTellsAllThatIsWrongAtOnceAndChangesNothing) {
  const auto file = folder_ / "in-the-way";
  std::ofstream(file) << "a file";
  const Finished bad = run({"touchcald", "--check", "--cell", (folder_ / "none.json").string(), "--state",
                            (file / "state").string(), "--listen", "no.such.host.invalid:1"});
  EXPECT_EQ(bad.exit_code, cell::kExitBadInput);
  EXPECT_EQ(bad.out, "");
  for (const char* what : {"none.json", "in-the-way", "no.such.host.invalid"})
    EXPECT_THAT(bad.err, HasSubstr(what));

  const auto state = folder_ / "state";
  const Finished good = run({"touchcald", "--check", "--cell", cell_file("demo"), "--state", state.string(),
                             "--listen", "127.0.0.1:0"});
  EXPECT_EQ(good.exit_code, cell::kExitDone) << good.err;
  EXPECT_THAT(good.out, HasSubstr("demo is in order"));
  EXPECT_FALSE(std::filesystem::exists(state));

  folder_.directory("state");
  std::ofstream(state / "operate.token") << "for all to read\n";
  std::filesystem::permissions(state / "operate.token", std::filesystem::perms(0644));
  const Finished open = run({"touchcald", "--check", "--cell", cell_file("demo"), "--state", state.string(),
                             "--listen", "127.0.0.1:0"});
  EXPECT_EQ(open.exit_code, cell::kExitFailed);
  EXPECT_THAT(open.err, HasSubstr("chmod 600"));
}

TEST_F(CommandLine, CheckLooksAtWhatADaemonHasAlsoWhileItRuns) {
  const auto state = folder_ / "state";
  const std::vector<std::string> check{"touchcald", "--check",      "--cell",   cell_file("edf"),
                                       "--state",   state.string(), "--listen", "127.0.0.1:0"};
  Process served({"touchcald", "--cell", cell_file("edf"), "--state", state.string(), "--listen",
                  "127.0.0.1:0", "--controller", "127.0.0.1:9"},
                 folder_ / "served.err");
  served.wait_for_address();
  const Finished beside = run(check);
  EXPECT_EQ(beside.exit_code, cell::kExitDone) << beside.err;
  EXPECT_EQ(beside.out, cell_file("edf") + ": cell edf is in order\n") << "all of it was looked at";
  served.signal(SIGTERM);
  EXPECT_EQ(served.wait().exit_code, cell::kExitDone);
  std::ofstream(state / "place.json") << "{}";
  std::ofstream(state / "touchcal.sqlite") << std::string(8192, 'x');
  const Finished bad = run(check);
  EXPECT_EQ(bad.exit_code, cell::kExitBadInput);
  EXPECT_THAT(bad.err, HasSubstr("touchcal.sqlite: file is not a database; restore the last backup"));
  EXPECT_THAT(bad.err, HasSubstr("place.json: "));
}

TEST_F(CommandLine, AnEmptyDatabaseOfAStateDirectoryThatWasInUseIsNoNewOne) {
  const auto state = folder_.directory("state");
  std::ofstream(state / "touchcal.sqlite").close();
  std::ofstream(state / "touchcal.begun") << "by an earlier daemon";
  for (const auto& [how, exit_code] : {std::pair("--check", cell::kExitBadInput),  // it is damage
                                       std::pair("--loopback-needs-token", cell::kExitFailed)}) {
    const Finished refused = run({"touchcald", how, "--cell", cell_file("demo"), "--state", state.string(),
                                  "--listen", "127.0.0.1:0"});
    EXPECT_EQ(refused.exit_code, exit_code);
    EXPECT_THAT(refused.err, HasSubstr("touchcal.sqlite: is empty"));
    EXPECT_THAT(refused.err, HasSubstr("restore the last backup"));
  }
  EXPECT_EQ(std::filesystem::file_size(state / "touchcal.sqlite"), 0U);
}

TEST_F(CommandLine, AStateDirectoryThatIsAFileIsToldWithTheRemedy) {
  const auto file = folder_ / "state";
  std::ofstream(file) << "a file";
  const std::vector<std::vector<std::string>> calls{
      {"touchcald", "--cell", cell_file("demo"), "--state", file.string(), "--listen", "127.0.0.1:0"},
      {"touchcald", "--verify", "--state", file.string()},
      {"touchcald", "--backup", (folder_ / "copy").string(), "--state", file.string()},
      {"touchcal", "status", "--state", file.string()}};
  for (const auto& call : calls) {
    const Finished refused = run(call);
    EXPECT_EQ(refused.exit_code, cell::kExitFailed) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(file.string() + " is not a directory; name another"));
  }
}

TEST_F(CommandLine, AStateDirectoryThatIsADeadLinkIsToldWithTheRemedy) {
  const auto link = folder_ / "link";
  std::filesystem::create_symlink(folder_ / "gone", link);
  const Finished refused =
      run({"touchcald", "--cell", cell_file("demo"), "--state", link.string(), "--listen", "127.0.0.1:0"});
  EXPECT_EQ(refused.exit_code, cell::kExitFailed);
  EXPECT_THAT(refused.err, HasSubstr(link.string() + " is a link to " + (folder_ / "gone").string() +
                                     ", which is not there; make that directory"));
}

TEST_F(CommandLine, AStateDirectoryThatOthersMayWriteInKeepsTheDaemonFromStarting) {
  const auto state = folder_.directory("state");
  std::filesystem::permissions(state, std::filesystem::perms(0777));
  for (const char* how : {"--check", "--loopback-needs-token"}) {
    const Finished refused = run({"touchcald", how, "--cell", cell_file("demo"), "--state", state.string(),
                                  "--listen", "127.0.0.1:0"});
    EXPECT_EQ(refused.exit_code, cell::kExitFailed) << how;
    EXPECT_THAT(refused.err, HasSubstr("chmod 700 " + state.string())) << how;
  }
  EXPECT_TRUE(std::filesystem::is_empty(state)) << "nothing was made there";
}

TEST_F(CommandLine, RunsAreKeptForAHundredYearsAtMost) {
  for (const char* days : {"150000", "36501", "0", "-1", "99999999999999999999"}) {
    const Finished refused = run({"touchcald", "--cell", cell_file("demo"), "--retain-days", days});
    EXPECT_EQ(refused.exit_code, cell::kExitUsage) << days;
    EXPECT_THAT(refused.err, HasSubstr("--retain-days")) << days;
  }
}

TEST_F(CommandLine, AHostNameHasAPortOrNone) {
  for (const char* name : {"robot.example:0", "robot.example:65536", "https://robot.example", "robot:"}) {
    const Finished refused = run({"touchcald", "--cell", cell_file("demo"), "--host-name", name});
    EXPECT_EQ(refused.exit_code, cell::kExitUsage) << name;
    EXPECT_THAT(refused.err, HasSubstr("is not NAME or NAME:PORT of a host")) << name;
  }
}

TEST_F(CommandLine, ABrokerIsAnAddressAndWhatItsCertificatesNeed) {
  const auto refusal = [&](const std::vector<std::string>& options) {
    std::vector<std::string> call{"touchcald", "--cell", cell_file("demo")};
    call.insert(call.end(), options.begin(), options.end());
    const Finished refused = run(call);
    EXPECT_EQ(refused.exit_code, cell::kExitUsage) << options.back();
    return refused.err;
  };
  EXPECT_THAT(refusal({"--mqtt", "mqtt://user:word@broker"}), HasSubstr("is not mqtt://HOST[:PORT]"));
  EXPECT_THAT(refusal({"--mqtt", "mqtts://broker"}), HasSubstr("needs --mqtt-ca"));
  EXPECT_THAT(refusal({"--mqtt", "mqtt://broker", "--mqtt-ca", "ca.crt"}), HasSubstr("has to be mqtts://"));
  EXPECT_THAT(refusal({"--mqtt-ca", "ca.crt"}), HasSubstr("has to be mqtts://"));
  EXPECT_THAT(refusal({"--mqtt", "mqtts://broker", "--mqtt-ca", "ca.crt", "--mqtt-key", "k"}),
              HasSubstr("belong together"));
}

TEST_F(CommandLine, NumbersAreDecimal) {
  const std::vector<std::vector<std::string>> calls{
      {"touchcald", "--retain-days", "0x10"},
      {"touchcal", "audit", "--limit", "0x10"},
      {"touchcal", "run", "--arm-moving", "0x10"},
      {"touchcal", "run", "--block-temperature", "0x10", "--std-block-temperature", "1"},
      {"touchcal", "run", "--block-temperature", "20", "--std-block-temperature", "0x1"},
      {"touchcal", "identify", "--monte-carlo", "0x1000"},
      {"touchcal", "approve", "1", "--valid-days", "0x10"},
      {"touchcal", "plan", "--fit", "0x10"},
      {"touchcal", "plan", "--accuracy", "0x1p-2"},
      {"touchcal", "plan", "--workspace-box", "0x10,0,0,1,1,1"},
      {"touchcal", "plan", "--place", "--place-min", "0x10,0,0"},
      {"touchcal", "plan", "--place", "--place-max", "0,0,0x10"},
      {"touchcal", "plan", "--place", "--place-yaw", "0,0x10"},
      {"touchcal", "plan", "--place", "--places", "0x10"},
      {"touchcal", "compensate", "--line-max", "0x1"},
      {"touchcal", "compensate", "--flange-mm", "0x10"},
      {"touchcal", "fleet", "--cell", "x", "--before", "0x10"},
      {"touchcal", "fleet", "--trends", "0x10"},
      {"cs8sim", "--seed", "0x10"},
      {"cs8sim", "--run", "x", "--for", "0x10"},
      {"cs8sim", "--link-patience", "0x1000"},
      {"cs8sim", "--speed", "0x10"}};
  std::set<std::string> tried;
  for (const auto& call : calls) {
    const Finished refused = run(call);
    EXPECT_EQ(refused.exit_code, cell::kExitUsage) << call[0] << ' ' << call[1];
    const auto value =
        std::ranges::find_if(call, [](const auto& word) { return word.find("0x1") != std::string::npos; });
    EXPECT_THAT(refused.err, AllOf(HasSubstr(*(value - 1)), HasSubstr("'0x1"))) << call[0] << ' ' << call[1];
    tried.insert(*(value - 1));
  }
  std::vector<std::vector<std::string>> programs{{"touchcald"}, {"cs8sim"}};
  for (const std::string& command : commands()) programs.push_back({"touchcal", command});
  const std::regex line_of_a_number("^ +(?:-[a-zA-Z],)?(--[a-z-]+) (?:.*\\b(?:U?INT|FLOAT)\\b|N=|X\\|)");
  std::size_t numbers = 0;
  for (const auto& program : programs) {
    const auto names = names_in_help(program, line_of_a_number);
    numbers += names.size();
    EXPECT_THAT(tried, IsSupersetOf(names)) << program.back();
  }
  EXPECT_GE(numbers, calls.size() - 1) << "the help names its numbers in another way";
}

TEST_F(CommandLine, ASeedOfMoreThan64BitsIsNotCut) {
  for (const char* seed : {"18446744073709551616", "-1"}) {
    const Finished refused = run({"cs8sim", "--cell", cell_file("edf"), "--seed", seed});
    EXPECT_EQ(refused.exit_code, cell::kExitUsage);
    EXPECT_THAT(refused.err, HasSubstr("--seed: wants a whole number from 0 to 18446744073709551615"));
  }
}

TEST_F(CommandLine, AnEmptyOptionIsNotTakenForOneThatWasLeftOut) {
  const std::string cell = cell_file("demo");
  const std::vector<std::vector<std::string>> calls{{"touchcald", "--cell", cell, "--state", ""},
                                                    {"touchcald", "--cell", cell, "--listen", ""},
                                                    {"touchcald", "--cell", cell, "--controller", ""},
                                                    {"touchcald", "--cell", cell, "--tls-cert", ""},
                                                    {"touchcald", "--cell", cell, "--tls-key", ""},
                                                    {"touchcald", "--cell", cell, "--backup", ""},
                                                    {"touchcald", "--cell", ""},
                                                    {"touchcal", "status", "--state", ""},
                                                    {"touchcal", "status", "--daemon", ""},
                                                    {"cs8sim", "--cell", cell, "--truth", ""},
                                                    {"cs8sim", "--cell", cell, "--faults", ""},
                                                    {"cs8sim", "--cell", cell, "--control", ""},
                                                    {"cs8sim", "--cell", cell, "--listen", ""}};
  for (const auto& call : calls) {
    const Finished refused = run(call);
    EXPECT_EQ(refused.exit_code, cell::kExitUsage) << ::testing::PrintToString(call);
    EXPECT_THAT(refused.err, HasSubstr(*(call.end() - 2) + ": is empty; give it a value"));
  }
}

TEST_F(CommandLine, AnAddressWithOneBracketIsNone) {
  for (const char* option : {"--controller", "--listen"}) {
    const Finished refused = run({"touchcald", "--cell", cell_file("demo"), option, "[::1"});
    EXPECT_EQ(refused.exit_code, cell::kExitUsage);
    EXPECT_THAT(refused.err, HasSubstr(std::string(option) + ": '[::1' is not HOST:PORT"));
  }
}

TEST_F(CommandLine, AnIpv6AddressIsToldInBrackets) {
  const std::string nobody = "[::1]:1";
  const Finished status =
      run({"touchcal", "status", "--daemon", "http://" + nobody, "--state", folder_.path().string()});
  EXPECT_EQ(status.exit_code, cell::kExitUnreachable);
  EXPECT_THAT(status.err, HasSubstr("no touchcald answers at http://" + nobody + " ("));
  const std::string elsewhere = "[2001:db8::1]:11000";  // an address for documentation (RFC 3849)
  const Finished simulator = run({"cs8sim", "--cell", cell_file("edf"), "--listen", elsewhere});
  EXPECT_THAT(simulator.err, HasSubstr("cannot listen on " + elsewhere + ": "));
}

/// 0.0.0.0 is not named as this machine and leads to it, so that what leaves is seen here.
TEST_F(CommandLine, AnOperateTokenGoesInClearToAnotherMachineByThatWordOnly) {
  const Environment token("TOUCHCAL_TOKEN", "token-of-somebody");
  boost::asio::io_context io;
  boost::asio::ip::tcp::acceptor server(io, {boost::asio::ip::address_v4::loopback(), 0});
  const auto call = [&](const std::string& host) {
    const std::string url = "http://" + host + ":" + std::to_string(server.local_endpoint().port());
    return std::vector<std::string>{"touchcal", "stop", "--daemon", url, "--state", folder_.path().string()};
  };
  const auto is_called = [&](int milliseconds) {
    pollfd caller{server.native_handle(), POLLIN, 0};
    return ::poll(&caller, 1, milliseconds) == 1;
  };
  const Finished refused = run(call("0.0.0.0"));
  EXPECT_EQ(refused.exit_code, cell::kExitUsage);
  EXPECT_THAT(refused.err, HasSubstr("the token would go to another machine in clear; use https, or say "
                                     "--token-in-clear"));
  EXPECT_FALSE(is_called(0)) << "nothing has left";
  std::vector<std::string> by_word = call("0.0.0.0");
  by_word.emplace_back("--token-in-clear");
  for (const std::vector<std::string>& allowed : {by_word, call("127.0.0.1")}) {
    Process client(allowed, folder_ / "call.err");
    ASSERT_TRUE(is_called(60'000));
    boost::asio::ip::tcp::socket called = server.accept();
    std::string head;
    boost::asio::read_until(called, boost::asio::dynamic_buffer(head), "\r\n\r\n");
    EXPECT_THAT(head, HasSubstr("Authorization: Bearer token-of-somebody\r\n"));
    called.close();
    EXPECT_EQ(client.wait().exit_code, cell::kExitUnreachable);
  }
}

TEST_F(CommandLine, ACertificateWithoutItsKeyIsToldBeforeAnythingElse) {
  const std::string none = (folder_ / "none.json").string();
  const Finished lone = run({"touchcald", "--cell", none, "--tls-cert", "cert.pem"});
  EXPECT_EQ(lone.exit_code, cell::kExitUsage);
  EXPECT_THAT(lone.err, HasSubstr("--tls-cert: is given without --tls-key; give both"));
  const Finished key = run({"touchcald", "--check", "--cell", none, "--tls-key", "key.pem"});
  EXPECT_EQ(key.exit_code, cell::kExitUsage);
  EXPECT_THAT(key.err, HasSubstr("--tls-key: is given without --tls-cert; give both"));
}

TEST_F(CommandLine, TheUnitIsAsClosedAsItCanBe) {
  const std::string unit = std::string(TOUCHCAL_SOURCE_DIR) + "/service/touchcald.service";
  const Finished judged = run({"/usr/bin/systemd-analyze", "security", "--offline=true", "--threshold=10",
                               "--no-pager", unit});  // tenths: at most 1.0
  EXPECT_EQ(judged.exit_code, 0) << judged.out << judged.err;
}

}  // namespace
}  // namespace touchcal::testing
