#pragma once

#include <optional>
#include <vector>

#include "calib_core/identification/identification_result.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/run/fault_table.hpp"
#include "service/run/packml_state.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// What is known of a touch before its answer.
struct TouchHistory {
  int attempts = 0;                                 // answers to this touch that did not count
  std::optional<double> spread_m;                   // between the two contacts of the last of them
  std::optional<cs8::JointsMicrodeg> last_contact;  // of the run
};

/// The judgement of the answer to a touch.
struct TouchJudgement {
  enum class Next {
    kKeep,     // a measurement
    kAgain,    // none; the touch is made again without a person's word
    kFault,    // none; `fault` says why, `event` what becomes of the run
    kStopped,  // none: the arm was stopped on request
  };
  Next next = Next::kKeep;
  Fault fault;
  Event event = Event::kAbortFault;
  std::vector<Fault> warnings;
};

/// Touches are repeated without a person's answer at most this often.
inline constexpr int kRetriesMax = 2;

/// A search that ends this near to its start has touched something in front of the face.
inline constexpr double kEarlyContactMetres = 5e-4;

TouchJudgement judge_touch(const Cell& cell, const calib::PlannedTouch& planned,
                           const cs8::TouchResult& result, const TouchHistory& history);

/// Between the two contacts of a touch; nothing where one is made only.
std::optional<double> contact_spread_m(const Cell& cell, const cs8::TouchResult& result);

/// The first of the two contacts of a touch, as it is stored; nothing where one is made only.
std::optional<FirstContact> first_contact_in(const cs8::TouchResult& result);

/// The limit of the reference drift: the cell file's, else five standard deviations of the difference of two
/// touches.
double reference_drift_max_m(const Cell& cell);

/// Two contacts of one touch that agree: they differ by no more than five standard deviations.
double agreement_max_m(const Cell& cell);

/// A fault when the touches contradict the stylus radius of the probe file, or where it has a ball of a star.
std::optional<Fault> stylus_fault(const calib::IdentificationProblem& problem,
                                  const calib::IdentificationResult& result);

/// Faces whose touches fit worse than chance allows, at the end of a run.
std::optional<Fault> face_warning(const calib::IdentificationResult& result, double lack_of_fit_p_min);

/// Why a plan cannot be commanded at all: a touch without length, or with a joint that is not a number.
std::optional<Fault> plan_fault(const std::vector<calib::PlannedTouch>& touches);

}  // namespace cell
