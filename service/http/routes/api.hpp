#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <map>
#include <string>

#include "service/http/auth/record_rate.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"
#include "service/http/server/request_handler.hpp"

namespace cell {

/// Answers requests: waits where a route requires it (DispatchMode), repeats the first answer to an
/// Idempotency-Key, and records every command and every refusal in the audit log. A command that cannot be
/// recorded is refused, except one that halts.
class Api final : public RequestHandler {
 public:
  /// `operation` must outlive it; its clock also dates what is recorded here.
  Api(boost::asio::any_io_executor executor, CellOperation& operation, Tokens tokens);
  ~Api() override;

  boost::asio::awaitable<HttpResponse> answer(const HttpRequest& request) override;
  HttpResponse refuse(const Problem& problem, const HttpRequest& request) override;
  std::unique_ptr<EventSource> events(const HttpRequest& request) override;
  [[nodiscard]] HeaderDecision decide(const HttpRequest& header) const override;
  [[nodiscard]] bool ignores_query(std::string_view method, std::string_view path) const override;

  [[nodiscard]] Services& services() { return services_; }

 private:
  boost::asio::awaitable<HttpResponse> make_answer(const HttpRequest& request, const Admitted& admitted);
  boost::asio::awaitable<HttpResponse> execute_command(const HttpRequest& request, const Admitted& admitted);
  boost::asio::awaitable<HttpResponse> execute_command_once(const HttpRequest& request,
                                                            const Admitted& admitted);
  [[nodiscard]] std::string now_text() const;
  bool write_audit(const HttpRequest& request, const std::string& outcome, bool at_once);
  void append_audit(const AuditEntry& entry, Role role, bool at_once);
  boost::asio::awaitable<void> delay_wrong_token(const HttpRequest& request);
  boost::asio::awaitable<void> wait_for_status(const HttpRequest& request, const Admitted& admitted);
  boost::asio::awaitable<void> wait_for_plan(const HttpRequest& request);
  boost::asio::awaitable<HttpResponse> on_worker(const HttpRequest& request, const Admitted& admitted);

  boost::asio::any_io_executor executor_;
  Services services_;
  boost::asio::thread_pool worker_{1};
  int at_work_ = 0;  // requests on the worker or queued for it
  /// Consecutive wrong tokens of an address.
  struct WrongTokens {
    int count = 0;
    std::chrono::steady_clock::time_point latest;
  };
  std::map<std::string, WrongTokens> wrong_tokens_;
  RecordRate stranger_rate_{50, std::chrono::seconds(1)};
};

}  // namespace cell
