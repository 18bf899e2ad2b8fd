// How a daemon is found by its command line, and what its limits make of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/environment.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> daemon_call(const std::filesystem::path& state) {
  return {"touchcald",   "--cell",      std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json",
          "--listen",    "127.0.0.1:0", "--controller",
          "127.0.0.1:9", "--state",     state.string()};
}

TEST(DaemonReach, WithoutAnAddressItIsFoundByTheSocketOfItsStateDirectory) {
  const Environment unnamed("TOUCHCAL_DAEMON", "");
  const Folder folder;
  Process daemon(daemon_call(folder / "state"), folder / "touchcald.err");
  daemon.wait_for_address();  // a port that nobody was told of
  const std::vector<std::string> call{"touchcal", "stop", "--json", "--state", (folder / "state").string()};
  const Finished stopped = Process(call, folder / "call.err").wait();
  EXPECT_EQ(stopped.exit_code, cell::kExitDone) << stopped.err;
  EXPECT_THAT(stopped.out, HasSubstr("\"STOPPED\""));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, cell::kExitDone);
}

TEST(DaemonReach, OneThatClosesEachConnectionIsToldAsCrowdedAndNotAsMissing) {
  namespace asio = boost::asio;
  const Environment token("TOUCHCAL_TOKEN", "token-of-somebody");
  const Folder folder;
  asio::io_context io(1);
  asio::ip::tcp::acceptor server(io, {asio::ip::address_v4::loopback(), 0});
  asio::co_spawn(
      io,
      [&]() -> asio::awaitable<void> {
        for (;;) (co_await server.async_accept(asio::use_awaitable)).close();
      },
      asio::detached);
  std::jthread serving([&] { io.run(); });
  const std::shared_ptr<void> ends_with_this(nullptr, [&](void*) { io.stop(); });
  const std::string url = "http://127.0.0.1:" + std::to_string(server.local_endpoint().port());
  const std::vector<std::string> call{"touchcal", "stop", "--daemon", url, "--state", folder.path().string()};
  const Finished refused = Process(call, folder / "call.err").wait();
  EXPECT_EQ(refused.exit_code, cell::kExitUnreachable);
  EXPECT_THAT(refused.err, HasSubstr("has too many connections"));
  EXPECT_THAT(refused.err, ::testing::Not(HasSubstr("start it")));
}

/// A signal would end a run without the way back.
TEST(DaemonReach, AFileAtItsLargestSizeIsAFailedWriteAndNoSignal) {
  const Folder folder;
  // 1 KiB: too little for the database, enough for the log, which goes to a file as well
  std::vector<std::string> call{"/bin/bash", "-c", "ulimit -f 1; exec \"$0\" \"$@\""};
  for (const std::string& word : daemon_call(folder / "state")) call.push_back(word);
  call[3] = TOUCHCAL_PROGRAMS_DIR "/" + call[3];
  const Finished finished = Process(call, folder / "touchcald.err").wait();
  EXPECT_EQ(finished.exit_code, cell::kExitFailed) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("touchcal.sqlite"));
}

}  // namespace
}  // namespace touchcal::testing
