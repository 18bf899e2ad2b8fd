#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/identification/monte_carlo.hpp"
#include "config/cell.hpp"
#include "service/documents/result_document.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

struct ResultContext {
  bool complete = true;               // every touch was made
  std::vector<std::string> warnings;  // of the touches file; those of identify() are in the result
  std::string conditions;             // as stored with the run; empty: those of the cell's files
  std::optional<calib::MonteCarloFigures> monte_carlo;  // where it was asked for
};

/// touchcal/result/1. `problem` is the input of the identification: rejected touches are numbers of its
/// touches, from 1. `identifiable_count` is the rank of the touches, also with a prior, with which every
/// error that is not excluded is identified.
ResultDocument result_of(const TipRegions& regions, const Recipe& recipe,
                         const calib::IdentificationProblem& problem,
                         const calib::IdentificationResult& result, const ResultContext& context);

/// The same as text.
std::string result_document(const TipRegions& regions, const Recipe& recipe,
                            const calib::IdentificationProblem& problem,
                            const calib::IdentificationResult& result, const ResultContext& context);

/// Sets what simulated calibrations say beside the linear figures.
void add_monte_carlo(const calib::MonteCarloFigures& figures, ResultDocument& document);

/// `tip_uncertainty` of a result and of a plan.
TipDocument tip_of(const Cell& cell, const TipPrediction& tip);

/// The distances of one role's touches, a plane at a time, along the outward normals.
std::vector<PlaneDistances> planes_of(const Cell& cell, const Recipe& recipe,
                                      const std::vector<calib::FaceDistances>& distances,
                                      calib::TouchRole role);

}  // namespace cell
