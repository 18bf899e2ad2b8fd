#pragma once

#include <optional>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"
#include "service/store/run_store.hpp"

/// What a run touched more than once, from its store to its identification. A daemon and `touchcal identify`
/// go the same way, so that both give the same result to the last bit.
namespace cell {

/// When the touches of a run were made: seconds since the first of them by the clock of this machine, which
/// stamped them when their answers came.
struct TouchTimes {
  std::vector<std::optional<double>> touches_s;  // nothing where its stamp is no time
  std::vector<double> references_s;  // of all of them; empty where one is unknown, or they run backwards
};
TouchTimes times_of(const std::vector<StoredTouch>& touches, const std::vector<ReferenceTouch>& references);

/// Both contacts of a two-speed touch, when both were latched: one that was polled is late by up to 4 ms of
/// its speed, which is no noise of a touch.
std::optional<cs8::JointsMicrodeg> first_contact_of(const StoredTouch& touch);

/// `qualified`: of a qualification before the run. `faces_per_place`: as of to_touches().
calib::Repeats repeats_of(const std::vector<StoredTouch>& touches,
                          const std::vector<ReferenceTouch>& references,
                          const std::optional<calib::TouchNoise>& qualified = {}, int faces_per_place = 0);

/// Of several reference places, one after the other, the scatters count together, and so do the drifts, which
/// add up. Notes in a problem, whose artefact and declared noise must be set, what the repeats say: pure
/// error and drift. Heights are over the nominal faces by the nominal arm; reference touches count as
/// calib::counted_readings() does. A scatter of the reference touches that is too small to be noise is noted
/// as doubted, and says nothing.
void note_repeats(const calib::Repeats& repeats, calib::IdentificationProblem& problem);

}  // namespace cell
