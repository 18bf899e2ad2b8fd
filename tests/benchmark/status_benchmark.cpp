// What GET /api/v1/status costs, beside a plain Beast server that gives the same answer, in the same run: one
// thread each, 8 connections. With an argument HOST:PORT it polls a running daemon instead, with 100 clients
// at 10 Hz, and tells the slowest hundredth of the answers.
#include <poll.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "config/endpoint.hpp"
#include "service/documents/json_view.hpp"
#include "service/http/routes/api.hpp"
#include "service/http/server/listener.hpp"
#include "tests/service/quiet_cell.hpp"

namespace bench {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr double kRatioMin = 0.65;
constexpr double kSlowestMaxMs = 10.0;
constexpr int kRounds = 5;
constexpr int kConnections = 8;
constexpr int kPollers = 100;
constexpr auto kPollPeriod = 100ms;
constexpr auto kRoundTime = 1s;
constexpr auto kPollTime = 10s;

/// Beast's own example of a server, with the headers that an answer of ours has.
asio::awaitable<void> serve_plainly(tcp::socket socket, std::string body, std::string tag) {
  socket.set_option(tcp::no_delay(true));
  beast::tcp_stream stream(std::move(socket));
  beast::flat_buffer buffer;
  try {
    while (true) {
      stream.expires_after(30s);
      http::request<http::string_body> request;
      co_await http::async_read(stream, buffer, request, asio::use_awaitable);
      const bool known = request[http::field::if_none_match] == tag;
      http::response<http::string_body> response(known ? http::status::not_modified : http::status::ok,
                                                 request.version());
      response.set(http::field::server, "touchcald");
      response.set(http::field::cache_control, "no-store");
      response.set("X-Content-Type-Options", "nosniff");
      response.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
      response.set("Referrer-Policy", "no-referrer");
      response.set(http::field::etag, tag);
      response.keep_alive(request.keep_alive());
      if (!known) {
        response.set(http::field::content_type, "application/json");
        response.body() = body;
        response.prepare_payload();
      }
      co_await http::async_write(stream, response, asio::use_awaitable);
    }
  } catch (const boost::system::system_error&) {
    // the client went away
  }
}

asio::awaitable<void> accept_plainly(tcp::acceptor& acceptor, std::string body, std::string tag) {
  while (true) {
    tcp::socket socket = co_await acceptor.async_accept(asio::use_awaitable);
    asio::co_spawn(acceptor.get_executor(), serve_plainly(std::move(socket), body, tag), asio::detached);
  }
}

/// A connection that asks for the same again and again.
class Asker {
 public:
  Asker(asio::io_context& context, const tcp::endpoint& server, const std::string& lines)
      : socket_(context),
        request_("GET /api/v1/status HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port()) + "\r\n" +
                 lines + "\r\n") {
    socket_.connect(server);
    socket_.set_option(tcp::no_delay(true));
  }
  [[nodiscard]] int descriptor() { return socket_.native_handle(); }
  void ask() {
    asked_ = Clock::now();
    asio::write(socket_, asio::buffer(request_));
  }
  /// Takes what has come; true when the answer is whole.
  bool hear() {
    char bytes[8192];
    answer_.append(bytes, socket_.read_some(asio::buffer(bytes)));
    const std::size_t end = answer_.find("\r\n\r\n");
    if (end == answer_.npos) return false;
    const std::size_t length = answer_.find("Content-Length: ");
    const std::size_t size = length < end ? std::stoul(answer_.substr(length + 16, 8)) : 0;
    if (answer_.size() < end + 4 + size) return false;
    if (answer_[9] != '2' && answer_.compare(9, 3, "304") != 0) throw std::runtime_error(answer_);
    answer_.clear();
    return true;
  }
  [[nodiscard]] Clock::time_point asked() const { return asked_; }

 private:
  tcp::socket socket_;
  std::string request_;
  std::string answer_;
  Clock::time_point asked_;
};

/// Answers a second, each connection asking again as soon as it is answered.
double rate(const tcp::endpoint& server, const std::string& lines) {
  asio::io_context context;
  std::vector<Asker> askers;
  for (int i = 0; i < kConnections; ++i) askers.emplace_back(context, server, lines);
  std::vector<pollfd> polled;
  for (Asker& asker : askers) polled.push_back({asker.descriptor(), POLLIN, 0});
  const auto begin = Clock::now();
  for (Asker& asker : askers) asker.ask();
  int answers = 0;
  while (Clock::now() < begin + kRoundTime) {
    if (::poll(polled.data(), polled.size(), 1000) <= 0) throw std::runtime_error("no answer");
    for (std::size_t i = 0; i < polled.size(); ++i) {
      if ((polled[i].revents & POLLIN) == 0 || !askers[i].hear()) continue;
      ++answers;
      askers[i].ask();
    }
  }
  return answers / std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The time that 99 of 100 answers stay under, in ms, with kPollers clients that ask every kPollPeriod.
double slowest_hundredth_ms(const tcp::endpoint& server) {
  asio::io_context context;
  std::vector<Asker> askers;
  for (int i = 0; i < kPollers; ++i) askers.emplace_back(context, server, "");
  std::vector<pollfd> polled;
  for (Asker& asker : askers) polled.push_back({asker.descriptor(), POLLIN, 0});
  const auto begin = Clock::now();
  std::vector<Clock::time_point> due;
  for (int i = 0; i < kPollers; ++i) due.push_back(begin + i * kPollPeriod / kPollers);
  std::vector<double> times_ms;
  while (Clock::now() < begin + kPollTime) {
    const auto next = *std::ranges::min_element(due);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now()).count();
    ::poll(polled.data(), polled.size(), static_cast<int>(std::max<std::int64_t>(0, left)));
    for (std::size_t i = 0; i < polled.size(); ++i) {
      if ((polled[i].revents & POLLIN) != 0 && askers[i].hear())
        times_ms.push_back(1e3 * std::chrono::duration<double>(Clock::now() - askers[i].asked()).count());
      if (Clock::now() < due[i]) continue;
      askers[i].ask();
      due[i] += kPollPeriod;
    }
  }
  std::ranges::sort(times_ms);
  return times_ms.at(times_ms.size() * 99 / 100);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.at(values.size() / 2);
}

int beside_plain_beast() {
  cell::QuietCell cell;
  cell::Api api(cell.context().get_executor(), cell.operation(),
                {std::string(64, 'a'), std::string(64, 'b')});
  cell::HttpListener ours(cell.context().get_executor(), {asio::ip::address_v4::loopback(), 0}, api);
  ours.launch();
  const std::string body = cell::status_document(cell.operation().status());
  const std::string tag = api.services().feed.etag();
  asio::io_context context(1);
  tcp::acceptor plain(context, {asio::ip::address_v4::loopback(), 0});
  asio::co_spawn(context, accept_plainly(plain, body, tag), asio::detached);
  std::thread our_thread([&] { cell.context().run(); });
  std::thread plain_thread([&] { context.run(); });
  bool met = true;
  for (const auto& [what, lines] :
       {std::pair{"fresh", std::string()}, std::pair{"not modified", "If-None-Match: " + tag + "\r\n"}}) {
    std::vector<double> ratios;
    double our_rate = 0.0;
    double plain_rate = 0.0;
    for (int round = 0; round < kRounds; ++round) {
      our_rate = rate(ours.address(), lines);
      plain_rate = rate(plain.local_endpoint(), lines);
      ratios.push_back(our_rate / plain_rate);
    }
    const double ratio = median(ratios);
    met = met && ratio >= kRatioMin;
    std::printf("status, %-12s %7.0f/s, plain Beast %7.0f/s, ratio %.2f, median of %d  (at least %.2f: %s)\n",
                what, our_rate, plain_rate, ratio, kRounds, kRatioMin, ratio >= kRatioMin ? "met" : "MISSED");
  }
  cell.context().stop();
  context.stop();
  our_thread.join();
  plain_thread.join();
  return met ? 0 : 1;
}

int poll_daemon(const cell::Endpoint& daemon) {
  const tcp::endpoint server(asio::ip::make_address(daemon.host), daemon.port);
  std::vector<double> slowest_ms;
  for (int round = 0; round < kRounds; ++round) {
    slowest_ms.push_back(slowest_hundredth_ms(server));
    std::printf("p99 %.2f ms\n", slowest_ms.back());
  }
  const double found = median(slowest_ms);
  std::printf("status, %d clients at 10 Hz: p99 %.2f ms, median of %d  (under %g ms: %s)\n", kPollers, found,
              kRounds, kSlowestMaxMs, found < kSlowestMaxMs ? "met" : "MISSED");
  return found < kSlowestMaxMs ? 0 : 1;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  if (argc == 1) return bench::beside_plain_beast();
  const auto daemon = cell::parse_endpoint(argv[1]);
  if (daemon) return bench::poll_daemon(*daemon);
  std::fprintf(stderr, "usage: status_benchmark [HOST:PORT of a running daemon]\n");
  return 2;
}
