#include "sim_controller/socket_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <future>
#include <sstream>

#include "bench.hpp"
#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "tests/val3/small_project.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ::testing::HasSubstr;

class SocketRunTest : public ::testing::Test {
 protected:
  SocketRunTest() {
    project_.number("n", 4).number("in", 4).number("one");
    project_.data("si", "sio", "<Value key=\"0\" link=\"Socket\\host\"/>");
    project_.data("siEye", "sio", "<Value key=\"0\" link=\"Socket\\eye\"/>");
    project_.data("siBeacon", "sio", "<Value key=\"0\" link=\"UdpSocket\\beacon\"/>");
    project_.data("siPort", "sio", "<Value key=\"0\" link=\"Serial\\COM1\"/>");
  }

  /// The run of an application whose start has these lines.
  ScriptedRun& begin(const std::string& lines) {
    val3::ReadApplication read = val3::read_application(project_.program("start", lines).write().path());
    val3::resolve(read.application, read.findings);
    application_ = std::move(read.application);
    run_.emplace(plant_, application_, std::vector<ScriptStep>{}, 1, std::chrono::sys_seconds{}, out_);
    val3::Findings findings = std::move(read.findings);
    EXPECT_TRUE(run_->start(findings));
    return *run_;
  }
  std::string refusal_of(const std::vector<RunSocket>& wanted, const std::vector<ScriptStep>& steps = {}) {
    try {
      const SocketRun sockets(*run_, wanted, steps);
    } catch (const WrongSocket& wrong) {
      return wrong.what();
    }
    return "none";
  }

  val3::SmallProject project_;
  const Plant plant_ = testing::true_plant("demo");
  val3::Application application_;
  std::ostringstream out_;
  std::optional<ScriptedRun> run_;
};

TEST_F(SocketRunTest, AnApplicationAsksItsPeerOverARealSocketAndEnds) {
  asio::io_context io;
  tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
  auto peer = std::async(std::launch::async, [&] {
    tcp::socket eye = acceptor.accept();
    std::array<char, 4> asked{};
    asio::read(eye, asio::buffer(asked));
    asio::write(eye, asio::buffer("\x07\x08", 2));
    std::array<char, 1> more{};
    boost::system::error_code end;
    asio::read(eye, asio::buffer(more), end);
    return std::string(asked.data(), asked.size()) + (end == asio::error::eof ? " and the end" : "");
  });
  ScriptedRun& run = begin("siEye=\"see\"\nn[0]=siEye\nn[1]=siEye\nclearBuffer(siEye)");
  const std::vector<RunSocket> wanted{{"eye", "127.0.0.1", acceptor.local_endpoint().port()}};
  SocketRun(run, wanted, {}).run(60.0, 1.0);
  EXPECT_TRUE(run.is_over()) << out_.str();
  EXPECT_EQ(run.summary(), 0);
  EXPECT_THAT(out_.str(), HasSubstr("Socket\\eye at 127.0.0.1:" + std::to_string(wanted[0].port) +
                                    ": connections 1, bytes received 2, bytes sent 4"));
  // Where the application did not connect the peer still waits: this lets it go.
  tcp::socket(io).connect(acceptor.local_endpoint());
  EXPECT_EQ(peer.get(), "see\r and the end");
}

TEST_F(SocketRunTest, TellsOnceThatItsPlaceIsNotThatOfSioCtrl) {
  ScriptedRun& run =
      begin("one=sioCtrl(si,\"port\",1234)\none=sioCtrl(si,\"target\",\"10.0.0.1\")\ndelay(0.05)");
  SocketRun(run, std::vector<RunSocket>{{"host", "", 0}, {"eye", "", 0}}, {}).run(1.0, 1.0);
  const std::string told = "its place is that of --socket; port and target of sioCtrl change nothing";
  const std::string out = out_.str();
  EXPECT_THAT(out, HasSubstr("Socket\\host: " + told));
  EXPECT_EQ(out.find(told), out.rfind(told)) << out;
}

TEST_F(SocketRunTest, TimeIsWallTime) {
  constexpr double kSeconds = 0.3;
  ScriptedRun& run = begin("wait(false)");
  const auto begin = std::chrono::steady_clock::now();
  SocketRun(run, std::vector<RunSocket>{{"host", "", 0}}, {}).run(kSeconds, 1.0);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(run.seconds(), kSeconds);
  EXPECT_GE(took.count(), kSeconds - 0.1) << "Val3Pace makes up for so much lag";
}

TEST_F(SocketRunTest, RefusesWhatIsNoSocketOfTheApplication) {
  begin("wait(false)");
  EXPECT_EQ(refusal_of({{"Socket\\host", "", 0}, {"eye", "", 0}}), "none");
  EXPECT_THAT(refusal_of({{"hots", "", 0}}),
              HasSubstr("--socket hots: no sio of the application is linked to it alone; give one of these "
                        "links: Socket\\host, Socket\\eye"));
  EXPECT_THAT(refusal_of({{"Serial\\COM1", "", 0}}), HasSubstr("Serial\\COM1 is a serial port, no socket"));
  EXPECT_THAT(refusal_of({{"beacon", "", 0}}), HasSubstr("UdpSocket\\beacon is a UDP socket, and only TCP"));
  EXPECT_THAT(refusal_of({{"host", "", 0}, {"Socket\\host", "", 0}}), HasSubstr("comes twice"));
  const std::vector<ScriptStep> steps{
      {.line = 3, .act = {.kind = ScriptAct::Kind::kSend, .name = "Socket\\host", .text = "x"}}};
  EXPECT_THAT(refusal_of({{"host", "", 0}}, steps),
              HasSubstr("line 3 of the script: Socket\\host is a real"));
  EXPECT_EQ(refusal_of({{"eye", "", 0}}, steps), "none") << "peers in memory stay for the others";
}

}  // namespace
}  // namespace sim
