#include "service/http/result_routes.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "config/identification_problem.hpp"
#include "service/acquisition/cell_operation.hpp"
#include "service/calibrated_arm.hpp"
#include "service/http/parameter_view.hpp"
#include "service/http/result_view.hpp"

namespace cell {
namespace {

/// Documents give lengths in mm and angles in rad; the cell is another when its arm differs by more.
constexpr double kSameNominal = 1e-9;

struct Identified {
  const Recipe* recipe = nullptr;
  calib::IdentificationProblem problem;
  calib::IdentificationResult result;
};

HttpResponse conflict(const std::string& detail) {
  return to_response({.status = 409, .kind = "no-result", .detail = detail});
}

/// What the run's stored touches give now: the same as then, to the bit, as long as the cell is the same.
std::variant<Identified, HttpResponse> identify_stored(const CellOperation& operation, std::int64_t id) {
  const Cell& cell = operation.cell();
  const auto recipe = cell.recipes.find(operation.store().run(id)->recipe);
  if (recipe == cell.recipes.end())
    return conflict("there is no result: this cell no longer has the run's recipe");
  const std::vector<StoredTouch> touches = operation.store().touches(id);
  if (touches.empty()) return conflict("there is no result: no touch has been made yet");
  Identified identified{&recipe->second, identification_problem(cell, recipe->second), {}};
  std::ranges::transform(touches, std::back_inserter(identified.problem.touches), to_touch);
  identified.result = calib::identify(identified.problem, recipe->second.identification);
  if (identified.result.status == calib::IdentificationStatus::kConverged) return identified;
  return conflict("there is no result: " + identified.result.message);
}

bool has_this_nominal(const std::string& result_json, const calib::KinematicModel& model) {
  const nlohmann::json parameters = nlohmann::json::parse(result_json).at("parameters");
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const double then = parameters.at(static_cast<std::size_t>(i)).at("nominal").get<double>();
    if (!(std::abs(then - shown(i, calib::parameter_value(model, i))) <= kSameNominal)) return false;
  }
  return true;
}

std::optional<std::string> known_document(const CellOperation& operation, std::int64_t id) {
  if (auto stored = operation.store().result_json(id)) return stored;  // the run is over
  const Run* live = operation.run();
  return live && live->id() == id ? operation.result_json() : std::nullopt;
}

}  // namespace

HttpResponse get_result(const CellOperation& operation, std::int64_t id) {
  if (auto document = known_document(operation, id)) return {.body = std::move(*document)};
  // A run that the daemon's own end cut off has touches and no result: they are identified now.
  auto found = identify_stored(operation, id);
  if (auto* response = std::get_if<HttpResponse>(&found)) return std::move(*response);
  const Identified& identified = std::get<Identified>(found);
  const ResultContext context{
      .complete = false, .warnings = {}, .conditions = operation.store().run(id)->trace_json.value_or("")};
  return {.body = result_document(operation.tip_regions(), *identified.recipe, identified.problem,
                                  identified.result, context)};
}

HttpResponse get_arm(const CellOperation& operation, std::int64_t id) {
  const auto document = known_document(operation, id);
  if (document && !has_this_nominal(*document, operation.cell().arm.model)) {
    return conflict(
        "the cell's nominal arm is another one than in this run; its result tells the errors that were "
        "found then");
  }
  auto found = identify_stored(operation, id);
  if (auto* response = std::get_if<HttpResponse>(&found)) return std::move(*response);
  return {.body = calibrated_arm_document(operation.cell(), std::get<Identified>(found).result)};
}

}  // namespace cell
