#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "service/http/auth/session_ends.hpp"
#include "service/http/auth/tokens.hpp"
#include "service/http/auth/wrong_tokens.hpp"
#include "service/http/routes/request_audit.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"
#include "service/http/server/request_handler.hpp"

namespace cell {

/// The threads that an Api goes to from its own; each executor has one.
struct ApiThreads {
  boost::asio::any_io_executor operation;  // where the operation is asked and commanded
  boost::asio::any_io_executor store;      // where the audit and the answers are written
  // Where what is stored is read, and where documents from outside are identified. Empty: the Api has a
  // thread of its own for each.
  boost::asio::any_io_executor reader = {};
  boost::asio::any_io_executor worker = {};
};

class PeopleDesk;

/// Answers requests: waits where a route requires it (DispatchMode), repeats the first answer to an
/// Idempotency-Key, and records every command and every refusal in the audit log. A command that cannot be
/// recorded is refused, except one that halts, which is recorded afterwards. It has the thread of `executor`;
/// README.md of service/ says what waits for what.
class Api final : public RequestHandler {
 public:
  /// `operation` must outlive it; its clock also dates what is recorded here. Before it is destroyed all
  /// threads must have ended.
  Api(boost::asio::any_io_executor executor, ApiThreads threads, CellOperation& operation, Tokens tokens);
  /// Everything on one thread, in order.
  Api(boost::asio::any_io_executor executor, CellOperation& operation, Tokens tokens);
  ~Api() override;

  boost::asio::awaitable<HttpResponse> answer(const HttpRequest& request) override;
  HttpResponse refuse(const Problem& problem, const HttpRequest& request) override;
  std::unique_ptr<EventSource> events(const HttpRequest& request) override;
  [[nodiscard]] HeaderDecision decide(const HttpRequest& header) const override;
  [[nodiscard]] bool ignores_query(std::string_view method, std::string_view path) const override;

  [[nodiscard]] Services& services() { return services_; }

  /// Reads the tokens again and again, on the thread that reads, until the executor ends: one whose file has
  /// gone or is refused ends within this time, and a new one counts.
  boost::asio::awaitable<void> follow_tokens(KnownDirectory state_directory, std::chrono::milliseconds every);
  /// Reads what is stored of the cell's checks and models for the metrics, now and again and again, on the
  /// thread that reads, until the executor ends.
  boost::asio::awaitable<void> follow_cell(std::chrono::milliseconds every);
  /// Records again and again how many refusals of strangers were left out, until the executor ends: the tail
  /// of a flood is in the audit within this time.
  boost::asio::awaitable<void> follow_strangers(std::chrono::milliseconds every);
  /// The same once. On the thread that serves, or when that has ended.
  void record_left_out() { audit_.record_left_out(); }
  /// Writes again and again who may sign in, where the disk did not take it, until the executor ends.
  boost::asio::awaitable<void> follow_users(std::chrono::milliseconds every);
  /// Waits for what threads of its own are at, of which nobody hears any more. Call it before the
  /// contexts end whose coroutines wait for them.
  void end_desks();
  /// From now on these count. An event stream whose token does not count any more ends.
  void take_tokens(Tokens now);
  /// These people may sign in, and these have.
  void take_users(const UserBook& book);

 private:
  struct Desk;  // internal/desk.hpp

  boost::asio::awaitable<HttpResponse> make_answer(const HttpRequest& request, const Admitted& admitted);
  boost::asio::awaitable<HttpResponse> execute_command(const HttpRequest& request, const Caller& caller,
                                                       const Admitted& admitted);
  boost::asio::awaitable<HttpResponse> execute_command_once(const HttpRequest& request,
                                                            const Admitted& admitted);
  [[nodiscard]] std::string now_text() const;
  boost::asio::awaitable<void> delay_guess(const HttpRequest& request);
  boost::asio::awaitable<void> wait_for_status(const HttpRequest& request);
  boost::asio::awaitable<void> wait_for_plan(const HttpRequest& request);
  boost::asio::awaitable<Asked> ask(const HttpRequest& request, const Admitted& admitted);
  Desk* desk_for(const Admitted& admitted, const Asked& asked);
  boost::asio::awaitable<HttpResponse> at_desk(Desk& desk, const HttpRequest& request,
                                               const Admitted& admitted, const Asked& asked);
  boost::asio::awaitable<std::optional<StoredRun>> read_run(std::int64_t id);
  boost::asio::awaitable<std::shared_ptr<const ActiveRun>> live_run(const Admitted& admitted);

  boost::asio::any_io_executor executor_;
  ApiThreads threads_;
  Services services_;
  RequestAudit audit_;
  Reads reads_of_store_;           // of the thread of the store, for what is written there
  std::unique_ptr<Desk> reader_;   // of stored runs
  std::unique_ptr<Desk> worker_;   // identifies
  std::unique_ptr<Desk> secrets_;  // hashes
  std::unique_ptr<Desk> archive_;  // asks the archive of the plant
  std::unique_ptr<PeopleDesk> people_;
  int at_store_ = 0;  // commands that wait for the store
  SessionEnds session_ends_;
  WrongTokens wrong_tokens_;
};

}  // namespace cell
