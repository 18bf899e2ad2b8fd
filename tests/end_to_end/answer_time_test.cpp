// How long the controller waits for the daemon's next command, with the durable commit of the touch in it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/relay.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr int kRunCount = 5;
constexpr double kAnswerMaxMs = 2.0;  // of 99 in 100
/// A touch takes some 20 ms of wall time: longer than the arithmetic that belongs to it.
constexpr double kSimulatedSpeed = 400.0;

/// The 99th of 100.
double high_percentile(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() * 99 / 100];
}

/// How long this machine takes, as it is used now, to put a block on its disk, without any of this project.
double bare_commit_ms(const std::filesystem::path& folder) {
  constexpr int kCommits = 200;
  const std::array<char, 8192> block{};
  const int file = ::open((folder / "bare").c_str(), O_CREAT | O_RDWR, 0600);
  if (file < 0) throw std::runtime_error("no file in " + folder.string());
  std::vector<double> times_ms;
  for (int i = 0; i < kCommits; ++i) {
    const auto start = Clock::now();
    if (::pwrite(file, block.data(), block.size(), 0) < 0 || ::fdatasync(file) != 0)
      throw std::runtime_error("cannot write to " + folder.string());
    times_ms.push_back(Milliseconds(Clock::now() - start).count());
  }
  ::close(file);
  return high_percentile(times_ms);
}

/// The simulated controller and a cable to it, each on a thread of its own: the cable's clock does not wait
/// for what the controller works out, nor for the daemon.
class FarSide {
 public:
  FarSide(const LoopbackCell& loop)
      : server_(server_io_, "127.0.0.1", 0, loop.true_plant(), {.controller = {.speed = kSimulatedSpeed}}),
        relay_(relay_io_, server_.port(), [this](const cs8::Message& message) { watch(message); }),
        server_thread_([this] { server_io_.run(); }),
        relay_thread_([this] { relay_io_.run(); }) {}
  ~FarSide() {
    server_io_.stop();
    relay_io_.stop();
    server_thread_.join();
    relay_thread_.join();
  }
  FarSide(const FarSide&) = delete;
  FarSide& operator=(const FarSide&) = delete;

  [[nodiscard]] std::uint16_t port() const { return relay_.port(); }

  /// From each touch's result to the next touch, as the cable saw them; forgotten here.
  std::vector<double> take_answers_ms() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answers_ms_, {});
  }

 private:
  void watch(const cs8::Message& message) {
    if (std::holds_alternative<cs8::TouchResult>(message.payload)) {
      result_seen_ = Clock::now();
    } else if (std::holds_alternative<cs8::Touch>(message.payload) && result_seen_) {
      const std::lock_guard lock(mutex_);
      answers_ms_.push_back(Milliseconds(Clock::now() - *std::exchange(result_seen_, {})).count());
    } else if (std::holds_alternative<cs8::Travel>(message.payload)) {
      result_seen_.reset();
    }
  }

  boost::asio::io_context server_io_{1};
  boost::asio::io_context relay_io_{1};
  sim::Server server_;
  std::optional<Clock::time_point> result_seen_;
  std::mutex mutex_;
  std::vector<double> answers_ms_;
  Relay relay_;
  std::thread server_thread_;
  std::thread relay_thread_;
};

TEST(FiguresOfTheAnswer, EveryTouchIsFollowedByTheNextCommandAndTheTimeIsTold) {
  LoopbackCell loop("demo");
  FarSide far_side(loop);
  loop.launch(far_side.port());
  loop.run_until(cell::State::kIdle);
  std::vector<double> medians_ms, worst_percentiles_ms, bare_ms;
  for (int run = 0; run < kRunCount; ++run) {
    loop.start(kRecipe);
    loop.run_until_over();
    ASSERT_EQ(loop.status().state, cell::State::kComplete) << loop.fault_name();
    std::vector<double> answers_ms = far_side.take_answers_ms();
    const std::size_t again = loop.store().references(run + 1).size();
    ASSERT_EQ(answers_ms.size(), kTouchCount + again - 1);
    std::ranges::sort(answers_ms);
    medians_ms.push_back(answers_ms[answers_ms.size() / 2]);
    worst_percentiles_ms.push_back(high_percentile(answers_ms));
    bare_ms.push_back(bare_commit_ms(loop.store_file().parent_path()));
  }
  std::ranges::sort(medians_ms);
  std::ranges::sort(worst_percentiles_ms);
  std::ranges::sort(bare_ms);
  std::printf(
      "answer to a touch's result, %d runs of %d touches, stored in between: median %.2f ms, 99th percentile "
      "%.2f ms "
      "(the runs' median; best %.2f, worst %.2f ms); a bare commit on this disk up to %.2f ms\n",
      kRunCount, kTouchCount, medians_ms[kRunCount / 2], worst_percentiles_ms[kRunCount / 2],
      worst_percentiles_ms.front(), worst_percentiles_ms.back(), bare_ms.back());
  // Told, not tested: a shared machine and its disk are slower than this now and then.
  std::printf("99th percentile under %.0f ms: %s\n", kAnswerMaxMs,
              worst_percentiles_ms[kRunCount / 2] < kAnswerMaxMs ? "met" : "MISSED");
}

}  // namespace
}  // namespace touchcal::testing
