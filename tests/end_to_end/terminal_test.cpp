// What service/demo leaves up outlives the terminal that it was started from.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/use_future.hpp>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <variant>

#include "cs8_protocol/framing.hpp"
#include "tests/end_to_end/folder.hpp"

namespace touchcal::testing {
namespace {

namespace asio = boost::asio;

/// A shell with a terminal of its own, which runs one command and then waits.
class Terminal {
 public:
  explicit Terminal(const std::string& command) {
    shell_ = ::forkpty(&screen_, nullptr, nullptr, nullptr);
    if (shell_ < 0) throw std::system_error(errno, std::generic_category(), "forkpty");
    if (shell_ == 0) {
      ::execl("/bin/bash", "bash", "-c", command.c_str(), nullptr);
      ::_exit(127);
    }
  }
  ~Terminal() { close(); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// All that is shown up to this text, to the end, or until nothing more is shown for a minute.
  std::string shown_until(const std::string& text) {
    std::string shown;
    std::array<char, 256> bytes{};
    while (shown.find(text) == std::string::npos) {
      pollfd readable{screen_, POLLIN, 0};
      if (::poll(&readable, 1, kPatienceMs) <= 0) break;
      const ssize_t count = ::read(screen_, bytes.data(), bytes.size());
      if (count <= 0) break;
      shown.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return shown;
  }

  /// The window is closed: all programs of its session are hung up.
  void close() {
    if (screen_ < 0) return;
    ::close(screen_);
    screen_ = -1;
    ::waitpid(shell_, nullptr, 0);
  }

 private:
  static constexpr int kPatienceMs = 60'000;

  int screen_ = -1;
  pid_t shell_ = -1;
};

/// A program by the file with its id. It is ended with its test.
class Started {
 public:
  explicit Started(const std::filesystem::path& file) { std::ifstream(file) >> pid_; }
  ~Started() {
    if (pid_ > 0) ::kill(pid_, SIGKILL);
  }
  Started(const Started&) = delete;
  Started& operator=(const Started&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
};

/// The lines of service/demo from `start() {` on, by which it starts both programs.
constexpr const char* kStartOfDemo = R"sh(eval "$(sed -n '/^start() {$/,/^}$/p' "$demo")" || exit
start cs8sim --listen 127.0.0.1:0 --speed max && start touchcald --listen 127.0.0.1:0 --controller 127.0.0.1:9 --state "$home/state" && echo both are up || exit
read -r _ </dev/tty)sh";

bool is_welcomed(unsigned short port) {
  asio::io_context io;
  auto greeting = asio::co_spawn(
      io,
      [&]() -> asio::awaitable<bool> {
        asio::ip::tcp::socket socket(io);
        co_await socket.async_connect({asio::ip::address_v4::loopback(), port}, asio::use_awaitable);
        co_await cs8::write_frame(socket, {0, cs8::Hello{2000}});
        const cs8::DecodeResult frame = co_await cs8::read_frame(socket);
        const auto* message = std::get_if<cs8::Message>(&frame);
        co_return message != nullptr&& std::holds_alternative<cs8::Welcome>(message->payload);
      },
      asio::use_future);
  io.run();
  try {
    return greeting.get();
  } catch (const boost::system::system_error&) {
    return false;
  }
}

TEST(Demonstration, ProgramsThatItLeavesUpOutliveTheirTerminal) {
  const Folder folder;
  std::filesystem::create_directories(folder / "build");
  std::filesystem::create_directory_symlink(TOUCHCAL_PROGRAMS_DIR, folder / "build" / "bin");
  const std::string source = TOUCHCAL_SOURCE_DIR;
  Terminal terminal("cd '" + folder.path().string() + "' && home=. && demo='" + source +
                    "/service/demo' && cell='" + source + "/config/cells/edf/cell.json'\n" + kStartOfDemo);
  const std::string shown = terminal.shown_until("both are up");
  const Started simulator(folder / "cs8sim.pid"), daemon(folder / "touchcald.pid");
  ASSERT_THAT(shown, ::testing::HasSubstr("both are up"));
  for (const Started* program : {&simulator, &daemon})
    EXPECT_EQ(::getsid(program->pid()), program->pid()) << "it is in a session of its own";
  terminal.close();
  constexpr std::string_view kBeforePort = "127.0.0.1:";  // of the first one
  const std::size_t at = shown.find(kBeforePort);
  ASSERT_NE(at, std::string::npos) << shown;
  const int port = std::stoi(shown.substr(at + kBeforePort.size()));
  EXPECT_TRUE(is_welcomed(static_cast<unsigned short>(port))) << "one that was hung up answers no more";
}

}  // namespace
}  // namespace touchcal::testing
