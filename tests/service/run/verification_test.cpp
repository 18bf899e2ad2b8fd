#include "service/run/verification.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "config/moved_cell.hpp"
#include "config/touched_places.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Cell& with_plate() {
  static const Cell cell = read_cell(kSourceDir / "config/cells/demo/cell.json");
  return cell;
}

/// The exact touches of an arm with the errors of Table III.
PastCalibration table3_calibration() {
  PastCalibration past{.run = {.id = 7, .recipe = "edf-25"}, .touches = {}, .references = {}, .checks = {}};
  int number = 0;
  for (const calib::Touch& touch : table3_touches())
    past.touches.push_back(
        {.number = ++number, .plane = touch.face + 1, .role = touch.role, .joints = to_wire(touch.joints)});
  return past;
}

Eigen::Isometry3d up_by(double metres) { return Eigen::Isometry3d(Eigen::Translation3d(0.0, -metres, 0.0)); }

std::string refusal(RunKind kind, const PastCalibration& past, const Eigen::Isometry3d& place) {
  const auto outcome = verification_of(kind, past, with_block_moved(edf(), place), place);
  const auto* refused = std::get_if<VerificationRefusal>(&outcome);
  return refused ? refused->message : "";
}

Verification verification(RunKind kind, const PastCalibration& past, const Eigen::Isometry3d& place) {
  const auto outcome = verification_of(kind, past, with_block_moved(edf(), place), place);
  if (const auto* refused = std::get_if<VerificationRefusal>(&outcome))
    throw std::runtime_error(refused->message);
  return *std::get<std::shared_ptr<const Verification>>(outcome);
}

TEST(VerificationOfACalibration, IsOfItsRunAtThePlaceThatTheBlockHasNow) {
  PastCalibration past = table3_calibration();
  past.cell_from_block = Eigen::Translation3d(0.1, 0.0, 0.0) * Eigen::Isometry3d::Identity();
  const auto outcome = verification_of(RunKind::kProof, past, with_block_moved(edf(), up_by(0.3)),
                                       past.cell_from_block * up_by(0.3));
  const auto* found = std::get_if<std::shared_ptr<const Verification>>(&outcome);
  ASSERT_TRUE(found);
  const Verification& proof = **found;
  EXPECT_EQ(proof.of_run, 7);
  EXPECT_TRUE(proof.place.calibrated_from_block.isApprox(up_by(0.3), 1e-12));
  EXPECT_EQ(proof.record->problem().artefact.contact_planes.size(), edf().block.faces.size());
}

TEST(VerificationOfACalibration, AProofNeedsAnotherPlaceAndACheckTheSame) {
  const PastCalibration past = table3_calibration();
  EXPECT_THAT(refusal(RunKind::kProof, past, up_by(0.09)), HasSubstr("90 mm from where it stood in run 7"));
  EXPECT_EQ(refusal(RunKind::kProof, past, up_by(0.11)), "");
  EXPECT_THAT(refusal(RunKind::kCheck, past, up_by(0.003)), HasSubstr("put it back"));
  EXPECT_EQ(refusal(RunKind::kCheck, past, up_by(0.001)), "");
}

TEST(VerificationOfACalibration, WithoutTouchesThatIdentifyTheArmThereIsNone) {
  PastCalibration past = table3_calibration();
  past.touches.resize(4);
  EXPECT_THAT(refusal(RunKind::kCheck, past, up_by(0.0)), HasSubstr("run 7 cannot be identified again"));
}

TEST(VerificationOfACalibration, TheReferenceIsTheFirstThreeWholeChecks) {
  PastCalibration past = table3_calibration();
  const PastCheck whole{{}, {past.touches.begin(), past.touches.begin() + calib::kCheckTouchCount}};
  const PastCheck short_one{{}, {whole.touches.begin(), whole.touches.end() - 1}};
  past.checks = {short_one, whole, whole};
  EXPECT_THAT(verification(RunKind::kCheck, past, up_by(0.0)).references, IsEmpty());
  past.checks = {whole, whole, short_one, whole, whole};
  EXPECT_THAT(verification(RunKind::kCheck, past, up_by(0.0)).references, SizeIs(calib::kReferenceCount));
  EXPECT_THAT(verification(RunKind::kCheck, past, up_by(0.0)).candidates, IsEmpty());
}

TEST(VerificationOfACalibration, ThreeChecksThatDoNotAgreeAreNoReference) {
  PastCalibration past = table3_calibration();
  const auto first = past.touches.begin();
  const PastCheck one{{.id = 8}, {first, first + calib::kCheckTouchCount}};
  const PastCheck other{{.id = 9}, {first + 12, first + 12 + calib::kCheckTouchCount}};
  past.checks = {one, other, one};
  const Verification made = verification(RunKind::kCheck, past, up_by(0.0));
  EXPECT_THAT(made.references, IsEmpty());
  EXPECT_THAT(made.candidates, SizeIs(3)) << "the next check may agree with any of them";
}

TEST(VerificationOfACalibration, EachCheckOfTheReferenceMetTheBlockAsWarmAsItWasThen) {
  PastCalibration past = table3_calibration();
  PastCheck warm{{}, {past.touches.begin(), past.touches.begin() + calib::kCheckTouchCount}};
  warm.run.block_temperature = {.celsius = 40.0, .std_k = 0.1, .measured_at = {}, .source = "run"};
  PastCheck cold = warm;
  cold.run.block_temperature->celsius = 20.0;
  past.checks = {warm, cold};
  const Verification made = verification(RunKind::kCheck, past, up_by(0.0));
  const double expansion = edf().block.thermal_expansion_per_k.value();
  for (std::size_t face = 0; face < edf().block.faces.size(); ++face) {
    const double offset_m = edf().block.faces[face].plane.offset_m;
    EXPECT_NEAR(made.candidates[0].time.contact_planes[face].offset_m -
                    made.candidates[1].time.contact_planes[face].offset_m,
                20.0 * expansion * offset_m, 1e-9)
        << face;
  }
}

TEST(VerificationOfACalibration, TheCellsFileMayNameTheLimitOfAProof) {
  const PastCalibration past = table3_calibration();
  EXPECT_EQ(verification(RunKind::kProof, past, up_by(0.2)).proof_limits.rms_max_m,
            calib::ProofLimits().rms_max_m);
  Cell strict = with_block_moved(edf(), up_by(0.2));
  strict.acceptance.proof_rms_max_m = 20e-6;
  const auto made = verification_of(RunKind::kProof, past, strict, up_by(0.2));
  EXPECT_EQ(std::get<std::shared_ptr<const Verification>>(made)->proof_limits.rms_max_m, 20e-6);
}

TEST(VerificationRecipe, TouchesOnlyWhatItIsHeldAgainst) {
  const Recipe& best = with_plate().recipes.at("best");
  const Recipe proof = verification_recipe(with_plate(), best, RunKind::kProof);
  EXPECT_EQ(proof.name, "best");
  EXPECT_THAT(proof.faces, ElementsAre(0, 1, 2, 3)) << "the plate stays where it is";
  EXPECT_EQ(proof.held_out_per_face, 0);
  EXPECT_EQ(proof.reference_every, 0);
  EXPECT_EQ(verification_recipe(with_plate(), best, RunKind::kCheck).faces, best.faces);
  EXPECT_EQ(faces_of_first_solid(with_plate().block), proof.faces);
  Block bare = with_plate().block;
  bare.solids.clear();
  EXPECT_EQ(faces_of_first_solid(bare).size(), bare.faces.size());
}

TEST(VerificationStand, WhatIsUnderALiftedBlockIsKeptOutOf) {
  Verification lifted = verification(RunKind::kProof, table3_calibration(), up_by(0.3));
  const Cell there = with_stand(with_plate(), lifted);
  ASSERT_EQ(there.keep_out_boxes.size(), with_plate().keep_out_boxes.size() + 1);
  const calib::Box& stand = there.keep_out_boxes.back();
  EXPECT_NEAR(stand.min_m.y(), 0.0, 1e-9) << "the bottom of the cube; y points down";
  EXPECT_NEAR(stand.max_m.y(), 0.3, 1e-9);
  EXPECT_LT(stand.min_m.x(), -0.1);
  lifted.place.calibrated_from_block = Eigen::Translation3d(0.3, 0.0, 0.0) * Eigen::Isometry3d::Identity();
  EXPECT_EQ(with_stand(with_plate(), lifted).keep_out_boxes.size(), with_plate().keep_out_boxes.size())
      << "beside it";
}

}  // namespace
}  // namespace cell
