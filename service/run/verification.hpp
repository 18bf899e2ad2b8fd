#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/proof/calibration_record.hpp"
#include "calib_core/proof/check.hpp"
#include "calib_core/proof/proof.hpp"
#include "calib_core/proof/tool_centre.hpp"
#include "config/cell.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/check_reference.hpp"
#include "service/store/run_kind.hpp"
#include "service/store/run_store.hpp"

/// Proofs, checks, qualifications and the touches of a tool: runs whose touches are never fitted. They are
/// held against an earlier calibration; a qualification only as far as there is one.
namespace cell {

/// A complete check without a verdict, which may be part of the reference, as the store has it.
struct PastCheck {
  StoredRun run;
  std::vector<StoredTouch> touches;
};

/// Of a complete check: one without a verdict, as only those have that were made while the reference was not
/// whole. One that was left out of it for good, or judged, is none.
inline bool may_be_reference(const StoredRun& check) { return check.verdict == Verdict::kNone; }

/// A calibration as the store has it.
struct PastCalibration {
  StoredRun run;
  std::vector<StoredTouch> touches;
  std::vector<ReferenceTouch> references;
  std::optional<calib::TouchNoise> qualified = {};                    // by a qualification before it
  Eigen::Isometry3d cell_from_block = Eigen::Isometry3d::Identity();  // R_-1 then, in R_-1 of the cell's file
  std::vector<PastCheck> checks;  // that its reference is among; of a proof none
};

/// What the touches are held against.
struct Verification {
  RunKind kind = RunKind::kProof;
  std::optional<std::int64_t> of_run;              // the calibration; nothing only where `record` is
  std::optional<calib::CalibrationRecord> record;  // nothing only of a qualification
  std::string no_record;                           // why, one sentence with the remedy
  calib::ProofPlace place;
  calib::ProofLimits proof_limits;
  /// Of a check: the reference of this calibration, calib::kReferenceCount checks; none while it is not
  /// whole.
  std::vector<calib::ReferenceTime> references;
  /// While it is not whole: what it is made of, by reference_among() these and this check.
  std::vector<ReferenceCandidate> candidates;
  std::string tool;    // of RunKind::kTool: its name
  calib::ToolTip tip;  // ... and how it touches
};

/// One sentence with the remedy.
struct VerificationRefusal {
  std::string message;
  bool is_unknown_run = false;  // the run that was named is not there
};

using VerificationOutcome = std::variant<std::shared_ptr<const Verification>, VerificationRefusal>;

/// The calibration, identified again from its touches in the cell as it was then: tens of milliseconds.
/// `cell` is as it stands now, with its block at `cell_from_block`. Refused: one that does not converge.
std::variant<calib::CalibrationRecord, VerificationRefusal> record_of(
    const PastCalibration& past, const Cell& cell, const Eigen::Isometry3d& cell_from_block);

/// `cell`: as it stands now and as warm as its block is now, which is at `cell_from_block`. Refused: a
/// calibration that has no record_of(), the block of a check moved, that of a proof not moved. A
/// qualification is then qualification_alone(). `tool`: of RunKind::kTool, one of the cell's tool_tips.
VerificationOutcome verification_of(RunKind kind, const PastCalibration& past, const Cell& cell,
                                    const Eigen::Isometry3d& cell_from_block, const std::string& tool = {});

/// How a tool touches by the cell's files; one of its tool_tips. `std_growth`: of the arm since the
/// calibration.
calib::ToolTip tip_of(const Cell& cell, const std::string& tool, double std_growth);

/// Of a qualification that has no calibration to be held against: why not.
std::shared_ptr<const Verification> qualification_alone(std::string no_record);

/// The touches of a run that came to its end as the core takes them.
std::vector<calib::Touch> verifying_touches(std::span<const StoredTouch> touches);

/// The recipe of the calibration, as a run of this kind touches: planned touches only, none held out, no
/// reference place; of a proof only the faces that move with the block, of a qualification and a tool all.
Recipe verification_recipe(const Cell& cell, const Recipe& recipe, RunKind kind);

/// The cell with what stands under a block that was lifted since the calibration: nobody tells of the stand,
/// so that all of the space under the block is kept out of.
Cell with_stand(const Cell& cell, const Verification& verification);

}  // namespace cell
