#include "service/acquisition/cell_operation.hpp"
#include "service/http/routes/internal/event_stream.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {
namespace {

constexpr std::int64_t kSequenceMax = std::int64_t{1} << 53;  // what a JSON number holds exactly
/// A longer wait_s up to this is accepted and cut to Api's longest wait.
constexpr std::int64_t kWaitSecondsAccepted = 3600;

HttpResponse get_status(const Call& call) {
  const std::string& etag = call.services.feed.etag();
  const auto& known = call.request.if_none_match;
  if (known && (*known == "*" || known->find(etag) != std::string::npos))
    return {.status = 304, .headers = {{"ETag", etag}}};
  return {.body = call.services.feed.document(), .headers = {{"ETag", etag}}};
}

HttpResponse get_events(const Call& call) {
  if (!call.id.empty()) {
    const auto id = call.run_id();
    if (!id || !call.reads.store().run(*id))
      return not_found("there is no such run; GET /api/v1/runs lists them");
  }
  if (!call.id.empty() && EventStream::is_over(call.request.last_event_id)) return {.status = 204};
  return {.content_type = std::string(kEventStreamType)};
}

}  // namespace

std::vector<Route> status_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/status",
       .summary =
           "The status for polling: one flat document with a fixed set of fields. With wait_s and after the "
           "answer waits for another sequence, for 60 s at most",
       .handle = get_status,
       .answers = {{.schema = "Status"}, {.status = 304}},
       .query = {{"wait_s", 0, kWaitSecondsAccepted, "longest wait, with after"},
                 {"after", 0, kSequenceMax, "the known sequence"}},
       .dispatch = DispatchMode::kLongPoll},
      {.method = "GET",
       .path = "/api/v1/events",
       .summary = "Every change of the status as server-sent events; Last-Event-ID continues after the last "
                  "event; an event 'reset' says that this is not possible",
       .handle = get_events,
       .answers = {{.content_type = kEventStreamType}},
       .dispatch = DispatchMode::kEvents},
      {.method = "GET",
       .path = kRunEventsPath,
       .summary = "The same for one run; an event 'run' ends it",
       .handle = get_events,
       .answers = {{.content_type = kEventStreamType}, {.status = 204}},
       .dispatch = DispatchMode::kEvents},
  };
}

}  // namespace cell
