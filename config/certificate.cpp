#include "config/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/distributions.hpp"
#include "config/block_file.hpp"

namespace cell {
namespace {

/// Directions of the statements that determine less than this of the offsets determine nothing.
constexpr double kDeterminedMin = 1e-9;
/// A statement of which less than this is left by the others is contradicted by none.
constexpr double kRedundantMin = 1e-6;

/// Statements on the errors of the offsets, each divided by its deviation: first one on each offset, then the
/// lengths.
struct Statements {
  Eigen::MatrixXd rows;
  Eigen::VectorXd values;
  std::vector<double> std_m;
};

/// How a length follows from the offsets of its two faces: |offset_a + sign_b offset_b|.
double sign_of_second(const Block& block, const calib::KnownLength& length) {
  const auto outward = [&](int face) { return block.faces[static_cast<std::size_t>(face)].plane.outward; };
  return outward(length.faces[0]).dot(outward(length.faces[1])) > 0.0 ? -1.0 : 1.0;
}

Statements statements_of(const Block& block) {
  const auto faces = static_cast<Eigen::Index>(block.faces.size());
  const auto lengths = static_cast<Eigen::Index>(block.lengths.size());
  Statements all{Eigen::MatrixXd::Zero(faces + lengths, faces), Eigen::VectorXd::Zero(faces + lengths), {}};
  std::vector<bool> is_exact;
  for (Eigen::Index face = 0; face < faces; ++face) {
    const calib::FaceUncertainty& known = block.face_uncertainties[static_cast<std::size_t>(face)];
    is_exact.push_back(!known.estimated && known.std_offset_m <= 0.0);
    all.std_m.push_back(known.std_offset_m);
    if (!known.estimated && !is_exact.back()) all.rows(face, face) = 1.0 / known.std_offset_m;
  }
  for (Eigen::Index k = 0; k < lengths; ++k) {
    const calib::KnownLength& length = block.lengths[static_cast<std::size_t>(k)];
    const double sign_b = sign_of_second(block, length);
    const auto offset_m = [&](int face) {
      return block.faces[static_cast<std::size_t>(face)].plane.offset_m;
    };
    const double drawn_m = offset_m(length.faces[0]) + sign_b * offset_m(length.faces[1]);
    const double sign = drawn_m < 0.0 ? -1.0 : 1.0;
    const double std_m = std::hypot(length.std_m, kFaceCenterErrorMaxMetres);  // figures are rounded
    all.std_m.push_back(std_m);
    all.values[faces + k] = (length.value_m - std::abs(drawn_m)) / std_m;
    for (const auto& [face, share] : {std::pair(length.faces[0], sign), {length.faces[1], sign * sign_b}}) {
      if (!is_exact[static_cast<std::size_t>(face)]) all.rows(faces + k, face) = share / std_m;
    }
  }
  return all;
}

/// The projection onto what no offsets explain: 1 - rows * pseudo-inverse of rows.
Eigen::MatrixXd unexplained(const Statements& all) {
  Eigen::MatrixXd columns = all.rows;
  for (auto column : columns.colwise()) {
    if (const double size = column.norm(); size > 0.0) column /= size;
  }
  calib::SymmetricEigen eigen;
  eigen.compute(columns * columns.transpose());
  Eigen::MatrixXd left = Eigen::MatrixXd::Identity(columns.rows(), columns.rows());
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    if (eigen.values()[i] > kDeterminedMin)
      left -= eigen.vectors().col(i) * eigen.vectors().col(i).transpose();
  }
  // No statement stands on the offset of an exact or an estimated face.
  for (Eigen::Index face = 0; face < columns.cols(); ++face) {
    if (all.rows.row(face).isZero(0.0)) left.row(face).setZero();
  }
  return left;
}

}  // namespace

std::optional<ContradictedLength> find_contradicted_length(const Block& block) {
  if (block.lengths.empty()) return std::nullopt;
  const Statements all = statements_of(block);
  const Eigen::MatrixXd left = unexplained(all);
  const Eigen::VectorXd misfit = left * all.values;
  const int degrees = static_cast<int>(std::lround(left.trace()));
  if (degrees < 1) return std::nullopt;
  ContradictedLength found{.chi_square = misfit.squaredNorm(), .degrees = degrees};
  if (calib::chi_square_survival(found.chi_square, degrees) >= kCertificateChanceMin) return std::nullopt;
  double most = 0.0;
  const auto faces = static_cast<Eigen::Index>(block.faces.size());
  for (Eigen::Index row = faces; row < misfit.size(); ++row) {
    const double redundancy = left(row, row);
    if (redundancy < kRedundantMin) continue;
    const double score = std::abs(misfit[row]) / std::sqrt(redundancy);
    if (score <= most) continue;
    most = score;
    found.length = static_cast<std::size_t>(row - faces);
    found.off_m = std::abs(misfit[row]) / redundancy * all.std_m[static_cast<std::size_t>(row)];
  }
  return found;
}

}  // namespace cell
