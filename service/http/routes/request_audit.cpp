#include "service/http/routes/request_audit.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <cstdint>
#include <optional>
#include <utility>

#include "service/base/run_on.hpp"
#include "service/base/utc_time.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/internal/people_body.hpp"
#include "service/http/routes/internal/start_body.hpp"
#include "service/http/routes/internal/user_routes.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"
#include "service/store/run_store.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// Rows that wait to be written. One more is dropped and logged: only commands that halt, outcomes and
/// refusals come to wait here, none of which may wait for a disk.
constexpr int kUnwrittenMax = 1000;
/// Longer than any request to a route of ours, whose ids are bounded (kIdBytesMax) and percent-encoded.
constexpr std::size_t kActionBytesMax = 256;
static_assert(kActionBytesMax >= std::string_view("POST ").size() + kRemoveUserPath.size() + 3 * kIdBytesMax);

/// The run that a command is for.
std::optional<std::int64_t> run_commanded_by(const HttpRequest& request) {
  const Route* route = find_route(request.method, request.path);
  if (!route || !route->path.starts_with("/api/v1/runs/{id}/")) return std::nullopt;
  return run_id_of(match(route->path, request.path).value_or(""));
}

/// Empty where nobody was named. A command does not fail by it: never throws.
std::string operator_of_run(const RunStore& store, std::int64_t id) try {
  const auto run = store.run(id);
  return run ? run->operator_name.value_or("") : "";
} catch (const std::exception& error) {
  spdlog::error("the operator of run {} is not known: {}", id, error.what());
  return {};
}

std::string left_out_text(int count) {
  return count > 0 ? std::to_string(count) + " more before it were not recorded" : "";
}

}  // namespace

/// What the thread that serves knows of a row.
struct RequestAudit::Row {
  AuditEntry entry;
  std::optional<std::int64_t> run = {};  // whose operator the store has to tell
  bool is_stranger = false;
  bool durable = false;
};

RequestAudit::RequestAudit(asio::any_io_executor store_thread, Services& services)
    : store_thread_(std::move(store_thread)), services_(services) {}

RequestAudit::~RequestAudit() = default;

RequestAudit::Row RequestAudit::row_of(const HttpRequest& request, const Caller& caller,
                                       const StartBody* start, std::string outcome) {
  Row row{.entry = {.who = std::string(role_name(caller.role)),
                    .token_name = caller.token_name,
                    .remote = request.remote,
                    .action = (request.method + " " + request.path).substr(0, kActionBytesMax),
                    .outcome = std::move(outcome)}};
  row.is_stranger = caller.role == Role::kNone || caller.role == Role::kWrongToken;
  // What others send as a name may be anything.
  if (caller.may_engineer()) row.entry.detail = person_asked_about(request);
  if (!caller.may_operate()) return row;
  if (start) {
    row.entry.operator_name = operator_of(*start);
  } else {
    row.run = run_commanded_by(request);
  }
  return row;
}

/// On the store's thread.
bool RequestAudit::write(Row row) {
  AuditEntry& entry = row.entry;
  entry.at = format_utc(services_.operation.clocks().system());
  if (row.run) entry.operator_name = operator_of_run(services_.operation.store(), *row.run);
  try {
    if (row.is_stranger) {
      services_.audit.append_of_stranger(entry);
    } else if (row.durable) {
      services_.audit.append_command(entry);
    } else {
      services_.audit.append_refusal(entry);
    }
    return true;
  } catch (const std::exception& error) {
    spdlog::error("{} {} could not be recorded: {}", entry.action, entry.outcome, error.what());
    return false;
  }
}

asio::awaitable<bool> RequestAudit::record_asked(const HttpRequest& request, const Caller& caller,
                                                 const StartBody* start) {
  Row row = row_of(request, caller, start, "asked");
  row.durable = true;
  const bool is_recorded = co_await run_on(store_thread_, [&] { return write(row); });
  co_return is_recorded;
}

void RequestAudit::record(const HttpRequest& request, const Caller& caller, const StartBody* start,
                          unsigned status, bool durable) {
  Row row = row_of(request, caller, start, std::to_string(status));
  row.durable = durable;
  if (row.is_stranger) {
    const auto left_out = stranger_rate_.admit(services_.operation.clocks().steady());
    if (!left_out) {
      left_out_ = std::make_unique<Row>(std::move(row));
      return;
    }
    left_out_.reset();
    row.entry.detail = left_out_text(*left_out);
  }
  write_behind(std::move(row));
}

void RequestAudit::record_left_out() {
  const int left_out = stranger_rate_.take_left_out();
  if (!left_out_) return;
  Row row = std::move(*left_out_);
  left_out_.reset();
  row.entry.detail = left_out_text(left_out - 1);  // this one is recorded now
  write_behind(std::move(row));
}

void RequestAudit::write_behind(Row row) {
  const bool is_full = unwritten_ >= kUnwrittenMax;
  if (is_full && !was_full_)
    spdlog::error("the disk is too slow: {} and what follows is not recorded", row.entry.action);
  was_full_ = is_full;
  if (is_full) return;
  ++unwritten_;
  asio::post(store_thread_, [this, row = std::move(row)] {
    write(row);
    --unwritten_;
  });
}

}  // namespace cell
