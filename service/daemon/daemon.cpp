#include "service/daemon/daemon.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/thread_pool.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/base/context.hpp"
#include "service/base/exit_code.hpp"
#include "service/base/known_directory.hpp"
#include "service/base/state_directory.hpp"
#include "service/daemon/archive_fleet.hpp"
#include "service/daemon/daily_care.hpp"
#include "service/daemon/end_watch.hpp"
#include "service/daemon/listen_address.hpp"
#include "service/daemon/plant_sinks.hpp"
#include "service/daemon/supervision.hpp"
#include "service/daemon/work_done.hpp"
#include "service/http/auth/tokens.hpp"
#include "service/http/routes/api.hpp"
#include "service/http/server/listener.hpp"
#include "service/http/server/local_listener.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/outbox.hpp"
#include "service/store/run_store.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// Lock of a state directory: two daemons would record the same touches twice.
class DirectoryLock {
 public:
  explicit DirectoryLock(const std::filesystem::path& directory)
      : descriptor_(::open((directory / kLockFile).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0)
      throw std::runtime_error(directory.string() + ": cannot be written; give another --state");
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      ::close(descriptor_);
      throw std::runtime_error(
          directory.string() +
          ": another touchcald uses this state directory; stop it or give another --state");
    }
  }
  ~DirectoryLock() { ::close(descriptor_); }
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

/// The count of this start. Where the disk does not take it, that of the start before.
std::int64_t count_start(const RunStore& store) {
  try {
    return Outbox(store.database()).begin_instance();
  } catch (const std::exception& error) {
    spdlog::warn("this start could not be counted: {}", error.what());
    return OutboxReader(store.file()).instance();
  }
}

/// Planning needs tens of MB for a second, identification some hundred kB for a millisecond. By default glibc
/// retains them, per thread; with these limits large blocks return to the system when freed.
void limit_allocator() {
  constexpr int kLargePieceBytes = 128 * 1024;
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, kLargePieceBytes);
  mallopt(M_TRIM_THRESHOLD, kLargePieceBytes);
}

/// A log whose reader has ended, or a file at its largest size, is a failed write and not the end of a run.
void ignore_write_signals() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

/// Opens the socket in the state directory. Without one (its path may be too long) the address serves alone.
void open_socket(std::optional<LocalListener>& socket, asio::io_context& context, Api& api,
                 const DaemonOptions& options) {
  const std::filesystem::path file = options.state_directory / kSocketFile;
  try {
    socket.emplace(context.get_executor(), file, api, HttpLimits{});
  } catch (const boost::system::system_error& error) {
    spdlog::warn("{}: there is no Unix socket: {}", file.string(), error.code().message());
  }
}

/// How often the tokens are read again: one that was removed ends so soon.
constexpr std::chrono::milliseconds kTokensLook{1000};

/// How old the metrics of checks and models may be: ten years of daily checks are read in a second.
constexpr std::chrono::milliseconds kCellLook{300'000};

/// How long the end of a flood of refusals may be missing in the audit.
constexpr std::chrono::milliseconds kStrangersLook{10'000};

/// How soon who may sign in is written once the disk takes it again.
constexpr std::chrono::milliseconds kUsersLook{5000};

/// How long the end waits for the disk and for a computation.
constexpr std::chrono::milliseconds kWorkPatience{10'000};

/// Nothing is destroyed: the other threads may still use it. What the disk has not taken is as after a power
/// cut, and an answer that is not stored stays at the controller, which is asked again.
EndWatch::GiveUp end_without_work(const Run* run, std::shared_ptr<const std::atomic<int>> waiting_count) {
  const std::string of_run = run ? fmt::format(", of run {} with {} of {} touches", run->id(),
                                               run->touches_done(), run->touches_total())
                                 : "";
  return [of_run, waiting_count = std::move(waiting_count)](const std::string& why) {
    spdlog::error(
        "{}: the daemon ends without it. Still to be written: {} writes of the acquisition{}, and what "
        "was to be recorded of requests since. The controller keeps a touch that is not stored",
        why, waiting_count->load(), of_run);
    spdlog::shutdown();
    std::_Exit(kExitFailed);
  };
}

/// At its end what still waits in the two contexts is destroyed, in the order in which it refers to the
/// other: all that it refers to is there yet.
class NothingWaits {
 public:
  NothingWaits(Context& operation, Context& http, Api& api) : operation_(operation), http_(http), api_(api) {}
  ~NothingWaits() {
    api_.end_desks();  // they post to the contexts
    operation_.give_up();
    http_.give_up();
  }
  NothingWaits(const NothingWaits&) = delete;
  NothingWaits& operator=(const NothingWaits&) = delete;

 private:
  Context& operation_;
  Context& http_;
  Api& api_;
};

/// At its end nothing is served any more: what was left out of the audit since the last look is written.
class LastRefusals {
 public:
  explicit LastRefusals(Api& api) : api_(api) {}
  ~LastRefusals() { api_.record_left_out(); }
  LastRefusals(const LastRefusals&) = delete;
  LastRefusals& operator=(const LastRefusals&) = delete;

 private:
  Api& api_;
};

/// The thread that serves, until its end. What nobody foresaw there ends a connection and no run; memory that
/// runs out between an event and who waits for it may have lost who accepts: `accept_again` then.
class HttpThread {
 public:
  HttpThread(asio::io_context& context, std::function<void()> accept_again)
      : context_(context), accept_again_(std::move(accept_again)), thread_([this] { serve(); }) {}
  ~HttpThread() {
    context_.stop();
    thread_.join();
  }
  HttpThread(const HttpThread&) = delete;
  HttpThread& operator=(const HttpThread&) = delete;

 private:
  void serve() {
    while (!context_.stopped()) {
      try {
        if (std::exchange(has_failed_, false)) accept_again_();
        context_.run();
      } catch (const std::exception& error) {
        has_failed_ = true;
        spdlog::error("while serving: {}", error.what());
      }
    }
  }

  asio::io_context& context_;
  std::function<void()> accept_again_;
  bool has_failed_ = false;  // of the thread
  std::thread thread_;
};

}  // namespace

void run_daemon(const Cell& cell, const DaemonOptions& options) {
  limit_allocator();
  ignore_write_signals();
  if (std::filesystem::create_directories(options.state_directory)) {
    std::filesystem::permissions(options.state_directory, std::filesystem::perms::owner_all);
  }
  demand_closed_directory(options.state_directory);
  demand_own_directory(options.state_directory);
  const KnownDirectory state_directory(options.state_directory);
  EndWatch end_watch;  // to the very end, which closes the store
  const DirectoryLock lock(options.state_directory);
  refuse_lost_store(options.state_directory);
  const Clocks clocks{std::chrono::system_clock::now, std::chrono::steady_clock::now};
  RunStore store(options.state_directory / kStoreFile, {.sleep = {}, .now = clocks.steady});
  mark_begun(options.state_directory);
  const std::int64_t instance = count_start(store);
  const Tokens tokens = load_or_make_tokens(options.state_directory);

  // Requests on their way to the operation wait in its context, with sockets of the other: it goes first.
  Context http(1);
  Context context(1);
  asio::thread_pool disk(1);
  asio::thread_pool arithmetic(1);
  asio::thread_pool planner(1);
  const StoreQueue store_queue(store, disk.get_executor());
  CellOperation operation({.operation = context.get_executor(),
                           .computation = arithmetic.get_executor(),
                           .planning = planner.get_executor()},
                          cell, store_queue, options.controller.value_or(cell.controller), random_hex(8),
                          clocks);
  operation.keep_place_in(options.state_directory / kBlockPoseFile);
  asio::co_spawn(
      context,
      care_daily(store, cell, {.retain_days = options.retain_days, .sinks = configured_sinks(options)},
                 disk.get_executor(), clocks),
      asio::detached);
  Api api(http.get_executor(), {.operation = context.get_executor(), .store = disk.get_executor()}, operation,
          tokens);
  std::optional<HttpListener> listener;
  const auto tls = tls_context(options);
  try {
    listener.emplace(http.get_executor(), listen_address(http, options), api,
                     HttpLimits{.host_names = options.host_names, .trusts_loopback = options.trusts_loopback},
                     tls);
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(fmt::format("cannot listen on {}: {}; give another address with --listen",
                                         endpoint_text(options.listen), error.code().message()));
  }
  std::optional<LocalListener> socket;
  open_socket(socket, http, api, options);
  Supervision supervision(context.get_executor());
  std::chrono::milliseconds patience = kWorkPatience;
  asio::signal_set signals(context, SIGINT, SIGTERM, SIGHUP);
  signals.async_wait([&](const boost::system::error_code& failure, int signal) {
    if (failure) return;
    spdlog::info("signal {}: stopping", signal);
    supervision.notify_stopping();
    // A stop is taken until the arm has been drawn back: the listeners close with the end.
    asio::co_spawn(context, operation.shut_down(), [&](const std::exception_ptr&) { context.stop(); });
    signals.async_wait([&](const boost::system::error_code&, int) {  // a second signal: at once
      patience = EndWatch::kHurriedPatience;
      context.stop();
    });
  });
  operation.launch();
  asio::co_spawn(http, api.follow_tokens(state_directory, kTokensLook), asio::detached);
  asio::co_spawn(http, api.follow_cell(kCellLook), asio::detached);
  asio::co_spawn(http, api.follow_strangers(kStrangersLook), asio::detached);
  asio::co_spawn(http, api.follow_users(kUsersLook), asio::detached);
  listener->launch();
  if (socket) socket->launch();
  spdlog::info("cell {}, state in {}", cell.name, options.state_directory.string());
  const std::string address = endpoint_text({options.listen.host, listener->address().port()});
  fmt::print("listening on {}\n", address);
  std::fflush(stdout);
  supervision.notify_ready(fmt::format("cell {} at {}", cell.name, address));
  const NothingWaits nothing_waits(context, http, api);
  const WorkDone done({&disk, &arithmetic, &planner}, end_watch, patience,
                      [&] { return end_without_work(operation.run(), store_queue.waiting_count()); });
  PlantSinks plant(store, disk.get_executor());
  if (!configured_sinks(options).empty()) api.services().feed.tell_sinks(plant.states(), plant.status());
  plant.begin(options, cell.name, instance, clocks);
  api.services().fleet = archive_fleet(options, clocks);
  const LastRefusals last_refusals(api);
  const HttpThread http_thread(http, [&] {
    listener->launch();
    if (socket) socket->launch();
  });
  context.run();
}

}  // namespace cell
