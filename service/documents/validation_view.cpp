#include "service/documents/validation_view.hpp"

#include <nlohmann/json.hpp>

#include "service/base/json_figures.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/result_view.hpp"

namespace cell {
namespace {

/// `parameters`: those of the result document; a parameter that is not estimated has no new error.
Json new_errors_json(const Json& parameters, const calib::Repetition& repetition) {
  Json list = Json::array();
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const Json& parameter = parameters[static_cast<std::size_t>(i)];
    const bool is_known = repetition.done() && parameter["status"] == "identified";
    list.push_back(
        {{"name", parameter["name"]},
         {"frame", parameter["frame"]},
         {"kind", parameter["kind"]},
         {"unit", parameter["unit"]},
         {"status", parameter["status"]},
         {"new_error", is_known ? number(shown(i, repetition.new_errors[i])) : Json(nullptr)},
         {"std_new_error", is_known ? number(shown(i, repetition.std_new_errors[i])) : Json(nullptr)}});
  }
  return list;
}

Json repetition_json(const Json& parameters, const calib::Repetition& repetition) {
  return {{"done", repetition.done()},
          {"why_not", repetition.done() ? Json(nullptr) : Json(repetition.message)},
          {"touch_count", repetition.touch_count},
          {"iterations", repetition.iteration_count},
          {"new_error_max_si", repetition.done() ? number(repetition.new_error_max()) : Json(nullptr)},
          {"parameters", new_errors_json(parameters, repetition)}};
}

}  // namespace

Json repetitions_json(const Json& parameters, const calib::Validation& validation) {
  Json same = repetition_json(parameters, validation.same_touches);
  same["limit_si"] = calib::kSameTouchesErrorMax;
  same["passed"] = validation.passed();
  return {{"same_touches", same}, {"other_touches", repetition_json(parameters, validation.other_touches)}};
}

std::string validation_document(const Cell& cell, const Recipe& recipe,
                                const calib::IdentificationProblem& problem,
                                const calib::Validation& validation) {
  const calib::IdentificationResult& result = validation.result;
  const Json parameters = parameters_json(problem, recipe.identification, result);
  const Json repetitions = repetitions_json(parameters, validation);
  return text_of({{"schema", "touchcal/validation/1"},
                  {"arm", cell.arm.name},
                  {"recipe", recipe.name},
                  {"touch_count", result.fitted_touch_count},
                  {"identifiable_count", result.identifiable.columns.size()},
                  {"warnings", result.warnings},
                  {"same_touches", repetitions["same_touches"]},
                  {"other_touches", repetitions["other_touches"]},
                  {"planes", planes_json(cell, result.distances, calib::TouchRole::kFit)},
                  {"planes_held_out", planes_json(cell, result.distances, calib::TouchRole::kHeldOut)}});
}

}  // namespace cell
