#include "service/run/verification.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "calib_core/estimation/block_registration.hpp"
#include "calib_core/geometry/units.hpp"
#include "config/identification_problem.hpp"
#include "config/moved_cell.hpp"
#include "config/place_cell.hpp"
#include "config/touched_places.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/run.hpp"
#include "service/run/run_recipe.hpp"
#include "service/run/run_repeats.hpp"

namespace cell {
namespace {

/// Nobody knows better how much warmer the arm is than at its calibration.
constexpr double kStdWarmthKelvins = 2.0;
/// Two places of one block that differ by less are the same: to this a person finds it again.
constexpr double kSamePlaceMetres = 2e-3;
/// The same location, but for the rounding of the documents that it went through.
constexpr double kSameLocated = 1e-8;

struct IdentifiedAgain {
  calib::IdentificationProblem problem;
  calib::IdentificationOptions options;
  calib::IdentificationResult result;
};

/// In the cell as it was then.
IdentifiedAgain identify_again(const PastCalibration& past, const Cell& cell) {
  const Recipe recipe = recipe_of(past.run, cell);
  IdentifiedAgain again{identification_problem(cell, recipe), recipe.identification, {}};
  std::ranges::transform(past.touches, std::back_inserter(again.problem.touches), to_touch);
  note_repeats(repeats_of(past.touches, past.references, past.qualified, faces_per_place(cell.block, recipe)),
               again.problem);
  again.result = calib::identify(again.problem, again.options);
  return again;
}

std::optional<VerificationRefusal> refuse_place(RunKind kind, std::int64_t run,
                                                const Eigen::Isometry3d& calibrated_from_block) {
  const double way_m = calibrated_from_block.translation().norm();
  if (kind == RunKind::kProof && way_m < calib::kProofWayMinMetres)
    return VerificationRefusal{fmt::format(
        "the block stands {:.0f} mm from where it stood in run {}, which proves nothing: lift it by 300 mm, "
        "find it with touchcal locate, and prove again",
        calib::mm_from_metres(way_m), run)};
  if (kind == RunKind::kTool && !calibrated_from_block.isApprox(Eigen::Isometry3d::Identity(), kSameLocated))
    return VerificationRefusal{fmt::format(
        "the block was moved or located anew since run {}, by which its place is known well enough for a "
        "tool: calibrate anew where it stands, then touch with the tool",
        run)};
  if (kind != RunKind::kProof && way_m > kSamePlaceMetres)
    return VerificationRefusal{
        fmt::format("the block stands {:.0f} mm from where it stood in run {}: a {} touches it at that "
                    "place; put it back and find it with touchcal locate, or calibrate anew",
                    calib::mm_from_metres(way_m), run, run_kind_name(kind))};
  return std::nullopt;
}

std::vector<calib::ContactSurface> contact_planes_of(const Cell& cell, const Recipe& recipe) {
  return calib::make_artefact(artefact_knowledge(cell, recipe)).contact_planes;
}

/// Of a check.
void take_reference(const PastCalibration& past, const Cell& cell, Verification& made) {
  const Recipe recipe = recipe_of(past.run, cell);
  for (const PastCheck& check : past.checks)
    made.candidates.push_back(
        {check.run.id,
         {verifying_touches(check.touches),
          contact_planes_of(with_block_temperature(cell, temperature_of(check.run, cell)), recipe)}});
  const auto chosen = reference_among(cell.arm.model, made.candidates);
  if (std::ssize(chosen) < calib::kReferenceCount) return;
  for (const std::size_t i : chosen) made.references.push_back(std::move(made.candidates[i].time));
  made.candidates.clear();
}

}  // namespace

std::variant<calib::CalibrationRecord, VerificationRefusal> record_of(
    const PastCalibration& past, const Cell& cell, const Eigen::Isometry3d& cell_from_block) {
  const Cell then =
      with_block_temperature(with_block_moved(cell, cell_from_block.inverse() * past.cell_from_block),
                             temperature_of(past.run, cell));
  const IdentifiedAgain again = identify_again(past, then);
  if (again.result.status != calib::IdentificationStatus::kConverged || !again.result.uncertainty)
    return VerificationRefusal{fmt::format(
        "run {} cannot be identified again from its touches, so that nothing can be held against it: {}; "
        "calibrate anew",
        past.run.id, again.result.message)};
  return calib::CalibrationRecord(again.problem, again.options, again.result);
}

namespace {

VerificationOutcome held_against(RunKind kind, const PastCalibration& past, const Cell& cell,
                                 const Eigen::Isometry3d& cell_from_block, const std::string& tool) {
  const Eigen::Isometry3d calibrated_from_block = past.cell_from_block.inverse() * cell_from_block;
  if (auto refusal = refuse_place(kind, past.run.id, calibrated_from_block)) return *std::move(refusal);
  auto record = record_of(past, cell, cell_from_block);
  if (auto* refusal = std::get_if<VerificationRefusal>(&record)) return *refusal;
  Verification made{.kind = kind,
                    .of_run = past.run.id,
                    .record = std::get<calib::CalibrationRecord>(std::move(record)),
                    .no_record = {},
                    .place = {.calibrated_from_block = calibrated_from_block},
                    .proof_limits = {},
                    .references = {},
                    .candidates = {},
                    .tool = tool,
                    .tip = {}};
  if (const auto limit_m = cell.acceptance.proof_rms_max_m) made.proof_limits.rms_max_m = *limit_m;
  if (cell.arm.growth) made.place.std_growth = kStdWarmthKelvins * cell.arm.growth->expansion_per_k;
  if (kind == RunKind::kTool) made.tip = tip_of(cell, tool, made.place.std_growth);
  made.record->meet_at(contact_planes_of(cell, recipe_of(past.run, cell)));
  take_reference(past, cell, made);
  return std::make_shared<const Verification>(std::move(made));
}

}  // namespace

VerificationOutcome verification_of(RunKind kind, const PastCalibration& past, const Cell& cell,
                                    const Eigen::Isometry3d& cell_from_block, const std::string& tool) {
  VerificationOutcome outcome = held_against(kind, past, cell, cell_from_block, tool);
  const auto* refusal = std::get_if<VerificationRefusal>(&outcome);
  if (!refusal || kind != RunKind::kQualification) return outcome;
  Verification alone = *qualification_alone(refusal->message);
  alone.place.calibrated_from_block = past.cell_from_block.inverse() * cell_from_block;
  return std::make_shared<const Verification>(std::move(alone));
}

calib::ToolTip tip_of(const Cell& cell, const std::string& tool, double std_growth) {
  const TouchingTip& tip = cell.tool_tips.at(tool);
  const calib::Stylus& ball = cell.probe.stylus;
  return {.drawn_m = cell.tools.at(tool).translation(),
          .larger_m = tip.radius_m - (ball.radius_m - ball.pretravel_m),
          .std_radius_m = tip.std_radius_m,
          .noise_m = tip.noise_m,
          .std_growth = std_growth};
}

std::shared_ptr<const Verification> qualification_alone(std::string no_record) {
  Verification alone{.kind = RunKind::kQualification,
                     .of_run = std::nullopt,
                     .record = std::nullopt,
                     .no_record = std::move(no_record),
                     .place = {},
                     .proof_limits = {},
                     .references = {},
                     .candidates = {},
                     .tool = {},
                     .tip = {}};
  return std::make_shared<const Verification>(std::move(alone));
}

std::vector<calib::Touch> verifying_touches(std::span<const StoredTouch> touches) {
  std::vector<calib::Touch> made;
  std::ranges::transform(touches, std::back_inserter(made), to_touch);
  return made;
}

namespace {

std::vector<int> every_face(const Block& block) {
  std::vector<int> all(block.faces.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Of one whose plan does not say by itself how many there are.
int touch_count_of(RunKind kind) {
  if (kind == RunKind::kTool) return calib::kToolTouchCount;
  return kind == RunKind::kProof ? calib::kProofTouchCount : calib::kCheckTouchCount;
}

}  // namespace

Recipe verification_recipe(const Cell& cell, const Recipe& recipe, RunKind kind) {
  Recipe made = recipe;
  made.places.clear();
  made.tips.clear();
  if (kind == RunKind::kProof) made.faces = faces_of_first_solid(cell.block);
  if (kind == RunKind::kQualification || kind == RunKind::kTool) made.faces = every_face(cell.block);
  made.fit_per_face = 0;
  made.held_out_per_face = 0;
  made.reference_every = 0;
  made.goal = {.fit_count = touch_count_of(kind)};
  return made;
}

Cell with_stand(const Cell& cell, const Verification& verification) {
  return with_stand_under(cell, verification.place.calibrated_from_block);
}

}  // namespace cell
