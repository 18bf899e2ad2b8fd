#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "service/http/routes.hpp"

/// One declaration a route: what answers it, who may ask, what it takes and what it gives. Requests are
/// checked, the OpenAPI document is written and the metrics are labelled by it.
namespace cell {

struct Cell;

enum class Access { kOpen, kView, kOperate };

/// How an answer comes about.
enum class Pace {
  kAtOnce,
  kLongPoll,  // at another status than the one that `after` names, or after `wait_s`
  kPlanning,  // when the recipe has been planned
  kWorker,    // by a thread of its own: the handler uses nothing but the request and Call::cell
  kEvents,    // a stream of events follows the header
};

/// A whole number in the query, or a text as it stands there.
struct QueryParameter {
  std::string_view name;
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  std::string_view words;
  bool is_text = false;
};

/// What a route gives when it does what it is asked. A schema is a name in schemas.hpp; none: no body.
struct Answer {
  unsigned status = 200;
  std::string_view schema;
  std::string_view content_type = "application/json";
};

inline constexpr std::size_t kBodyBytesMax = 64 * 1024;
/// Of a touches document that is sent to be identified.
inline constexpr std::size_t kTouchesBytesMax = 1024 * 1024;

/// A request that its route admits.
struct Call {
  const HttpRequest& request;
  Services& services;
  Operation& operation;
  std::string_view id;  // what stands at {id}
  const Cell& cell;     // on a worker one of its own: the operation's may be located elsewhere meanwhile

  /// A query parameter of the route; it is within its bounds.
  [[nodiscard]] std::optional<std::int64_t> number(std::string_view name) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view name) const;
  /// `id` as the number of a run; nothing when it is none.
  [[nodiscard]] std::optional<std::int64_t> run_id() const;
};

struct Route {
  std::string_view method;
  std::string_view path;  // "/api/v1/runs/{id}": {id} stands for any one segment
  std::string_view summary;
  Access access = Access::kView;
  HttpResponse (*handle)(const Call&) = nullptr;
  std::vector<Answer> answers;
  std::vector<QueryParameter> query = {};
  std::string_view body_schema = {};  // none: the route takes no body but {}
  std::size_t body_bytes_max = kBodyBytesMax;
  Pace pace = Pace::kAtOnce;
};

/// Everything that the daemon answers to.
std::span<const Route> routes();

/// The routes by topic, which routes() puts together.
std::vector<Route> service_routes();  // health, metrics, this table
std::vector<Route> status_routes();
std::vector<Route> run_routes();
std::vector<Route> command_routes();
std::vector<Route> planning_routes();  // plan, identify
std::vector<Route> cell_routes();      // what is configured
std::vector<Route> page_routes();

/// A stop is taken whatever comes with it, and whatever else does not work.
bool is_stop(const Route& route);

/// A stop, an abort or a pause: taken also when it cannot be written down.
bool only_halts(const Route& route);

struct Admitted {
  const Route* route = nullptr;
  std::string id;  // what stands at {id}, decoded
};

/// The route that a request means, or why it is refused: 404, 405, 401, 403, 400, 413, 415.
std::variant<Admitted, HttpResponse> admit(const HttpRequest& request, const Tokens& tokens);

/// The route of a path for this method, whoever asks; null when there is none.
const Route* find_route(std::string_view method, std::string_view path);

/// What is between {id}'s neighbours in `path`, empty without one; nothing when the path is another.
std::optional<std::string_view> match(std::string_view pattern, std::string_view path);

/// The answer of an admitted request; a failure inside is told without its inner workings and logged with
/// them.
HttpResponse handle(const Admitted& admitted, const HttpRequest& request, Services& services);
/// The same on a thread of its own, with a copy of the cell.
HttpResponse handle(const Admitted& admitted, const HttpRequest& request, Services& services,
                    const Cell& cell);

HttpResponse json_response(unsigned status, std::string body);
HttpResponse not_found(std::string detail);

}  // namespace cell
