#include "tests/benchmark/ceres_identify.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <array>
#include <stdexcept>

#include "tests/benchmark/templated_kinematics.hpp"

namespace bench {
namespace {

struct Measured {
  const calib::KinematicModel& nominal;
  std::span<const calib::ContactSurface> contact_planes;
  const std::vector<int>& columns;
};

template <class T>
T signed_distance(const Measured& measured, const calib::Touch& touch, const Vector3<T>& tip_m) {
  const calib::ContactSurface& plane = measured.contact_planes[static_cast<std::size_t>(touch.face)];
  return plane.outward.x() * tip_m.x() + plane.outward.y() * tip_m.y() + plane.outward.z() * tip_m.z() -
         plane.offset_m;
}

/// kUsual: one touch.
struct SignedDistance {
  const Measured& measured;
  const calib::Touch& touch;

  template <class T>
  bool operator()(const T* errors, T* residual) const {
    const Links<T> links = links_with_errors(measured.nominal, measured.columns, errors);
    *residual = signed_distance(measured, touch, tip_by_frames(links, touch.joints));
    return true;
  }
};

/// kTuned: all touches.
struct SignedDistances {
  const Measured& measured;
  std::span<const calib::Touch> touches;

  template <class T>
  [[gnu::flatten]] bool operator()(const T* errors, T* residuals) const {
    const auto links = prepare(links_with_errors(measured.nominal, measured.columns, errors));
    for (const calib::Touch& touch : touches) {
      *residuals++ = signed_distance(measured, touch, tip_by_point(links, touch.joints));
    }
    return true;
  }
};

/// kAnalytic: all touches.
class DistancesWithDerivatives : public ceres::CostFunction {
 public:
  DistancesWithDerivatives(const Measured& measured, std::span<const calib::Touch> touches)
      : measured_(measured), touches_(touches) {
    set_num_residuals(static_cast<int>(touches.size()));
    mutable_parameter_block_sizes()->push_back(kIdentifiedCount);
    for (const calib::Touch& touch : touches)
      joints_.push_back(calib::prepare(measured.nominal.gains, touch.joints));
  }

  bool Evaluate(double const* const* errors, double* residuals, double** jacobians) const override {
    calib::ErrorVector all = calib::ErrorVector::Zero();
    for (std::size_t k = 0; k < measured_.columns.size(); ++k) all[measured_.columns[k]] = errors[0][k];
    const calib::PreparedModel arm = calib::prepare(calib::apply(measured_.nominal, all));
    double* slope = jacobians == nullptr ? nullptr : jacobians[0];
    for (std::size_t i = 0; i < touches_.size(); ++i) {
      const calib::Chain chain = calib::forward_chain(arm, joints_[i]);
      *residuals++ = signed_distance(measured_, touches_[i], Vector3<double>(chain.tip_in_block_m()));
      if (slope == nullptr) continue;
      const auto face = static_cast<std::size_t>(touches_[i].face);
      const calib::ArmRow row =
          calib::distance_derivatives(arm, chain, measured_.contact_planes[face].outward);
      for (const int column : measured_.columns) *slope++ = row[column];
    }
    return true;
  }

 private:
  const Measured& measured_;
  std::span<const calib::Touch> touches_;
  std::vector<calib::PreparedJoints> joints_;
};

void add_residuals(ceres::Problem& problem, const Measured& measured, std::span<const calib::Touch> touches,
                   CeresForm form, double* errors) {
  if (form == CeresForm::kTuned) {
    using Cost = ceres::AutoDiffCostFunction<SignedDistances, ceres::DYNAMIC, kIdentifiedCount>;
    problem.AddResidualBlock(
        new Cost(new SignedDistances{measured, touches}, static_cast<int>(touches.size())), nullptr, errors);
    return;
  }
  if (form == CeresForm::kAnalytic) {
    problem.AddResidualBlock(new DistancesWithDerivatives(measured, touches), nullptr, errors);
    return;
  }
  using Cost = ceres::AutoDiffCostFunction<SignedDistance, 1, kIdentifiedCount>;
  for (const calib::Touch& touch : touches) {
    problem.AddResidualBlock(new Cost(new SignedDistance{measured, touch}), nullptr, errors);
  }
}

ceres::Solver::Options solver_options(CeresForm form) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  if (form != CeresForm::kUsual) options.initial_trust_region_radius = 1e12;
  return options;
}

/// DENSE_SVD is faster here than the default, a sparse QR.
Eigen::MatrixXd covariance_of(ceres::Problem& problem, const double* errors) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  if (!covariance.Compute(std::vector<std::pair<const double*, const double*>>{{errors, errors}}, &problem)) {
    throw std::runtime_error("Ceres finds no covariance");
  }
  Eigen::Matrix<double, kIdentifiedCount, kIdentifiedCount, Eigen::RowMajor> block;
  covariance.GetCovarianceBlock(errors, errors, block.data());
  return block;
}

}  // namespace

CeresResult ceres_identify(const calib::KinematicModel& nominal,
                           std::span<const calib::ContactSurface> contact_planes,
                           std::span<const calib::Touch> touches, const std::vector<int>& columns,
                           CeresForm form, Covariance covariance) {
  if (columns.size() != kIdentifiedCount) throw std::logic_error("compiled for 25 parameters");
  const Measured measured{nominal, contact_planes, columns};
  std::array<double, kIdentifiedCount> errors{};
  ceres::Problem problem;
  add_residuals(problem, measured, touches, form, errors.data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(form), &problem, &summary);

  CeresResult result{.converged = summary.termination_type == ceres::CONVERGENCE,
                     .iterations = static_cast<int>(summary.iterations.size()) - 1};  // [0] is the start
  for (std::size_t k = 0; k < errors.size(); ++k) result.errors[columns[k]] = errors[k];
  if (covariance == Covariance::kYes) result.covariance = covariance_of(problem, errors.data());
  return result;
}

}  // namespace bench
