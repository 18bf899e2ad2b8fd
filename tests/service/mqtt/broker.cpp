#include "tests/service/mqtt/broker.hpp"

#include <fcntl.h>
#include <mosquitto.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace cell {
namespace {

constexpr std::chrono::seconds kBrokerPatience{30};

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

void replace_in(std::string& text, const std::string& before, const std::string& now) {
  std::size_t at = text.find(before);
  if (at == std::string::npos) throw std::runtime_error("the shipped configuration has no " + before);
  for (; at != std::string::npos; at = text.find(before, at + now.size()))
    text.replace(at, before.size(), now);
}

std::uint16_t free_port() {
  boost::asio::io_context context;
  return boost::asio::ip::tcp::acceptor(context, {boost::asio::ip::address_v4::loopback(), 0})
      .local_endpoint()
      .port();
}

}  // namespace

Broker::Broker(std::filesystem::path folder, const std::optional<std::string>& access, bool keeps)
    : folder_(std::move(folder)), port_(free_port()) {
  const std::filesystem::path shipped = std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "service/package/plant";
  std::ofstream(folder_ / "mosquitto.acl") << access.value_or(text_of_file(shipped / "mosquitto.acl"));
  std::string text = text_of_file(shipped / "mosquitto.conf");
  replace_in(text, "listener 8883", "listener " + std::to_string(port_) + " 127.0.0.1");
  replace_in(text, "/etc/mosquitto/touchcal", folder_.string());
  replace_in(
      text, "persistence true",
      keeps ? "persistence true\npersistence_location " + folder_.string() + "/" : "persistence false");
  std::ofstream(folder_ / "mosquitto.conf") << text << "user root\nlog_dest stderr\n";
  start();
}

void Broker::start() {
  std::array<int, 2> log{};
  if (::pipe2(log.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  const std::string file = (folder_ / "mosquitto.conf").string();
  const char* path = ::access("/usr/sbin/mosquitto", X_OK) == 0 ? "/usr/sbin/mosquitto" : "mosquitto";
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves none
    ::dup2(log[1], STDERR_FILENO);
    ::execlp(path, "mosquitto", "-c", file.c_str(), nullptr);
    ::_exit(127);
  }
  pid_ = pid;
  ::close(log[1]);
  std::string said;
  char byte = 0;
  while (said.find(" running") == std::string::npos && ::read(log[0], &byte, 1) == 1) said += byte;
  if (said.find(" running") == std::string::npos) throw std::runtime_error("no broker: " + said);
  // Nobody reads on: what it says from here on goes nowhere, and its log is not worth its life.
  ::close(log[0]);
}

void Broker::kill() {
  // Known as gone before it is: whoever misses it may start it again at once.
  const pid_t pid = pid_.exchange(-1);
  if (pid < 0) return;
  ::kill(pid, SIGKILL);
  ::waitpid(pid, nullptr, 0);
}

void Broker::hang() const { ::kill(pid_, SIGSTOP); }

void Broker::save() const {
  const std::filesystem::path kept = folder_ / "mosquitto.db";
  std::filesystem::remove(kept);
  ::kill(pid_, SIGUSR1);
  const auto end = std::chrono::steady_clock::now() + kBrokerPatience;
  while (!std::filesystem::exists(kept)) {
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error("the broker keeps nothing");
    ::poll(nullptr, 0, 5);
  }
}

MqttOptions Broker::options_of(const std::string& name) const {
  return {.host = "127.0.0.1",
          .port = port_,
          .tls = true,
          .authority = folder_ / "ca.crt",
          .certificate = folder_ / (name + ".crt"),
          .key = folder_ / (name + ".key")};
}

Subscriber::Subscriber(const MqttOptions& options, const char* client_id)
    : client_(nullptr, mosquitto_destroy) {
  mosquitto_lib_init();
  client_.reset(mosquitto_new(client_id, true, this));
  mosquitto_tls_set(client_.get(), options.authority.c_str(), nullptr, options.certificate.c_str(),
                    options.key.c_str(), nullptr);
  mosquitto_connect_callback_set(client_.get(), [](mosquitto* client, void*, int) {
    mosquitto_subscribe(client, nullptr, "touchcal/v1/#", 1);
  });
  mosquitto_subscribe_callback_set(client_.get(), [](mosquitto*, void* self, int, int, const int*) {
    static_cast<Subscriber*>(self)->is_subscribed_ = true;
  });
  mosquitto_message_callback_set(client_.get(), [](mosquitto*, void* self, const mosquitto_message* message) {
    static_cast<Subscriber*>(self)->messages_.push_back(
        {message->topic,
         std::string(static_cast<const char*>(message->payload),
                     static_cast<std::size_t>(message->payloadlen)),
         message->retain});
  });
  mosquitto_connect(client_.get(), options.host.c_str(), options.port, 60);
  const auto end = std::chrono::steady_clock::now() + kBrokerPatience;
  while (!is_subscribed_) {
    const int result = mosquitto_loop(client_.get(), 100, 1);
    if (result != MOSQ_ERR_SUCCESS) throw std::runtime_error(mosquitto_strerror(result));
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error("no subscription");
  }
}

Subscriber::~Subscriber() = default;

const std::vector<Message>& Subscriber::wait_for(std::size_t count) {
  const auto end = std::chrono::steady_clock::now() + kBrokerPatience;
  while (messages_.size() < count && std::chrono::steady_clock::now() < end)
    if (mosquitto_loop(client_.get(), 100, 1) != MOSQ_ERR_SUCCESS) break;
  return messages_;
}

}  // namespace cell
