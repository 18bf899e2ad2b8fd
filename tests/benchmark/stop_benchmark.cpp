// STOP from a new connection to its bytes on the controller's wire, over TCP and over the daemon's Unix
// socket, while the daemon is idle, polled, crowded, makes reports, plans and waits for its disk. Beside
// each, in the same time, how late this machine wakes an idle thread.
//   stop_benchmark [COUNT [SECONDS [LOAD]...]]      10000 of each; SECONDS at most for each load and way
//   (300)
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cstdio>
#include <stdexcept>

#include "tests/benchmark/measured_cell.hpp"

namespace bench {
namespace {

constexpr double kStopMaxMs = 20.0;
constexpr double kWakeUps = 2.0;  // or so many idle wake-ups
constexpr int kPollers = 100;
constexpr int kPollEveryMs = 100;
constexpr int kSlowClients = 1'000;
constexpr int kSlowByteEveryMs = 1'000;
constexpr int kLongPlans = 8;
constexpr int kWarmUp = 20;

/// Work that goes on beside the stops, on a thread of its own, until it is told to end.
class Beside {
 public:
  explicit Beside(std::function<void(const std::atomic<bool>& ends)> work)
      : thread_([this, work = std::move(work)] { work(ends_); }) {}
  ~Beside() {
    ends_ = true;
    thread_.join();
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

 private:
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// How much later than asked for a thread goes on that has nothing to do.
void measure_wake_ups(std::vector<double>& late_ms, const std::atomic<bool>& ends) {
  constexpr timespec kPeriod{.tv_sec = 0, .tv_nsec = 2'000'000};
  while (!ends) {
    const auto begin = Clock::now();
    ::ppoll(nullptr, 0, &kPeriod, nullptr);
    late_ms.push_back(milliseconds(Clock::now() - begin) - 2.0);
  }
}

/// Clients that ask for the status every 100 ms on connections that stay.
void poll_status(const DaemonAddress& daemon, const std::atomic<bool>& ends) {
  const std::string request = request_text(daemon, "GET", "/api/v1/status");
  std::vector<int> clients(kPollers, -1);
  for (int turn = 0; !ends; turn = (turn + 1) % kPollers) {
    int& client = clients[static_cast<std::size_t>(turn)];
    std::array<char, 16'384> answer{};
    const bool open = client >= 0 && ::recv(client, answer.data(), answer.size(), MSG_DONTWAIT) > 0;
    if (!open && client >= 0) end_connection(client);
    if (!open) client = connect_to(daemon);
    if (client >= 0) send_all(client, request);
    pause_ms(kPollEveryMs / kPollers);
  }
  for (const int client : clients) end_connection(client);
}

/// Clients that send a request byte by byte, one a second, and come again when they were sent away.
void crawl(const DaemonAddress& daemon, const std::atomic<bool>& ends) {
  const std::string request =
      request_text(daemon, "GET", "/api/v1/status", "X-Slow: " + std::string(200, 'x') + "\r\n");
  struct Client {
    int descriptor = -1;
    std::size_t sent = 0;
  };
  std::vector<Client> clients(kSlowClients);
  while (!ends) {
    for (std::size_t i = 0; i < clients.size() && !ends; ++i) {
      Client& client = clients[i];
      char byte = 0;
      const bool gone = client.descriptor >= 0 && ::recv(client.descriptor, &byte, 1, MSG_DONTWAIT) >= 0;
      if (gone || (client.descriptor >= 0 && !send_all(client.descriptor, request.substr(client.sent, 1)))) {
        end_connection(client.descriptor);
        client.descriptor = -1;
      }
      if (client.descriptor < 0) client = {connect_to(daemon), 0};
      client.sent = (client.sent + 1) % (request.size() - 4);  // never a whole one
      if (i % 10 == 0) pause_ms(kSlowByteEveryMs / (kSlowClients / 10));
    }
  }
  for (const Client& client : clients)
    if (client.descriptor >= 0) end_connection(client.descriptor);
}

void make_reports(const DaemonAddress& daemon, const std::atomic<bool>& ends) {
  while (!ends) {
    if (ask(daemon, request_text(daemon, "GET", "/api/v1/runs/1/report?format=html")).status != 200)
      pause_ms(10);
  }
}

/// Plans of a thousand touches, each of which takes longer than the stops.
void plan(const MeasuredCell& cell, const std::atomic<bool>& ends) {
  std::vector<int> asked;
  for (int i = 0; i < kLongPlans && !ends; ++i) {
    const std::string body = "{\"recipe\":\"long-" + std::to_string(i) + "\"}";
    const int descriptor = connect_to(cell.address());
    send_all(descriptor, request_text(cell.address(), "POST", "/api/v1/plan", cell.authorization(), body));
    pollfd answered{descriptor, POLLIN, 0};
    while (!ends && ::poll(&answered, 1, 100) == 0) {
    }
    end_connection(descriptor);
  }
}

/// Nearly all that the daemon puts on its disk takes a second, and a command that it has to record waits for
/// it all the time.
void stall(const MeasuredCell& cell, const std::atomic<bool>& ends) {
  const Beside commands([&](const std::atomic<bool>& over) {
    while (!over && !ends) {
      if (cell.post("/api/v1/cell/acknowledge").status != 202) pause_ms(10);
    }
  });
  while (!ends) {
    if (!cell.awaits_stall()) cell.stall_disk();
    pause_ms(2);
  }
}

/// One STOP on a connection of its own: milliseconds until its frame came out of the cable; nothing when the
/// daemon did not take it.
std::optional<double> stop_ms(MeasuredCell& cell, const DaemonAddress& way, const std::string& request) {
  const int before = cell.wire().latest_stop().first;
  const auto begin = Clock::now();
  const PlainAnswer answer = ask(way, request);
  if (answer.status != 202) return std::nullopt;
  for (;;) {
    const auto [count, at] = cell.wire().latest_stop();
    if (count > before) return milliseconds(at - begin);
    if (milliseconds(Clock::now() - begin) > kAnswerPatienceMs) return std::nullopt;
    pause_ms(1);
  }
}

struct Load {
  std::string name;
  std::function<void(const std::atomic<bool>& ends)> work;
};

struct Row {
  std::vector<double> stops_ms, late_ms;
  int refused = 0;
};

Row measure(MeasuredCell& cell, const DaemonAddress& way, const Load& load, int count, double seconds) {
  const std::string request = request_text(way, "POST", "/api/v1/cell/stop", cell.authorization());
  Row row;
  const Beside beside([&](const std::atomic<bool>& ends) {
    if (load.work) load.work(ends);
  });
  const Beside wake_ups([&](const std::atomic<bool>& ends) { measure_wake_ups(row.late_ms, ends); });
  pause_ms(load.work ? 1'000 : 0);  // until the load is there
  const auto begin = Clock::now();
  for (int i = -kWarmUp; i < count && milliseconds(Clock::now() - begin) < 1e3 * seconds; ++i) {
    const auto ms = stop_ms(cell, way, request);
    if (!ms) {
      ++row.refused;
    } else if (i >= 0) {
      row.stops_ms.push_back(*ms);
    }
  }
  return row;
}

bool print(const Load& load, const char* way, const Row& row) {
  const double wake_up_ms = percentile(row.late_ms, 0.999);
  const double limit_ms = std::max(kStopMaxMs, kWakeUps * wake_up_ms);
  const double slowest_ms = percentile(row.stops_ms, 0.999);
  const bool met = !row.stops_ms.empty() && row.refused == 0 && slowest_ms <= limit_ms;
  std::printf("%-20s %-5s %6zu %8d %9.2f %9.2f %9.2f %9.2f %9.2f   %6.2f  %s\n", load.name.c_str(), way,
              row.stops_ms.size(), row.refused, percentile(row.stops_ms, 0.5), percentile(row.stops_ms, 0.99),
              slowest_ms, percentile(row.stops_ms, 1.0), wake_up_ms, limit_ms, met ? "met" : "MISSED");
  std::fflush(stdout);
  return met;
}

nlohmann::json recipes() {
  auto found = nlohmann::json::array();
  const auto recipe = [](const std::string& name, int fit, int held_out) {
    return nlohmann::json{{"schema", "touchcal/recipe/2"},
                          {"name", name},
                          {"description", "for a measurement"},
                          {"touches", {{"planes", "all"}, {"fit", fit}, {"held_out_per_plane", held_out}}},
                          {"identification", {{"stiffness", "off"}, {"harmonics", "off"}}}};
  };
  found.push_back(recipe("short", 28, 1));
  for (int i = 0; i < kLongPlans; ++i) found.push_back(recipe("long-" + std::to_string(i), 1'000, 1));
  return found;
}

bool measure_all(int count, double seconds, const std::vector<std::string>& wanted) {
  MeasuredCell cell({.heartbeat_timeout_ms = 2'000, .can_stall = true, .recipes = recipes()});
  cell.wait_until_state("IDLE");
  cell.command("/api/v1/runs", R"({"recipe":"short"})");
  cell.wait_until_state("COMPLETE");
  const std::vector<Load> loads{
      {"idle", {}},
      {"100 pollers", [&](const auto& ends) { poll_status(cell.address(), ends); }},
      {"1000 slow clients", [&](const auto& ends) { crawl(cell.address(), ends); }},
      {"a report being made", [&](const auto& ends) { make_reports(cell.address(), ends); }},
      {"planning", [&](const auto& ends) { plan(cell, ends); }},
      {"stalled disk", [&](const auto& ends) { stall(cell, ends); }}};
  std::printf("%-20s %-5s %6s %8s %9s %9s %9s %9s %9s   %6s\n", "STOP to the wire, ms", "way", "stops",
              "refused", "p50", "p99", "p99.9", "longest", "wake-up", "limit");
  bool met = true;
  for (const Load& load : loads) {
    if (!wanted.empty() && std::ranges::find(wanted, load.name) == wanted.end()) continue;
    met = print(load, "tcp", measure(cell, cell.address(), load, count, seconds)) && met;
    met = print(load, "unix", measure(cell, cell.state() / "touchcald.sock", load, count, seconds)) && met;
  }
  std::printf("wake-up: how late an idle thread goes on, p99.9; limit: %.0f ms or %.0f wake-ups\n",
              kStopMaxMs, kWakeUps);
  return met;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::stoi(argv[1]) : 10'000;
  const double seconds = argc > 2 ? std::stod(argv[2]) : 300.0;
  try {
    return bench::measure_all(count, seconds, {argv + std::min(argc, 3), argv + argc}) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stop_benchmark: %s\n", error.what());
    return 2;
  }
}
