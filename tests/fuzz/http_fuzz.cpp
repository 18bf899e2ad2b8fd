#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>

#include "service/http/server/body_budget.hpp"
#include "service/http/server/problem.hpp"
#include "service/http/server/request_handler.hpp"
#include "service/http/server/session.hpp"

namespace {

namespace asio = boost::asio;
using local = asio::local::stream_protocol;

constexpr std::uint64_t kBodyMax = 4096;
/// What a socket takes at once: nobody reads while it is written.
constexpr std::size_t kBytesMax = 32 * 1024;

/// Takes whatever the session lets through, and looks that it is bounded.
class Taker : public cell::RequestHandler {
 public:
  asio::awaitable<cell::HttpResponse> answer(const cell::HttpRequest& request) override {
    if (request.method.empty() || request.path.empty() || request.path[0] != '/' ||
        request.body.size() > kBodyMax)
      std::abort();
    co_return cell::HttpResponse{.body = "{}"};
  }
  cell::HttpResponse refuse(const cell::Problem& problem, const cell::HttpRequest& request) override {
    (void)request;
    if (problem.detail.empty() || problem.status < 400) std::abort();
    return cell::to_response(problem);
  }
  std::unique_ptr<cell::EventSource> events(const cell::HttpRequest& request) override {
    (void)request;
    std::abort();  // no answer was a stream
  }
  [[nodiscard]] cell::HeaderDecision decide(const cell::HttpRequest& header) const override {
    return {.takes_body = header.method == "POST", .body_bytes_max = kBodyMax};
  }
  [[nodiscard]] bool ignores_query(std::string_view method, std::string_view path) const override {
    return method == "POST" && path == "/stop";
  }
};

std::string received(local::socket& client) {
  std::string bytes;
  boost::system::error_code end;
  asio::read(client, asio::dynamic_buffer(bytes), end);
  return bytes;
}

}  // namespace

/// Arbitrary bytes on a connection that then ends: each answer is one of HTTP, and nothing waits for more.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kBytesMax) return 0;
  asio::io_context context(1);
  local::socket client(context), served(context);
  asio::local::connect_pair(client, served);
  Taker taker;
  const auto bodies = std::make_shared<cell::BodyBudget>(2 * kBodyMax);
  asio::co_spawn(
      context,
      cell::serve_local_session(std::move(served), taker, {}, bodies, std::make_shared<cell::Connection>()),
      [](const std::exception_ptr& thrown) {
        try {
          if (thrown) std::rethrow_exception(thrown);
        } catch (const boost::system::system_error&) {  // the client went
        }
      });
  asio::write(client, asio::buffer(data, size));
  client.shutdown(local::socket::shutdown_send);
  context.run();
  if (bodies->claimed_bytes() != 0) std::abort();
  const std::string answers = received(client);
  if (!answers.empty() && !answers.starts_with("HTTP/1.")) std::abort();
  return 0;
}
