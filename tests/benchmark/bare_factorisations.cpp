#include "tests/benchmark/bare_factorisations.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>

#include "calib_core/observability/observation_matrix.hpp"

namespace bench {
namespace {

constexpr auto kFormulation = calib::Formulation::kSignedDistance;

/// Of a triangular factor: several times faster than its singular values, and exact enough to this condition.
double condition_number(const Eigen::MatrixXd& r) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(r.transpose() * r, Eigen::EigenvaluesOnly);
  return std::sqrt(squares.eigenvalues().maxCoeff() / squares.eigenvalues().minCoeff());
}

}  // namespace

Matrices matrices_of(const calib::KinematicModel& nominal,
                     const std::vector<calib::ContactSurface>& contact_planes,
                     std::vector<calib::Touch> touches, const calib::IdentificationResult& result) {
  Matrices matrices;
  calib::ErrorVector errors = calib::ErrorVector::Zero();
  const std::vector<int>& columns = result.identifiable.columns;
  for (std::size_t i = 0; i < result.iterations.size(); ++i) {
    const auto observation =
        calib::observe(calib::apply(nominal, errors), contact_planes, touches, kFormulation);
    Equations equations{.scaled = calib::select_columns(observation.matrix, columns),
                        .norms = {},
                        .output_error = observation.output_error};
    equations.norms = equations.scaled.colwise().norm();
    equations.scaled *= equations.norms.cwiseInverse().asDiagonal();
    const Eigen::VectorXd step = equations.scaled.householderQr().solve(equations.output_error);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto index = static_cast<Eigen::Index>(k);
      errors[columns[k]] += step[index] / equations.norms[index];
    }
    matrices.iterations.push_back(std::move(equations));
  }
  for (calib::Touch& touch : touches) {
    touch = calib::moved_onto_plane(nominal, contact_planes[static_cast<std::size_t>(touch.face)], touch);
  }
  matrices.choice = calib::observe(nominal, contact_planes, touches, kFormulation).matrix;
  return matrices;
}

double factorise(const Matrices& matrices) {
  double sum = Eigen::HouseholderQR<Eigen::MatrixXd>(matrices.choice).matrixQR()(0, 0);
  Eigen::MatrixXd r;
  for (const Equations& equations : matrices.iterations) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(equations.scaled);
    const Eigen::VectorXd step = qr.solve(equations.output_error);
    r = qr.matrixQR().topRows(equations.scaled.cols()).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd in_units = r * equations.norms.asDiagonal();
    sum += step[0] + condition_number(r) + condition_number(in_units);
  }
  const Eigen::MatrixXd inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(r.rows(), r.cols()));
  const Eigen::MatrixXd covariance = inverse * inverse.transpose();
  return sum + covariance.trace();
}

}  // namespace bench
