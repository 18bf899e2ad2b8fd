#include "service/cli/api_client.hpp"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <cstdlib>
#include <fstream>

#include "config/endpoint.hpp"
#include "service/http/tokens.hpp"

namespace cell {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;

namespace {

asio::awaitable<ApiReply> exchange(std::string host, std::string port,
                                   http::request<http::string_body> request, std::chrono::seconds deadline) {
  const auto executor = co_await asio::this_coro::executor;
  asio::ip::tcp::resolver resolver(executor);
  const auto addresses = co_await resolver.async_resolve(host, port, asio::use_awaitable);
  beast::tcp_stream stream(executor);
  stream.expires_after(deadline);
  co_await stream.async_connect(addresses, asio::use_awaitable);
  co_await http::async_write(stream, request, asio::use_awaitable);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(64 * 1024 * 1024);
  co_await http::async_read(stream, buffer, parser, asio::use_awaitable);
  co_return ApiReply{parser.get().result_int(), std::move(parser.get().body())};
}

}  // namespace

ApiClient::ApiClient(const std::string& url, std::optional<std::string> token) : token_(std::move(token)) {
  constexpr std::string_view kScheme = "http://";
  std::string rest = url.starts_with(kScheme) ? url.substr(kScheme.size()) : std::string();
  if (rest.ends_with('/')) rest.pop_back();
  const auto endpoint = parse_endpoint(rest);
  if (!endpoint) throw std::invalid_argument("'" + url + "' is not http://HOST:PORT");
  host_ = endpoint->host;
  port_ = std::to_string(endpoint->port);
}

ApiReply ApiClient::get(const std::string& target, std::chrono::seconds deadline) const {
  return request(false, target, {}, deadline);
}

ApiReply ApiClient::post(const std::string& target, const std::string& body) const {
  return request(true, target, body, std::chrono::seconds(10));
}

ApiReply ApiClient::request(bool post, const std::string& target, const std::string& body,
                            std::chrono::seconds deadline) const {
  http::request<http::string_body> message(post ? http::verb::post : http::verb::get, target, 11);
  message.set(http::field::host,
              (host_.find(':') == std::string::npos ? host_ : "[" + host_ + "]") + ":" + port_);
  message.set(http::field::user_agent, "touchcal");
  message.keep_alive(false);
  if (token_) message.set(http::field::authorization, "Bearer " + *token_);
  if (post) {
    if (!body.empty()) message.set(http::field::content_type, "application/json");
    message.body() = body;
    message.prepare_payload();
  }
  asio::io_context context(1);
  std::optional<ApiReply> reply;
  std::exception_ptr failure;
  asio::co_spawn(context, exchange(host_, port_, std::move(message), deadline),
                 [&](std::exception_ptr thrown, ApiReply answered) {
                   failure = std::move(thrown);
                   if (!failure) reply = std::move(answered);
                 });
  context.run();
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const boost::system::system_error& error) {
    throw DaemonUnreachable("no touchcald answers at " + url() + " (" + error.code().message() +
                            "); start it, or name it with --daemon URL");
  }
  return *reply;
}

std::optional<std::string> find_operate_token(const std::filesystem::path& state_directory) {
  if (const char* token = std::getenv("TOUCHCAL_TOKEN"); token && *token) return token;
  std::ifstream file(state_directory / kOperateTokenFile);
  std::string token;
  if (!std::getline(file, token)) return std::nullopt;
  return token;
}

}  // namespace cell
