#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/uncertainty/uncertainty_budget.hpp"

namespace calib {

inline bool is_estimated(const LeastSquares& fit, int column) {
  return std::ranges::find(fit.arm_columns(), column) != fit.arm_columns().end();
}

/// What the budget calls the source of an effect beside rigid kinematics.
inline const char* source_name(NongeometricKind kind) {
  switch (kind) {
    case NongeometricKind::kCompliance:
      return "compliance";
    case NongeometricKind::kHarmonicCos:
    case NongeometricKind::kHarmonicSin:
    case NongeometricKind::kSecondCos:
    case NongeometricKind::kSecondSin:
      return "gear_harmonics";
    case NongeometricKind::kMass:
      return "masses";
    case NongeometricKind::kRippleCos:
    case NongeometricKind::kRippleSin:
      return "gears";
  }
  throw std::logic_error("source_name: no such kind");
}

/// Sums covariances of the unknowns: those of the arm by the name of their source, the variances of the
/// artefact as a whole.
class SourceSum {
 public:
  SourceSum(const std::vector<int>& columns, std::vector<UncertaintySource> sources)
      : columns_(columns), sources_(std::move(sources)) {}

  void add(const std::string& name, const Eigen::MatrixXd& of_unknowns) {
    ArmCovariance& covariance = source(name).covariance;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        covariance(columns_[i], columns_[j]) +=
            of_unknowns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
    const Eigen::VectorXd of_artefact =
        of_unknowns.diagonal().tail(of_unknowns.rows() - std::ssize(columns_));
    if (artefact_variance_.size() == 0) artefact_variance_.setZero(of_artefact.size());
    artefact_variance_ += of_artefact;
  }
  /// Adds to `total` what add() gave the first `count` sources, which is zero but for the given columns.
  void add_first_to(ArmCovariance& total, std::size_t count) const {
    for (std::size_t k = 0; k < count; ++k) {
      for (const int j : columns_) {
        for (const int i : columns_) total(i, j) += sources_[k].covariance(i, j);
      }
    }
  }
  UncertaintySource& source(const std::string& name) {
    const auto found = std::ranges::find_if(sources_, [&](const auto& s) { return s.name == name; });
    if (found != sources_.end()) return *found;
    return sources_.emplace_back(UncertaintySource{name, no_covariance()});
  }
  /// A source that is not there yet.
  void append(const std::string& name, const ArmCovariance& covariance) {
    sources_.push_back({name, covariance});
  }
  [[nodiscard]] const std::vector<UncertaintySource>& sources() const { return sources_; }
  [[nodiscard]] const Eigen::VectorXd& artefact_variance() const { return artefact_variance_; }
  std::vector<UncertaintySource> take() { return std::move(sources_); }

 private:
  const std::vector<int>& columns_;
  std::vector<UncertaintySource> sources_;
  Eigen::VectorXd artefact_variance_;
};

}  // namespace calib
