#include "tests/benchmark/measured_cell.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/end_to_end/environment.hpp"

namespace bench {
namespace {

using nlohmann::json;
using touchcal::testing::Environment;

constexpr int kPollMs = 5;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::uint16_t port_of(const std::string& address) {
  return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
}

/// A copy of the shipped configuration, changed as the options say; its cell file.
std::string copied_cell(const std::filesystem::path& folder, const MeasuredCellOptions& options) {
  std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config", folder / "config",
                        std::filesystem::copy_options::recursive);
  const std::filesystem::path here = folder / "config/cells" / options.cell;
  json cell = json::parse(text_of(here / "cell.json"));
  cell["deadlines"]["heartbeat_timeout_ms"] = options.heartbeat_timeout_ms;
  for (const json& recipe : options.recipes) {
    const std::string name = recipe.at("name").get<std::string>() + ".json";
    std::ofstream(folder / "config/recipes" / name) << recipe;
    cell["recipes"].push_back("../../recipes/" + name);
  }
  std::ofstream(here / "cell.json") << cell;
  if (!options.noise) {
    json truth = json::parse(text_of(here / "truth.json"));
    truth["schema"] = "touchcal/truth/2";
    truth["probe"]["noise_mm"] = 0.0;
    std::ofstream(here / "truth.json") << truth;
  }
  return (here / "cell.json").string();
}

/// A new file that is shared with the daemon.
touchcal::testing::FailingCallsBlock* shared_calls(const std::filesystem::path& file) {
  using Block = touchcal::testing::FailingCallsBlock;
  std::ofstream(file) << std::string(sizeof(Block), '\0');
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  void* const place = ::mmap(nullptr, sizeof(Block), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  ::close(descriptor);
  if (place == MAP_FAILED) throw std::runtime_error(file.string() + ": cannot be shared with the daemon");
  return static_cast<Block*>(place);
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

bool tell(const std::string& what, double value_ms, double limit_ms) {
  const bool met = value_ms <= limit_ms;
  std::printf("%s %.2f ms  (at most %.2f: %s)\n", what.c_str(), value_ms, limit_ms, met ? "met" : "MISSED");
  return met;
}

void pause_ms(int milliseconds) { ::poll(nullptr, 0, milliseconds); }

Wire::Wire(std::uint16_t controller_port)
    : relay_(io_, controller_port, [this](const cs8::Message& message) { watch(message); }),
      thread_([this] { io_.run(); }) {}

Wire::~Wire() {
  io_.stop();
  thread_.join();
}

void Wire::watch(const cs8::Message& message) {
  const SeenFrame frame{Clock::now(), message};
  if (std::holds_alternative<cs8::State>(message.payload) ||
      std::holds_alternative<cs8::Heartbeat>(message.payload))
    return;
  if (std::holds_alternative<cs8::Hello>(message.payload)) ++links_;
  const std::lock_guard lock(mutex_);
  if (std::holds_alternative<cs8::Stop>(message.payload)) {
    ++stops_;
    stopped_at_ = frame.at;
    return;
  }
  if (watch_) watch_(frame);
  frames_.push_back(frame);
}

std::vector<SeenFrame> Wire::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(frames_, {});
}

void Wire::on_frame(std::function<void(const SeenFrame&)> watch) {
  const std::lock_guard lock(mutex_);
  if (watch) std::ranges::for_each(frames_, watch);
  watch_ = std::move(watch);
}

std::pair<int, Clock::time_point> Wire::latest_stop() {
  const std::lock_guard lock(mutex_);
  return {stops_, stopped_at_};
}

MeasuredCell::MeasuredCell(MeasuredCellOptions options)
    : options_(std::move(options)), cell_file_(copied_cell(folder_.path(), options_)) {
  controller_.emplace(std::vector<std::string>{"cs8sim", "--cell", cell_file_, "--listen", "127.0.0.1:0",
                                               "--control", "127.0.0.1:0", "--speed", options_.speed},
                      folder_ / "cs8sim.err");
  const std::uint16_t port = port_of(controller_->wait_for_address());
  const std::string said = text_of(folder_ / "cs8sim.err");
  constexpr std::string_view kBefore = "control on 127.0.0.1:";
  control_port_ = port_of(said.substr(0, said.find('\n', said.find(kBefore))));
  wire_ = std::make_unique<Wire>(port);
  if (options_.calls_can_fail) calls_ = shared_calls(folder_ / "calls");
  start_daemon();
}

void MeasuredCell::start_daemon() {
  if (!try_to_start_daemon()) throw std::runtime_error("the daemon does not start:\n" + log());
}

bool MeasuredCell::try_to_start_daemon() {
  std::optional<Environment> preload, file;
  if (options_.can_stall) {
    preload.emplace("LD_PRELOAD", TOUCHCAL_STALLED_DISK);
    file.emplace("TOUCHCAL_STALL_FILE", (folder_ / "stall").string());
  }
  if (options_.calls_can_fail) {
    preload.emplace("LD_PRELOAD", TOUCHCAL_FAILING_CALLS);
    file.emplace("TOUCHCAL_FAILING_CALLS", (folder_ / "calls").string());
  }
  daemon_.reset();
  std::vector<std::string> call{"touchcald",
                                "--cell",
                                cell_file_,
                                "--listen",
                                "127.0.0.1:0",
                                "--controller",
                                "127.0.0.1:" + std::to_string(wire_->port()),
                                "--state",
                                state().string()};
  call.insert(call.end(), options_.daemon_options.begin(), options_.daemon_options.end());
  daemon_.emplace(call, folder_ / "touchcald.err", kDaemonPatience);
  const std::string said = daemon_->first_line();
  constexpr std::string_view kBefore = "listening on ";
  if (!said.starts_with(kBefore)) return false;
  address_ = port_of(said);
  return true;
}

void MeasuredCell::kill_daemon() {
  daemon_->signal(SIGKILL);
  daemon_->wait();
}

void MeasuredCell::end_daemon() {
  daemon_->signal(SIGTERM);
  daemon_->wait();
}

std::string MeasuredCell::authorization() const {
  std::string token = text_of(state() / "operate.token");
  while (!token.empty() && token.back() == '\n') token.pop_back();
  return "Authorization: Bearer " + token + "\r\n";
}

std::string MeasuredCell::log() const { return text_of(folder_ / "touchcald.err"); }

PlainAnswer MeasuredCell::get(const std::string& target) const {
  return ask(address_, request_text(address_, "GET", target));
}

PlainAnswer MeasuredCell::post(const std::string& target, const std::string& body) const {
  return ask(address_, request_text(address_, "POST", target, authorization(), body));
}

json MeasuredCell::command(const std::string& target, const std::string& body) const {
  const PlainAnswer answer = post(target, body);
  if (answer.status < 200 || answer.status > 299)
    throw std::runtime_error(target + ": " + std::to_string(answer.status) + ' ' + answer.body);
  return json::parse(answer.body);
}

json MeasuredCell::status() const {
  const PlainAnswer answer = get("/api/v1/status");
  if (answer.status != 200)
    throw std::runtime_error("no status: " + answer.body + '\n' + text_of(folder_ / "touchcald.err"));
  return json::parse(answer.body);
}

json MeasuredCell::wait_until(const std::function<bool(const json&)>& condition,
                              std::chrono::seconds patience) const {
  const auto deadline = Clock::now() + patience;
  for (json now = status();; now = status()) {
    if (condition(now)) return now;
    if (Clock::now() > deadline) throw std::runtime_error("waited in vain: " + now.dump());
    pause_ms(kPollMs);
  }
}

json MeasuredCell::wait_until_state(const std::string& state) const {
  return wait_until([&](const json& now) { return now.at("state") == state; });
}

void MeasuredCell::inject(const std::string& line) const {
  const int descriptor = connect_to(control_port_);
  if (descriptor < 0) throw std::runtime_error("the simulator's control connection is not there");
  send_all(descriptor, line + '\n');
  pollfd readable{descriptor, POLLIN, 0};
  std::string answer(4096, '\0');
  if (::poll(&readable, 1, kAnswerPatienceMs) > 0)
    answer.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(descriptor, answer.data(), 4096))));
  end_connection(descriptor);
  if (!answer.starts_with("{\"ok\":true")) throw std::runtime_error(line + ": " + answer);
}

void MeasuredCell::stall_disk() const { std::ofstream(folder_ / "stall") << '\n'; }

bool MeasuredCell::awaits_stall() const { return std::filesystem::exists(folder_ / "stall"); }

}  // namespace bench
