#include "service/documents/internal/qualification_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/distributions.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/internal/verdict_word.hpp"
#include "service/documents/qualification_document.hpp"
#include "service/run/qualification.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

/// Of the interval that the true scatter is in, a half of what is left out on each side.
constexpr double kIntervalTail = 0.025;
constexpr double kCoverageFactor = 2.0;

QualificationDocument::Scatter scatter_of(const calib::TouchNoise& scatter) {
  const double degrees = scatter.degrees_of_freedom;
  const double squares = std::pow(calib::um_from_metres(scatter.std_m), 2) * degrees;
  return {.std_um = finite(calib::um_from_metres(scatter.std_m)),
          .degrees_of_freedom = finite(degrees),
          .low_um = finite(std::sqrt(squares / calib::chi_square_quantile(1.0 - kIntervalTail, degrees))),
          .high_um = finite(std::sqrt(squares / calib::chi_square_quantile(kIntervalTail, degrees)))};
}

QualificationDocument::Across across_of(const calib::AcrossStylus& across, double direction_rad) {
  return {.size_mm = finite(mm_from_metres(across.size_m())),
          .std_mm = finite(mm_from_metres(across.std_size_m())),
          .direction_deg = finite(calib::degrees_from_radians(direction_rad))};
}

std::string name_of(const calib::QualificationCriterion& criterion) {
  using Kind = calib::QualificationCriterion::Kind;
  switch (criterion.kind) {
    case Kind::kScatter:
      return "scatter";
    case Kind::kRunOut:
      return "run_out";
    case Kind::kLobes:
      return "lobes";
    case Kind::kTurns:
      return "turns";
    case Kind::kChange:
      return "stylus";
    case Kind::kStep:
      break;
  }
  return fmt::format("length_{}_{}", criterion.faces[0] + 1, criterion.faces[1] + 1);
}

QualificationDocument::Criterion criterion_of(const calib::QualificationCriterion& criterion) {
  using Kind = calib::QualificationCriterion::Kind;
  const bool is_test = criterion.kind == Kind::kTurns || criterion.kind == Kind::kChange;
  const auto shown = [&](double value) { return finite(is_test ? value : mm_from_metres(value)); };
  QualificationDocument::Criterion told{.name = name_of(criterion),
                                        .unit = is_test ? "p" : "mm",
                                        .value = shown(criterion.value),
                                        .passed = criterion.passed};
  if (criterion.limit) told.limit = shown(*criterion.limit);
  if (criterion.std) told.expanded = shown(kCoverageFactor * *criterion.std);
  return told;
}

void tell(const calib::QualificationVerdict& verdict, const std::vector<calib::Touch>& touches,
          QualificationDocument& document) {
  document.verdict = {.accepted = verdict.passed, .reasons = verdict.reasons};
  document.scatter = scatter_of(verdict.scatter);
  document.run_out = across_of(verdict.run_out, verdict.run_out.direction_rad());
  document.lobes = across_of(verdict.lobes, verdict.lobe_direction_rad());
  if (const auto& change = verdict.change)
    document.change = across_of(change->offset, change->offset.direction_rad());
  for (const calib::StepReading& step : verdict.steps)
    document.lengths.push_back({.planes = {step.faces[0] + 1, step.faces[1] + 1},
                                .known_mm = finite(mm_from_metres(step.known_m)),
                                .error_mm = finite(mm_from_metres(step.error_m)),
                                .std_mm = finite(mm_from_metres(step.std_m)),
                                .p = finite(step.p)});
  for (const calib::QualificationCriterion& criterion : verdict.criteria)
    document.criteria.push_back(criterion_of(criterion));
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const auto& deviation_m = verdict.deviations_m[i];
    document.touches.push_back(
        {.touch = static_cast<int>(i) + 1,
         .plane = touches[i].face + 1,
         .joint_6_deg = finite(calib::degrees_from_radians(touches[i].joints[calib::kJointCount - 1])),
         .deviation_mm = deviation_m ? finite(mm_from_metres(*deviation_m)) : std::nullopt});
  }
}

}  // namespace

VerificationResult qualification_result(const Cell& cell, const Run& run,
                                        const VerificationContext& context) {
  const Verification& against = *run.verification();
  QualificationDocument document{.arm = cell.arm.name,
                                 .probe = cell.probe.name,
                                 .touch_count = run.touches_done(),
                                 .complete = context.complete};
  if (against.of_run) document.of_run = std::to_string(*against.of_run);
  if (!against.no_record.empty()) document.no_of_run = against.no_record;
  if (!context.conditions.empty()) document.conditions = CarriedJson{context.conditions};
  if (!context.complete) {
    document.verdict.reasons = {"the qualification is not complete: it is judged by all of its touches"};
    return {document_text(document), Verdict::kIncomplete};
  }
  const std::vector<calib::Touch> touches = verifying_touches(run.touches());
  const Cell there = with_block_temperature(cell, run.block_temperature());
  const auto outcome = calib::qualify(qualification_problem(there, against), touches);
  if (const auto* refusal = std::get_if<calib::QualificationRefusal>(&outcome)) {
    document.verdict.reasons = {refusal->message};
  } else {
    tell(std::get<calib::QualificationVerdict>(outcome), touches, document);
  }
  return {document_text(document), verdict_of(document.verdict)};
}

}  // namespace cell
