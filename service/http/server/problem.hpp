#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/http/server/http_message.hpp"

namespace cell {

/// Why a request is refused: the last part of a problem's type, "urn:touchcal:problem:KIND".
enum class ProblemKind {
  kArchiveAway,
  kAudit,
  kBody,
  kBusy,
  kContentLength,
  kContentType,
  kDamaged,
  kExpect,
  kHost,
  kHttp,
  kIdempotencyKey,
  kInternal,
  kKnownRun,
  kMethod,
  kNoArchive,
  kNoModel,
  kNoPlan,
  kNoResult,
  kNotApprovable,
  kNotFound,
  kNotIdentifiable,
  kNotKept,
  kNotReady,
  kNotThisRun,
  kOrigin,
  kOtherArm,
  kPlanning,
  kPreconditions,
  kQuery,
  kRole,
  kSignIn,
  kState,
  kTarget,
  kToken,
  kTooLarge,
  kTransferEncoding,
  kUnknownPlan,
  kUnknownRecipe,
};
std::string_view problem_kind_name(ProblemKind kind);  // "no-plan"

/// RFC 9457: what every refusal looks like. `pointer` names the place in a body that is at fault, `parameter`
/// the query parameter.
struct Problem {
  unsigned status = 400;
  ProblemKind kind = ProblemKind::kInternal;
  std::string detail;
  std::optional<std::string> pointer;
  std::vector<std::pair<std::string, std::string>> errors;  // code and detail of each unmet precondition
  std::vector<std::string> exits;                           // commands that the state allows
  std::optional<std::string> parameter;
  std::optional<int> retry_after_s = {};  // when the same request may be taken, of what passes by itself
};

HttpResponse to_response(const Problem& problem);

}  // namespace cell
