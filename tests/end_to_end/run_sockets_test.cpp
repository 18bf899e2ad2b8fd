// cs8sim --run --socket: an application as a process, which other programs talk to over loopback.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <csignal>
#include <fstream>
#include <string>

#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/val3/small_project.hpp"

namespace touchcal::testing {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kDemoCellFile = TOUCHCAL_SOURCE_DIR "/config/cells/demo/cell.json";

/// sim::RunCode and what the command line itself refuses.
constexpr int kRan = 0;
constexpr int kWrong = 2;
constexpr int kUnreadable = 3;
constexpr int kNotHad = 4;

/// Every byte comes back, for one client after the other.
constexpr const char* kEcho =
    "title(\"echo\")\nwhile true\n  n=sioGet(si,in)\n  if n>0\n    n=sioSet(si,in)\n    nBytes=nBytes+1\n"
    "    put(toString(\"\",nBytes))\n  else\n    clearBuffer(si)\n  endIf\nendWhile";

class RunSockets : public ::testing::Test {
 protected:
  RunSockets() {
    project_.number("n").number("in").number("nBytes");
    project_.data("si", "sio", "<Value key=\"0\" link=\"Socket\\host\"/>");
  }
  std::vector<std::string> call(const std::vector<std::string>& more) {
    project_.program("start", kEcho).write();
    std::vector<std::string> arguments{"cs8sim", "--cell", kDemoCellFile, "--run", project_.path().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  Finished run(const std::vector<std::string>& more) {
    return Process(call(more), folder_ / "run.err").wait();
  }
  tcp::socket connected(Process& echo) {
    if (port_.empty()) port_ = echo.wait_for("Socket\\host: listening on 127.0.0.1:");
    tcp::socket client(io_);
    client.connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(port_))});
    return client;
  }

  val3::SmallProject project_;
  Folder folder_;
  asio::io_context io_;
  std::string port_;
};

/// One byte at a time, there and back.
void expect_echo(tcp::socket& client, const std::string& text) {
  for (const char byte : text) {
    asio::write(client, asio::buffer(&byte, 1));
    std::array<char, 1> back{};
    ASSERT_EQ(client.read_some(asio::buffer(back)), 1U);
    EXPECT_EQ(back[0], byte);
  }
}

TEST_F(RunSockets, AServerSpeaksWithOneClientAfterTheOtherUntilASignal) {
  Process echo(call({"--socket", "host=0"}), folder_ / "run.err");
  for (const std::string text : {"hello", "again"}) {
    tcp::socket client = connected(echo);
    expect_echo(client, text);
    tcp::socket second = connected(echo);
    std::array<char, 1> nothing{};
    boost::system::error_code end;
    second.read_some(asio::buffer(nothing), end);
    EXPECT_EQ(end, asio::error::eof) << "a second client is turned away";
    expect_echo(client, "!");
  }
  tcp::socket last = connected(echo);
  expect_echo(last, "?");
  echo.signal(SIGTERM);
  const Finished finished = echo.wait();
  EXPECT_EQ(finished.exit_code, kRan) << finished.out << finished.err;
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("ended by a signal"), HasSubstr("page: echo"), HasSubstr("12345678910111213"),
                    HasSubstr("task small~: status 1"), HasSubstr("0 failures"),
                    HasSubstr(": connections 3, bytes received 13, bytes sent 13")));
  std::array<char, 1> nothing{};
  boost::system::error_code end;
  last.read_some(asio::buffer(nothing), end);
  EXPECT_EQ(end, asio::error::eof) << "a connection ends with the run";
}

TEST_F(RunSockets, AScriptNamesThePeerOfAClientWhichIsCalledAgainWhenItHasClosed) {
  tcp::acceptor peer(io_, {asio::ip::address_v4::loopback(), 0});
  const auto script = folder_ / "my.script";
  std::ofstream(script) << "0 socket Socket\\host 127.0.0.1:" << peer.local_endpoint().port()
                        << "\n600 end\n";
  Process echo(call({"--script", script.string()}), folder_ / "run.err");
  tcp::socket eye = peer.accept();
  expect_echo(eye, "abc");
  eye.close();
  tcp::socket once_more = peer.accept();
  expect_echo(once_more, "d");
  echo.signal(SIGINT);
  const Finished finished = echo.wait();
  EXPECT_EQ(finished.exit_code, kRan) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr(": connections 2, bytes received 4, bytes sent 4"));
}

TEST_F(RunSockets, EndAtTheirSecondsWithoutASignal) {
  const Finished finished = run({"--socket", "host=0", "--for", "0.1"});
  EXPECT_EQ(finished.exit_code, kRan) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr(": connections 0, bytes received 0"));
}

TEST_F(RunSockets, ThatCannotBeHadAreRefusedWithTheRemedy) {
  tcp::acceptor holder(io_, {asio::ip::address_v4::loopback(), 0});
  const std::string taken = std::to_string(holder.local_endpoint().port());
  const Finished in_use = run({"--socket", "host=" + taken});
  EXPECT_EQ(in_use.exit_code, kNotHad);
  EXPECT_THAT(in_use.err, AllOf(HasSubstr("cannot listen on 127.0.0.1:" + taken),
                                HasSubstr("give another port with --socket, or 0 for any free one")));
  const Finished unknown = run({"--socket", "hots=0"});
  EXPECT_EQ(unknown.exit_code, kWrong);
  EXPECT_THAT(unknown.err, HasSubstr("--socket hots: no sio of the application is linked to it alone; give "
                                     "one of these links: Socket\\host"));
  for (const std::string text : {"host", "=5000", "host=70000", "host=127.0.0.1:0", ""}) {
    const Finished wrong = run({"--socket", text});
    EXPECT_EQ(wrong.exit_code, kWrong) << text;
    EXPECT_THAT(wrong.err, AllOf(HasSubstr("--socket: '" + text + "' is not NAME=PLACE"),
                                 HasSubstr("PORT for a server on 127.0.0.1")));
  }
  const auto script = folder_ / "my.script";
  std::ofstream(script) << "0 socket Socket\\host 5000000\n";
  const Finished in_script = run({"--script", script.string()});
  EXPECT_EQ(in_script.exit_code, kUnreadable);
  EXPECT_THAT(in_script.err, HasSubstr("my.script:1: write 'socket SOCKET PORT|HOST:PORT'"));
}

}  // namespace
}  // namespace touchcal::testing
