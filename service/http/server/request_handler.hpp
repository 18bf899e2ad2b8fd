#pragma once

#include <boost/asio/awaitable.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "service/http/server/http_message.hpp"
#include "service/http/server/problem.hpp"
#include "service/http/server/token_rank.hpp"

namespace cell {

/// The body of an answer whose content type is kEventStreamType.
class EventSource {
 public:
  EventSource() = default;
  virtual ~EventSource() = default;
  EventSource(const EventSource&) = delete;
  EventSource& operator=(const EventSource&) = delete;

  /// The events that are due, as text; empty if there are none.
  virtual std::string due() = 0;
  [[nodiscard]] virtual bool ended() const = 0;
  /// Returns when an event may be due, or after a while.
  virtual boost::asio::awaitable<void> wait() = 0;
};

/// What follows from the header of a request alone, before its body is read.
struct HeaderDecision {
  bool takes_body = false;  // otherwise the answer is the same without one
  std::uint64_t body_bytes_max = 0;
  TokenRank token = TokenRank::kNone;
};

/// What a connection calls. The server knows neither routes nor the cell.
class RequestHandler {
 public:
  RequestHandler() = default;
  virtual ~RequestHandler() = default;
  RequestHandler(const RequestHandler&) = delete;
  RequestHandler& operator=(const RequestHandler&) = delete;

  /// `request` must outlive the answer.
  virtual boost::asio::awaitable<HttpResponse> answer(const HttpRequest& request) = 0;
  /// The answer to bytes that are not a request for this daemon. `request`: as far as it was parsed.
  virtual HttpResponse refuse(const Problem& problem, const HttpRequest& request) = 0;
  /// The events of a request whose answer was a stream of them.
  virtual std::unique_ptr<EventSource> events(const HttpRequest& request) = 0;
  /// A body is received only where this says so. `header`: the request without its body.
  [[nodiscard]] virtual HeaderDecision decide(const HttpRequest& header) const = 0;
  /// Whether a request is taken whatever its query is, as a stop is.
  [[nodiscard]] virtual bool ignores_query(std::string_view method, std::string_view path) const = 0;
};

inline constexpr std::string_view kEventStreamType = "text/event-stream";

}  // namespace cell
