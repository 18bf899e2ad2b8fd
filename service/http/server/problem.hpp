#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/http/server/http_message.hpp"

namespace cell {

/// RFC 9457: what every refusal looks like. `pointer` names the place in a body that is at fault, `parameter`
/// the query parameter.
struct Problem {
  unsigned status = 400;
  std::string_view kind;  // last part of the type: "urn:touchcal:problem:KIND"
  std::string detail;
  std::optional<std::string> pointer;
  std::vector<std::pair<std::string, std::string>> errors;  // code and detail of each unmet precondition
  std::vector<std::string> exits;                           // commands that the state allows
  std::optional<std::string> parameter;
};

HttpResponse to_response(const Problem& problem);

}  // namespace cell
