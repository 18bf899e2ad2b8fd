#pragma once

#include <array>
#include <string_view>

#include "calib_core/compensation/compensation_status.hpp"
#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/observability/identifiability.hpp"
#include "service/run/hand_guide.hpp"
#include "service/run/packml_state.hpp"
#include "service/store/run_outcome.hpp"

/// The enumerations of the documents: `word_of` gives the word that a document writes, `kAllOf` the values
/// among which a reader looks for a word.
namespace cell {

/// What the fit made of a touch.
enum class TouchUse { kUsed, kRejected };

/// What the touches say of a parameter of block, ball or probe.
enum class ArtefactStatus {
  kIdentified,
  kPrior,  // they add little to what was declared
};

inline std::string_view word_of(State state) { return state_name(state); }
inline std::string_view word_of(Verdict verdict) { return verdict_name(verdict); }
inline std::string_view word_of(RunOutcome outcome) { return run_outcome_name(outcome); }
inline std::string_view word_of(HandActivity activity) { return hand_activity_name(activity); }
inline std::string_view word_of(HandStep step) { return hand_step_name(step); }
std::string_view word_of(calib::TouchRole role);             // "held_out"
std::string_view word_of(calib::RejectionReason reason);     // "wrong_plane"
std::string_view word_of(calib::ParameterStatus status);     // "no_effect"
std::string_view word_of(ArtefactStatus status);             // "prior"
std::string_view word_of(TouchUse use);                      // "used"
std::string_view word_of(calib::CompensationStatus status);  // "warned"

template <class Enumeration>
inline constexpr std::array<Enumeration, 0> kAllOf{};
template <>
inline constexpr std::array kAllOf<State>{
    State::kStopped,    State::kResetting, State::kIdle,         State::kStarting, State::kExecute,
    State::kCompleting, State::kComplete,  State::kHolding,      State::kHeld,     State::kUnholding,
    State::kSuspending, State::kSuspended, State::kUnsuspending, State::kStopping, State::kAborting,
    State::kAborted,    State::kClearing};
template <>
inline constexpr auto kAllOf<Verdict> = kVerdicts;
template <>
inline constexpr auto kAllOf<RunOutcome> = kRunOutcomes;
template <>
inline constexpr std::array kAllOf<HandActivity>{HandActivity::kLocate, HandActivity::kGuided,
                                                 HandActivity::kTool};
template <>
inline constexpr std::array kAllOf<HandStep>{HandStep::kTouch, HandStep::kUndo, HandStep::kPass,
                                             HandStep::kPassing};
template <>
inline constexpr std::array kAllOf<calib::TouchRole>{calib::TouchRole::kFit, calib::TouchRole::kHeldOut,
                                                     calib::TouchRole::kProof};
template <>
inline constexpr std::array kAllOf<calib::RejectionReason>{calib::RejectionReason::kOutlier,
                                                           calib::RejectionReason::kWrongFace};
template <>
inline constexpr std::array kAllOf<calib::ParameterStatus>{
    calib::ParameterStatus::kIdentified, calib::ParameterStatus::kGrouped, calib::ParameterStatus::kNoEffect,
    calib::ParameterStatus::kExcluded, calib::ParameterStatus::kWeak};
template <>
inline constexpr std::array kAllOf<ArtefactStatus>{ArtefactStatus::kIdentified, ArtefactStatus::kPrior};
template <>
inline constexpr std::array kAllOf<TouchUse>{TouchUse::kUsed, TouchUse::kRejected};
template <>
inline constexpr std::array kAllOf<calib::CompensationStatus>{
    calib::CompensationStatus::kOk, calib::CompensationStatus::kWarned, calib::CompensationStatus::kRefused};

}  // namespace cell
