#include "service/documents/words.hpp"

namespace cell {

std::string_view word_of(calib::TouchRole role) {
  switch (role) {
    case calib::TouchRole::kFit:
      return "fit";
    case calib::TouchRole::kHeldOut:
      return "held_out";
    case calib::TouchRole::kProof:
      return "proof";
  }
  return "";
}

std::string_view word_of(calib::RejectionReason reason) {
  switch (reason) {
    case calib::RejectionReason::kOutlier:
      return "outlier";
    case calib::RejectionReason::kWrongFace:
      return "wrong_plane";
  }
  return "";
}

std::string_view word_of(calib::ParameterStatus status) {
  switch (status) {
    case calib::ParameterStatus::kIdentified:
      return "identified";
    case calib::ParameterStatus::kGrouped:
      return "grouped";
    case calib::ParameterStatus::kNoEffect:
      return "no_effect";
    case calib::ParameterStatus::kExcluded:
      return "excluded";
    case calib::ParameterStatus::kWeak:
      return "weak";
  }
  return "";
}

std::string_view word_of(ArtefactStatus status) {
  switch (status) {
    case ArtefactStatus::kIdentified:
      return "identified";
    case ArtefactStatus::kPrior:
      return "prior";
  }
  return "";
}

std::string_view word_of(TouchUse use) {
  switch (use) {
    case TouchUse::kUsed:
      return "used";
    case TouchUse::kRejected:
      return "rejected";
  }
  return "";
}

std::string_view word_of(calib::CompensationStatus status) {
  switch (status) {
    case calib::CompensationStatus::kOk:
      return "ok";
    case calib::CompensationStatus::kWarned:
      return "warned";
    case calib::CompensationStatus::kRefused:
      return "refused";
  }
  return "";
}

}  // namespace cell
