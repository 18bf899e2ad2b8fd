#include "service/http/server/problem.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "service/base/json_figures.hpp"

namespace cell {
namespace {

const char* title_of(unsigned status) {
  switch (status) {
    case 400:
      return "Bad request";
    case 401:
      return "Token needed";
    case 403:
      return "Not allowed";
    case 404:
      return "Not found";
    case 405:
      return "Method not allowed";
    case 409:
      return "Not in this state";
    case 413:
      return "Too large";
    case 415:
      return "Wrong content type";
    case 417:
      return "Expectation failed";
    case 421:
      return "Wrong host";
    case 422:
      return "Not possible";
    case 429:
      return "Too often";
    case 431:
      return "Header too large";
    case 501:
      return "Not supported";
    case 503:
      return "Not now";
    default:
      return "Internal error";
  }
}

}  // namespace

std::string_view problem_kind_name(ProblemKind kind) {
  switch (kind) {
    case ProblemKind::kArchiveAway:
      return "archive-away";
    case ProblemKind::kAudit:
      return "audit";
    case ProblemKind::kBody:
      return "body";
    case ProblemKind::kBusy:
      return "busy";
    case ProblemKind::kContentLength:
      return "content-length";
    case ProblemKind::kContentType:
      return "content-type";
    case ProblemKind::kDamaged:
      return "damaged";
    case ProblemKind::kExpect:
      return "expect";
    case ProblemKind::kHost:
      return "host";
    case ProblemKind::kHttp:
      return "http";
    case ProblemKind::kIdempotencyKey:
      return "idempotency-key";
    case ProblemKind::kInternal:
      return "internal";
    case ProblemKind::kKnownRun:
      return "known-run";
    case ProblemKind::kMethod:
      return "method";
    case ProblemKind::kNoArchive:
      return "no-archive";
    case ProblemKind::kNoModel:
      return "no-model";
    case ProblemKind::kNoPlan:
      return "no-plan";
    case ProblemKind::kNoResult:
      return "no-result";
    case ProblemKind::kNotApprovable:
      return "not-approvable";
    case ProblemKind::kNotFound:
      return "not-found";
    case ProblemKind::kNotIdentifiable:
      return "not-identifiable";
    case ProblemKind::kNotKept:
      return "not-kept";
    case ProblemKind::kNotReady:
      return "not-ready";
    case ProblemKind::kNotThisRun:
      return "not-this-run";
    case ProblemKind::kOrigin:
      return "origin";
    case ProblemKind::kOtherArm:
      return "other-arm";
    case ProblemKind::kPlanning:
      return "planning";
    case ProblemKind::kPreconditions:
      return "preconditions";
    case ProblemKind::kQuery:
      return "query";
    case ProblemKind::kRole:
      return "role";
    case ProblemKind::kSignIn:
      return "sign-in";
    case ProblemKind::kState:
      return "state";
    case ProblemKind::kTarget:
      return "target";
    case ProblemKind::kToken:
      return "token";
    case ProblemKind::kTooLarge:
      return "too-large";
    case ProblemKind::kTransferEncoding:
      return "transfer-encoding";
    case ProblemKind::kUnknownPlan:
      return "unknown-plan";
    case ProblemKind::kUnknownRecipe:
      return "unknown-recipe";
  }
  return "";
}

HttpResponse to_response(const Problem& problem) {
  Json document{{"type", fmt::format("urn:touchcal:problem:{}", problem_kind_name(problem.kind))},
                {"title", title_of(problem.status)},
                {"status", problem.status},
                {"detail", problem.detail}};
  if (problem.pointer) document["pointer"] = *problem.pointer;
  if (problem.parameter) document["parameter"] = *problem.parameter;
  for (const auto& [code, detail] : problem.errors)
    document["errors"].push_back({{"code", code}, {"detail", detail}});
  if (!problem.exits.empty()) document["exits"] = problem.exits;
  HttpResponse response{
      .status = problem.status, .content_type = "application/problem+json", .body = text_of(document)};
  if (problem.retry_after_s)
    response.headers.emplace_back("Retry-After", std::to_string(*problem.retry_after_s));
  return response;
}

}  // namespace cell
