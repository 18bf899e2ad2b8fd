#include "service/documents/validation_view.hpp"

#include "service/documents/figures.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/result_view.hpp"

namespace cell {
namespace {

/// `parameters`: those of the result document; a parameter that is not estimated has no new error.
void add_new_errors(const std::vector<Parameter>& parameters, const calib::Repetition& repetition,
                    std::vector<RepetitionDocument::NewError>& list) {
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const Parameter& parameter = parameters.at(static_cast<std::size_t>(i));
    const bool told = repetition.done() && parameter.status == calib::ParameterStatus::kIdentified;
    RepetitionDocument::NewError& found = list.emplace_back();
    found.name = parameter.name;
    found.frame = parameter.frame;
    found.kind = parameter.kind;
    found.unit = parameter.unit;
    found.status = parameter.status;
    if (!told) continue;
    found.new_error = finite(shown(i, repetition.new_errors[i]));
    found.std_new_error = finite(shown(i, repetition.std_new_errors[i]));
  }
}

void set_repetition(const std::vector<Parameter>& parameters, const calib::Repetition& repetition,
                    RepetitionDocument& document) {
  document.done = repetition.done();
  if (!repetition.done()) document.why_not = repetition.message;
  document.touch_count = repetition.touch_count;
  document.iterations = repetition.iteration_count;
  if (repetition.done()) document.new_error_max_si = finite(repetition.new_error_max());
  add_new_errors(parameters, repetition, document.parameters);
}

}  // namespace

RepetitionsDocument repetitions_of(const std::vector<Parameter>& parameters,
                                   const calib::Validation& validation) {
  RepetitionsDocument document;
  set_repetition(parameters, validation.same_touches, document.same_touches);
  document.same_touches.limit_si = calib::kSameTouchesErrorMax;
  document.same_touches.passed = validation.passed();
  set_repetition(parameters, validation.other_touches, document.other_touches);
  return document;
}

ValidationDocument validation_of(const Cell& cell, const Recipe& recipe,
                                 const calib::IdentificationProblem& problem,
                                 const calib::Validation& validation) {
  const calib::IdentificationResult& result = validation.result;
  const std::vector<Parameter> parameters = parameters_of(problem, recipe.identification, result);
  return {.arm = cell.arm.name,
          .recipe = recipe.name,
          .touch_count = result.fitted_touch_count,
          .identifiable_count = static_cast<int>(result.identifiable.columns.size()),
          .warnings = result.warnings,
          .repetitions = repetitions_of(parameters, validation),
          .planes = planes_of(cell, recipe, result.distances, calib::TouchRole::kFit),
          .planes_held_out = planes_of(cell, recipe, result.distances, calib::TouchRole::kHeldOut)};
}

std::string validation_document(const Cell& cell, const Recipe& recipe,
                                const calib::IdentificationProblem& problem,
                                const calib::Validation& validation) {
  return document_text(validation_of(cell, recipe, problem, validation));
}

}  // namespace cell
