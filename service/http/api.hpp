#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <map>
#include <string>

#include "service/http/route_table.hpp"
#include "service/http/services.hpp"

namespace cell {

/// Requests in, answers out, over time: waits where a route has to (Pace), gives a repeated Idempotency-Key
/// its first answer, and writes down every command and every refusal of one. A command that cannot be written
/// down is refused, but for a stop.
class Api {
 public:
  /// `operation` must outlive it; its clock is also that of what is written down here.
  Api(boost::asio::any_io_executor executor, CellOperation& operation, Tokens tokens);
  ~Api();

  /// `request` must outlive the answer.
  boost::asio::awaitable<HttpResponse> answer(const HttpRequest& request);
  /// The answer to what is no request, or is none for us. `request`: as far as it was understood.
  HttpResponse refuse(const Problem& problem, const HttpRequest& request);

  [[nodiscard]] Services& services() { return services_; }

 private:
  boost::asio::awaitable<HttpResponse> make_answer(const HttpRequest& request, const Admitted& admitted);
  boost::asio::awaitable<HttpResponse> obey(const HttpRequest& request, const Admitted& admitted);
  boost::asio::awaitable<HttpResponse> obey_once(const HttpRequest& request, const Admitted& admitted);
  [[nodiscard]] std::string now_text() const;
  bool write_audit(const HttpRequest& request, const std::string& outcome, bool at_once);
  boost::asio::awaitable<void> slow_down(const HttpRequest& request);
  boost::asio::awaitable<void> wait_for_status(const HttpRequest& request, const Admitted& admitted);
  boost::asio::awaitable<void> wait_for_plan(const HttpRequest& request);
  boost::asio::awaitable<HttpResponse> on_worker(const HttpRequest& request, const Admitted& admitted);

  boost::asio::any_io_executor executor_;
  Services services_;
  boost::asio::thread_pool worker_{1};
  int at_work_ = 0;                          // requests that the worker has, or that wait for it
  std::map<std::string, int> wrong_tokens_;  // in a row, by address
};

}  // namespace cell
