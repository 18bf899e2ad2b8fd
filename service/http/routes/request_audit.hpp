#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "service/http/auth/record_rate.hpp"
#include "service/http/server/http_message.hpp"

namespace cell {

struct Caller;
struct Services;
struct StartBody;

/// Records requests in the audit log. It is used on the thread that serves and writes on that of the store.
/// `caller`: who sent the request, by the tokens that counted when it was admitted or refused. `start`, where
/// it is given: the body of a request that starts a run or approves one, which names the operator; for
/// another command that is the operator of its run. Both are told of who has an operate token only.
class RequestAudit {
 public:
  /// Refusals of strangers that are recorded at once; after these one a second.
  static constexpr int kStrangersAtOnce = 50;

  /// `services` must outlive it, and both threads must have ended before it goes.
  RequestAudit(boost::asio::any_io_executor store_thread, Services& services);
  ~RequestAudit();
  RequestAudit(const RequestAudit&) = delete;
  RequestAudit& operator=(const RequestAudit&) = delete;

  /// Before a command is executed. Whether it could be recorded: it is durable then.
  boost::asio::awaitable<bool> record_asked(const HttpRequest& request, const Caller& caller,
                                            const StartBody* start);

  /// What came of a command, or its refusal: written while the answer goes out. Those of strangers have a
  /// rate of their own; one that finds no room to wait for the disk is dropped, and the log says so.
  /// `durable`: at once and not with the next commit.
  void record(const HttpRequest& request, const Caller& caller, const StartBody* start, unsigned status,
              bool durable = false);

  /// Where the rate has left out refusals of strangers since the last one that was recorded: the newest of
  /// them, with the number of the others. A flood that has ended is so in the audit as a whole.
  void record_left_out();

 private:
  struct Row;
  [[nodiscard]] static Row row_of(const HttpRequest& request, const Caller& caller, const StartBody* start,
                                  std::string outcome);
  void write_behind(Row row);
  bool write(Row row);

  boost::asio::any_io_executor store_thread_;
  Services& services_;
  std::atomic<int> unwritten_{0};  // rows that wait for the store's thread
  bool was_full_ = false;
  RecordRate stranger_rate_{kStrangersAtOnce, std::chrono::seconds(1)};
  std::unique_ptr<Row> left_out_;  // the newest refusal that was, until one is recorded
};

}  // namespace cell
