#include "service/cli/api_client.hpp"

#include <sys/un.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "service/base/state_directory.hpp"

namespace cell {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace ssl = asio::ssl;

namespace {

constexpr std::string_view kPlainScheme = "http://";
constexpr std::string_view kSecureScheme = "https://";
constexpr std::size_t kAnswerSizeMax = 64 * 1024 * 1024;

using Request = http::request<http::string_body>;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;
using LocalStream = beast::basic_stream<asio::local::stream_protocol>;

asio::awaitable<void> connect(beast::tcp_stream& stream, Endpoint to, std::chrono::seconds deadline) {
  const auto executor = co_await asio::this_coro::executor;
  asio::ip::tcp::resolver resolver(executor);
  const auto addresses =
      co_await resolver.async_resolve(to.host, std::to_string(to.port), asio::use_awaitable);
  stream.expires_after(deadline);
  co_await stream.async_connect(addresses, asio::use_awaitable);
}

std::string text_of(const Request& request) {
  std::ostringstream text;
  text << request;
  return text.str();
}

/// The answer as its bytes come in.
class AnswerParser {
 public:
  AnswerParser() {
    parser_.eager(true);
    parser_.body_limit(kAnswerSizeMax);
  }

  [[nodiscard]] bool is_done() { return parser_.is_done(); }
  [[nodiscard]] asio::mutable_buffer prepare() { return buffer_.prepare(kPieceSize); }
  /// So many bytes were written to prepare().
  void take(std::size_t size) {
    buffer_.commit(size);
    boost::system::error_code error;
    buffer_.consume(parser_.put(buffer_.data(), error));
    if (error && error != http::error::need_more) throw boost::system::system_error(error);
  }
  [[nodiscard]] ApiReply reply() { return {parser_.get().result_int(), std::move(parser_.get().body())}; }

 private:
  static constexpr std::size_t kPieceSize = 64 * 1024;

  beast::flat_buffer buffer_;
  http::response_parser<http::string_body> parser_;
};

/// Beast's own operations would be compiled for each kind of stream; of these only Asio's are.
template <class Stream>
asio::awaitable<ApiReply> answer_over(Stream& stream, const Request& request) {
  const std::string text = text_of(request);
  co_await asio::async_write(stream, asio::buffer(text), asio::use_awaitable);
  AnswerParser answer;
  while (!answer.is_done()) {
    const std::size_t size = co_await stream.async_read_some(answer.prepare(), asio::use_awaitable);
    answer.take(size);
  }
  co_return answer.reply();
}

/// Nothing if nobody listens there.
asio::awaitable<std::optional<ApiReply>> ask_local(std::filesystem::path socket, Request request,
                                                   std::chrono::seconds deadline) {
  const auto executor = co_await asio::this_coro::executor;
  LocalStream stream(executor);
  stream.expires_after(deadline);
  if (socket.string().size() >= sizeof(sockaddr_un::sun_path)) co_return std::nullopt;
  const asio::local::stream_protocol::endpoint address(socket.string());
  boost::system::error_code failure;
  co_await stream.async_connect(address, asio::redirect_error(asio::use_awaitable, failure));
  if (failure) co_return std::nullopt;
  ApiReply reply = co_await answer_over(stream, request);
  co_return reply;
}

asio::awaitable<ApiReply> ask(Endpoint daemon, Request request, std::chrono::seconds deadline) {
  const auto executor = co_await asio::this_coro::executor;
  beast::tcp_stream stream(executor);
  co_await connect(stream, daemon, deadline);
  ApiReply reply = co_await answer_over(stream, request);
  co_return reply;
}

asio::awaitable<ApiReply> ask_secure(Endpoint daemon, Request request, std::chrono::seconds deadline,
                                     ssl::context& trusted) {
  const auto executor = co_await asio::this_coro::executor;
  TlsStream stream(executor, trusted);
  stream.set_verify_mode(ssl::verify_peer);
  stream.set_verify_callback(ssl::host_name_verification(daemon.host));
  SSL_set_tlsext_host_name(stream.native_handle(), daemon.host.c_str());
  co_await connect(beast::get_lowest_layer(stream), daemon, deadline);
  co_await stream.async_handshake(ssl::stream_base::client, asio::use_awaitable);
  ApiReply reply = co_await answer_over(stream, request);
  co_return reply;
}

ssl::context trusted_by(const std::filesystem::path& ca_file) {
  ssl::context context(ssl::context::tls_client);
  context.set_options(ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1);
  if (ca_file.empty()) {
    context.set_default_verify_paths();
    return context;
  }
  boost::system::error_code failure;
  context.load_verify_file(ca_file.string(), failure);
  if (failure)
    throw std::invalid_argument("--ca " + ca_file.string() + ": " + failure.message() +
                                "; name a file with certificates (PEM)");
  return context;
}

bool is_about_the_certificate(const boost::system::error_code& code) {
  return code.category() == asio::error::get_ssl_category() &&
         code.message().find("certificate verify failed") != std::string::npos;
}

bool is_this_machine(const std::string& host) {
  boost::system::error_code no_address;
  const auto address = asio::ip::make_address(host, no_address);
  return no_address ? host == "localhost" : address.is_loopback();
}

/// What to do about a daemon that was not reached.
std::string unreached_remedy(const boost::system::error_code& code) {
  if (is_about_the_certificate(code)) return "name the certificate that signed the daemon's with --ca FILE";
  if (code == asio::error::eof || code == asio::error::connection_reset || code == asio::error::broken_pipe ||
      code == beast::error::timeout)
    return "it took the connection and did not answer: it has ended, or has too many connections; try again";
  return "start it, or name it with --daemon URL";
}

/// Runs one exchange to its end; throws what it throws.
template <class Reply>
Reply reply_of(asio::awaitable<Reply> exchange) {
  asio::io_context context(1);
  std::optional<Reply> reply;
  std::exception_ptr failure;
  asio::co_spawn(context, std::move(exchange), [&](std::exception_ptr thrown, Reply answered) {
    failure = std::move(thrown);
    if (!failure) reply = std::move(answered);
  });
  context.run();
  if (failure) std::rethrow_exception(failure);
  return *std::move(reply);
}

}  // namespace

ApiClient::ApiClient(const std::string& url, std::optional<std::string> token, ApiClientOptions options)
    : is_secure_(url.starts_with(kSecureScheme)), token_(std::move(token)), options_(std::move(options)) {
  std::string rest;
  for (const std::string_view scheme : {kPlainScheme, kSecureScheme}) {
    if (url.starts_with(scheme)) rest = url.substr(scheme.size());
  }
  if (rest.ends_with('/')) rest.pop_back();
  const auto endpoint = parse_endpoint(rest);
  if (!endpoint)
    throw std::invalid_argument("'" + url + "' is neither http://HOST:PORT nor https://HOST:PORT");
  at_ = *endpoint;
  if (token_ && !is_secure_ && !options_.sends_token_in_clear && !is_this_machine(at_.host)) {
    throw std::invalid_argument("'" + url +
                                "': the token would go to another machine in clear; use https, or " +
                                "say --token-in-clear");
  }
}

std::string ApiClient::url() const {
  return std::string(is_secure_ ? kSecureScheme : kPlainScheme) + endpoint_text(at_);
}

ApiClient ApiClient::without_socket() const {
  ApiClient other = *this;
  other.options_.socket.clear();
  return other;
}

ApiReply ApiClient::get(const std::string& target, std::chrono::seconds deadline) const {
  return request(false, target, {}, deadline);
}

ApiReply ApiClient::post(const std::string& target, const std::string& body,
                         std::chrono::seconds deadline) const {
  return request(true, target, body, deadline);
}

ApiReply ApiClient::request(bool post, const std::string& target, const std::string& body,
                            std::chrono::seconds deadline) const {
  Request message(post ? http::verb::post : http::verb::get, target, 11);
  message.set(http::field::host, endpoint_text(at_));
  message.set(http::field::user_agent, "touchcal");
  message.keep_alive(false);
  if (token_) message.set(http::field::authorization, "Bearer " + *token_);
  if (post) {
    if (!body.empty()) message.set(http::field::content_type, "application/json");
    message.body() = body;
    message.prepare_payload();
  }
  std::string place = options_.socket.string();
  try {
    if (!options_.socket.empty()) {
      if (auto reply = reply_of(ask_local(options_.socket, message, deadline))) return *std::move(reply);
    }
    place = url();
    if (!is_secure_) return reply_of(ask(at_, std::move(message), deadline));
    ssl::context trusted = trusted_by(options_.ca_file);
    return reply_of(ask_secure(at_, std::move(message), deadline, trusted));
  } catch (const boost::system::system_error& error) {
    throw DaemonUnreachable("no touchcald answers at " + place + " (" + error.code().message() + "); " +
                            unreached_remedy(error.code()));
  }
}

std::optional<std::string> find_operate_token(const std::filesystem::path& state_directory) {
  if (const char* token = std::getenv("TOUCHCAL_TOKEN"); token && *token) return token;
  std::ifstream file(state_directory / kOperateTokenFile);
  std::string token;
  if (!std::getline(file, token)) return std::nullopt;
  return token;
}

}  // namespace cell
