#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/reads.hpp"
#include "service/http/routes/routes.hpp"
#include "service/http/server/problem.hpp"

/// One declaration per route: handler, access, parameters and answers. Checks of requests, the OpenAPI
/// document and the labels of metrics follow from it.
namespace cell {

struct Services;
struct StartBody;

/// How a request is dispatched. Without another word its handler is called on the thread that serves, where
/// it must not touch the disk, or on the reader's where Asked::needs_store says so.
enum class DispatchMode {
  kAtOnce,
  kLongPoll,  // answered at a status other than `after`, or after `wait_s`
  kPlanning,  // answered when the recipe has been planned
  kStored,    // on the reader's thread, since a disk takes time: it may use the request, Call::reads,
              // Call::asked
  kWritten,   // on the store's thread, since it writes: the request, Call::reads, Services::models
              // and Services::imports
  kWorker,    // on the worker's thread, since it takes long: it may use only the request and Call::reads
  kArchive,   // on a thread of its own, which waits for another machine: the request and Services::fleet
  kPeople,    // by the PeopleDesk: a secret is hashed beside the thread that serves; takes no Idempotency-Key
  kEvents,    // a stream of events follows the header; for one run the handler is called as for kStored
};

/// What the operation answers to a request, by value.
struct Asked {
  bool failed = false;                  // with an exception, which is logged
  std::optional<Problem> problem = {};  // of the request
  std::optional<CommandRefusal> refusal = {};
  std::vector<Command> exits = {};            // with a refusal: the commands that the state allows
  std::optional<StartRequest> to_start = {};  // answer_start() follows
  std::optional<Started> started = {};
  bool is_storing = false;   // CellOperation::touch_stored() follows
  bool needs_store = false;  // the handler looks something up in Call::reads: on the reader's thread
  std::optional<PlanOutcome> plan = {};
  std::vector<Unmet> unmet = {};
  std::optional<cs8::State> controller_state = {};
};

/// A query parameter: a whole number or a string.
struct QueryParameter {
  std::string_view name;
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  std::string_view words;
  bool is_text = false;
};

/// An answer in case of success. `schema`: a name in schemas.hpp; empty: no body.
struct Answer {
  unsigned status = 200;
  std::string_view schema;
  std::string_view content_type = "application/json";
};

/// Largest touches document for identification.
inline constexpr std::size_t kTouchesBytesMax = 1024 * 1024;
/// Largest targets document: 5,000 and more.
inline constexpr std::size_t kTargetsBytesMax = 1024 * 1024;

/// An admitted request.
struct Call {
  const HttpRequest& request;
  Services& services;
  std::string_view id;               // the segment at {id}
  const Reads& reads;                // of the thread that the handler is called on
  const Asked& asked;                // what Route::ask gave
  const StartBody* start = nullptr;  // Admitted::start

  /// A query parameter of the route, checked against its bounds.
  [[nodiscard]] std::optional<std::int64_t> number(std::string_view name) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view name) const;
  /// `id` as the number of a run, if it is one.
  [[nodiscard]] std::optional<std::int64_t> run_id() const;
};

struct Route {
  std::string_view method;
  std::string_view path;  // "/api/v1/runs/{id}": {id} matches any one segment
  std::string_view summary;
  Access access = Access::kView;
  HttpResponse (*handle)(const Call&) = nullptr;
  /// What has to be asked of the operation first: a short question or a command. Called on its thread, with a
  /// Call of which only the request and the id may be used.
  Asked (*ask)(const Call&, CellOperation&) = nullptr;
  std::vector<Answer> answers;
  std::vector<QueryParameter> query = {};
  std::string_view body_schema = {};  // empty: the only body is {}
  std::size_t body_bytes_max = kBodyBytesMax;
  DispatchMode dispatch = DispatchMode::kAtOnce;
  bool starts_run = false;  // its body is parsed with its admission: Admitted::start
  /// Its body may name the operator in the same way: Admitted::start.
  bool names_operator = false;
  bool tells_result = false;  // its handler needs a copy of the run under way when it is about that one
  /// A POST that changes nothing and is asked again and again, as while somebody types: it is not recorded,
  /// which would push commands out of the audit, and takes no Idempotency-Key.
  bool asks_only = false;
};

/// Largest body where a route takes none but {}.
inline constexpr std::size_t kEmptyBodyBytesMax = 1024;

/// Longest {id} of a path, decoded: the name of a user is the longest that there is. A longer one is
/// nothing's.
inline constexpr std::size_t kIdBytesMax = 64;

/// Largest body of a request to this route.
std::size_t body_bytes_max(const Route& route);

/// All routes.
std::span<const Route> routes();

/// The routes by topic.
std::vector<Route> service_routes();  // health, metrics, this table
std::vector<Route> status_routes();
std::vector<Route> run_routes();
std::vector<Route> run_file_routes();  // runs that travel
std::vector<Route> command_routes();
std::vector<Route> plan_routes();  // plan, identify
std::vector<Route> compensation_routes();
std::vector<Route> cell_routes();  // what is configured
std::vector<Route> audit_routes();
std::vector<Route> model_routes();  // what a person approved
std::vector<Route> check_routes();  // a calibration's checks together
std::vector<Route> comparison_routes();
std::vector<Route> page_routes();
std::vector<Route> user_routes();   // who may sign in, and does
std::vector<Route> setup_routes();  // what a new cell would be
std::vector<Route> fleet_routes();  // the other cells of the plant

/// A stop is executed whatever the request holds, and whatever else fails.
bool is_stop(const Route& route);

/// A stop, an abort or a pause: executed even if it cannot be recorded.
bool halts_only(const Route& route);

struct Admitted {
  const Route* route = nullptr;
  std::string id;                               // the segment at {id}, decoded
  std::shared_ptr<const StartBody> start = {};  // of a route that starts a run or names the operator
};

/// The route of a request, or its refusal: 404, 405, 401, 403, 400, 413, 415. For a request without its body,
/// what its header alone decides.
std::variant<Admitted, HttpResponse> admit(const HttpRequest& request, const Tokens& tokens);

/// The route of a path for this method, without any check; null if there is none.
const Route* find_route(std::string_view method, std::string_view path);

/// The segment of `path` at {id}, empty for a pattern without {id}; nothing if the path does not match.
std::optional<std::string_view> match(std::string_view pattern, std::string_view path);

/// The number of a run that a segment of a path names, if it is a number.
std::optional<std::int64_t> run_id_of(std::string_view segment);

/// What the route has to ask of the operation, on its thread; nothing if it asks nothing.
Asked ask_operation(const Admitted& admitted, const HttpRequest& request, Services& services);

/// A start, which waits for the store; on the operation's thread.
boost::asio::awaitable<Asked> answer_start(CellOperation& operation, StartRequest request);

/// The answer to an admitted request, by what its thread reads and what was asked. Damage of the
/// database becomes a 503 that names it, another exception a 500 without details, which are logged.
HttpResponse handle(const Admitted& admitted, const HttpRequest& request, Services& services,
                    const Reads& reads, const Asked& asked);

HttpResponse json_response(unsigned status, std::string body);
HttpResponse not_found(std::string detail);

}  // namespace cell
