#include <spdlog/spdlog.h>

#include <cstdlib>
#include <variant>

#include "config/config_error.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/setup/arm_source.hpp"
#include "service/setup/check_document.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAnswersBody = "request body";

constexpr int kTemporaryRetrySeconds = 10;

/// What the query asks for.
using AskedLanguage = std::variant<const SetupLanguage*, HttpResponse>;

AskedLanguage asked_language(const Call& call) {
  const SetupLanguage* language = setup_language(call.text("language").value_or("en"));
  if (language != nullptr) return language;
  return to_response(
      {.kind = ProblemKind::kQuery, .detail = "language is neither en, fr nor de", .parameter = "language"});
}

/// Of the program that runs. ConfigError as shipped_config_of().
fs::path shipped_config_here() {
  return shipped_config_of(fs::read_symlink("/proc/self/exe"), std::getenv("TOUCHCAL_CONFIG"));
}

HttpResponse no_shipped_config(const ConfigError& error) {
  return to_response({.status = 503, .kind = ProblemKind::kNotReady, .detail = error.what()});
}

/// The files are checked in one; on a full disk, say, there is none.
HttpResponse no_temporary_folder(const std::runtime_error& error) {
  spdlog::warn("answers of a setup could not be checked: {}", error.what());
  return to_response({.status = 503,
                      .kind = ProblemKind::kBusy,
                      .detail =
                          "the answers cannot be checked: there is no room for temporary files (TMPDIR); "
                          "see the log",
                      .retry_after_s = kTemporaryRetrySeconds});
}

HttpResponse get_setup_questions(const Call& call) {
  auto language = asked_language(call);
  if (auto* refused = std::get_if<HttpResponse>(&language)) return std::move(*refused);
  try {
    return {.body =
                setup_questions_document(shipped_config_here(), *std::get<const SetupLanguage*>(language))};
  } catch (const ConfigError& error) {
    return no_shipped_config(error);
  }
}

HttpResponse post_setup_check(const Call& call) {
  auto asked = asked_language(call);
  if (auto* refused = std::get_if<HttpResponse>(&asked)) return std::move(*refused);
  const SetupLanguage& language = *std::get<const SetupLanguage*>(asked);
  SetupPlaces places;
  try {
    places = {.shipped_config = shipped_config_here(), .temporary = fs::temp_directory_path()};
  } catch (const ConfigError& error) {
    return no_shipped_config(error);
  } catch (const fs::filesystem_error& error) {
    return no_temporary_folder(error);
  }
  try {
    const SetupCheck check = check_setup(kAnswersBody, call.request.body, places, language);
    return {.body = setup_check_document(check, places.shipped_config, language)};
  } catch (const ConfigError& error) {
    return to_response({.kind = ProblemKind::kBody, .detail = error.what(), .pointer = error.pointer()});
  } catch (const std::runtime_error& error) {
    return no_temporary_folder(error);
  }
}

const QueryParameter kLanguage{
    .name = "language", .words = "en, fr or de: of the questions", .is_text = true};

}  // namespace

std::vector<Route> setup_routes() {
  return {{.method = "GET",
           .path = "/api/v1/setup/questions",
           .summary = "What touchcal setup asks, for a form",
           .handle = get_setup_questions,
           .answers = {{.schema = "SetupQuestions"}},
           .query = {kLanguage},
           .dispatch = DispatchMode::kStored},
          {.method = "POST",
           .path = "/api/v1/setup/check",
           .summary = "What cell would be made of answers, and what is wrong with them; changes nothing",
           .access = Access::kEngineer,
           .handle = post_setup_check,
           .answers = {{.schema = "SetupCheck"}},
           .query = {kLanguage},
           .body_schema = "SetupAnswers",
           .dispatch = DispatchMode::kWorker,
           .asks_only = true}};
}

}  // namespace cell
