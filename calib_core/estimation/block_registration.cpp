#include "calib_core/estimation/block_registration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "calib_core/numerics/decompositions.hpp"

namespace calib {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Sine of alpha1 below which theta0 and theta1 cannot be separated.
constexpr double kSineParallel = 1e-9;
/// Lever that compares rotations of the block with translations in the rank check.
constexpr double kBlockSizeMetres = 0.075;
/// Smallest accepted singular value of the six rows: unit normals, rotations divided by kBlockSizeMetres.
constexpr double kRankMin = 0.05;
constexpr int kStepsMax = 50;
constexpr double kStepSmall = 1e-12;

double with_sign_of(double size, double other) { return other < 0.0 ? -size : size; }

std::string name_of(int face) { return face_name(static_cast<std::size_t>(face)); }

Eigen::Isometry3d moved_by(const Vector6& twist) {
  const Eigen::Vector3d turn = twist.tail<3>();
  const double angle = turn.norm();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  pose.translation() = twist.head<3>();
  return pose;
}

class RegistrationFit {
 public:
  explicit RegistrationFit(const BlockRegistrationProblem& problem) : problem_(problem) {
    const PreparedModel prepared = prepare(problem.nominal);
    for (const RegistrationTouch& touch : problem.touches) {
      chains_.push_back(forward_chain(prepared, touch.joints));
      planes_.push_back(contact_plane(problem.faces[static_cast<std::size_t>(touch.face)], problem.stylus));
    }
  }

  std::variant<BlockRegistration, BlockRegistrationRefusal> solve() {
    if (auto refusal = find_insufficient_data()) return *refusal;
    bool small = false;
    for (int step = 0; step < kStepsMax && !small; ++step) {
      linearise();
      const Vector6 twist = least_squares_solution(rows_, residuals_);
      if (!twist.allFinite()) break;
      old_from_new_ = old_from_new_ * moved_by(twist);
      small = twist.norm() < kStepSmall;
    }
    if (!small || Eigen::AngleAxisd(old_from_new_.linear()).angle() > kBlockTurnMaxRadians)
      return BlockRegistrationRefusal{
          "the touches fit no block that is turned by less than 20 degrees: faces were mixed up, or a touch "
          "was not on this block; touch the faces again in the requested order"};
    linearise();
    if (auto refusal = find_touch_off_face()) return *refusal;
    if (smallest_singular_value() < kRankMin)
      return BlockRegistrationRefusal{
          "the touches do not determine the block's position: spread them, three on one face, two on a side, "
          "one on "
          "an end"};
    return result();
  }

 private:
  [[nodiscard]] Eigen::Vector3d ball_m(std::size_t i) const {  // in the current R_-1
    return old_from_new_.inverse() * chains_[i].tip_in_block_m();
  }

  /// Weighted signed distances and their derivatives by a further motion of the block.
  void linearise() {
    const auto count = static_cast<Eigen::Index>(chains_.size());
    rows_.resize(count, 6);
    residuals_.resize(count);
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      const double weight = 1.0 / problem_.touches[i].std_m;
      const auto row = static_cast<Eigen::Index>(i);
      const Eigen::Vector3d point_m = ball_m(i);
      const Eigen::Vector3d normal = normal_at(planes_[i], point_m);
      rows_.row(row) << weight * normal.transpose(), weight * point_m.cross(normal).transpose();
      residuals_[row] = weight * signed_distance_m(planes_[i], old_from_new_.inverse() *
                                                                   chains_[i].block_from_frame.back());
    }
  }

  /// Checks that need no pose: the distances between touches do not depend on it.
  [[nodiscard]] std::optional<BlockRegistrationRefusal> find_insufficient_data() const {
    if (chains_.size() < 6) return BlockRegistrationRefusal{"six touches are needed"};
    std::map<int, std::vector<Eigen::Vector3d>> of_face;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      of_face[problem_.touches[i].face].push_back(chains_[i].tip_in_block_m());
    for (const auto& [face, points] : of_face) {
      if (points.size() < 2) continue;
      double length_m = 0.0, height_m = 0.0;
      for (const auto& a : points)
        for (const auto& b : points) length_m = std::max(length_m, (a - b).norm());
      for (const auto& a : points)
        for (const auto& b : points)
          for (const auto& c : points)
            height_m = std::max(height_m, (b - a).cross(c - a).norm() / std::max(length_m, 1e-9));
      if (length_m < kRegistrationSpreadMinMetres)
        return BlockRegistrationRefusal{"the touches on " + name_of(face) +
                                        " are too near to each other; touch it farther apart"};
      if (points.size() > 2 && height_m < kRegistrationSpreadMinMetres)
        return BlockRegistrationRefusal{"the touches on " + name_of(face) +
                                        " lie on one line; touch it in a triangle"};
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<BlockRegistrationRefusal> find_touch_off_face() const {
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      const Face& face = problem_.faces[static_cast<std::size_t>(problem_.touches[i].face)];
      const std::string which = "touch " + std::to_string(i + 1) + " on " + name_of(problem_.touches[i].face);
      const Eigen::Vector3d off_m = ball_m(i) - face.center_m;
      if (std::abs(off_m.dot(face.edge_u)) > face.half_extent_m.x() + kOffFaceMaxMetres ||
          std::abs(off_m.dot(face.edge_v())) > face.half_extent_m.y() + kOffFaceMaxMetres)
        return BlockRegistrationRefusal{which +
                                        " lies beside its face: faces were mixed up, or another thing was "
                                        "touched; touch the faces again in the requested order"};
      const Eigen::Vector3d stylus =
          old_from_new_.linear().transpose() * chains_[i].block_from_frame.back().linear().col(2);
      if (-stylus.dot(face.plane.outward) < std::cos(problem_.tilt_max_rad + kTiltMarginRadians))
        return BlockRegistrationRefusal{
            which +
            " is inclined to the normal of its face by more than the cell allows, or faces were "
            "mixed up; touch the faces again in the requested order"};
    }
    return std::nullopt;
  }

  [[nodiscard]] double smallest_singular_value() const {
    Eigen::MatrixXd unit = rows_;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      unit.row(static_cast<Eigen::Index>(i)) *= problem_.touches[i].std_m;
    unit.rightCols<3>() /= kBlockSizeMetres;
    return singular_values(unit).minCoeff();
  }

  [[nodiscard]] BlockRegistration result() const {
    BlockRegistration fit{.old_from_new = old_from_new_, .model = problem_.nominal};
    set_block_pose(fit.model, old_from_new_.inverse() * block_pose_of(problem_.nominal));
    const Eigen::MatrixXd inverse = pseudo_inverse(rows_);
    const Eigen::MatrixXd arm = weighted_arm_rows(fit.model);
    fit.covariance = inverse *
                     (Eigen::MatrixXd::Identity(rows_.rows(), rows_.rows()) + arm * arm.transpose()) *
                     inverse.transpose();
    double square_sum = 0.0;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      square_sum += std::pow(residuals_[static_cast<Eigen::Index>(i)] * problem_.touches[i].std_m, 2);
    fit.residual_rms_m = std::sqrt(square_sum / static_cast<double>(chains_.size()));
    set_deviations(fit);
    return fit;
  }

  /// Change of the weighted distances per standard deviation of each error of arm and tool.
  [[nodiscard]] Eigen::MatrixXd weighted_arm_rows(const KinematicModel& model) const {
    Eigen::MatrixXd rows(chains_.size(), kErrorParameterCount);
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      const Chain chain = forward_chain(model, problem_.touches[i].joints);
      rows.row(static_cast<Eigen::Index>(i)) =
          distance_derivatives(model, chain, planes_[i].outward).head<kErrorParameterCount>() /
          problem_.touches[i].std_m;
    }
    for (int column = 0; column < kErrorParameterCount; ++column) {
      const auto index = static_cast<std::size_t>(column);
      const bool is_pose = error_parameters()[index].group() == ParameterGroup::kBlockPose;
      rows.col(column) *= is_pose ? 0.0 : problem_.arm_errors[index].value_or(0.0);
    }
    return rows;
  }

  /// Converts the covariance of the block's motion to the six parameters of its pose. Where two of them have
  /// the same effect (parallel axes of frames 0 and 1), each takes half.
  static void set_deviations(BlockRegistration& fit) {
    std::vector<int> columns;
    for (int i = 0; i < kErrorParameterCount; ++i)
      if (error_parameters()[static_cast<std::size_t>(i)].group() == ParameterGroup::kBlockPose)
        columns.push_back(i);
    Eigen::MatrixXd twists(6, static_cast<Eigen::Index>(columns.size()));
    constexpr double kSmall = 1e-6;
    const Eigen::Isometry3d here = block_pose_of(fit.model);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      ErrorVector error = ErrorVector::Zero();
      error[columns[k]] = kSmall;
      const Eigen::Isometry3d move = block_pose_of(apply(fit.model, error)) * here.inverse();
      const Eigen::AngleAxisd turn(move.linear());
      twists.col(static_cast<Eigen::Index>(k)) << move.translation() / kSmall,
          turn.axis() * turn.angle() / kSmall;
    }
    const Eigen::MatrixXd to_parameters = pseudo_inverse(twists);
    const Eigen::MatrixXd covariance = to_parameters * fit.covariance * to_parameters.transpose();
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto index = static_cast<Eigen::Index>(k);
      fit.std_block_pose[static_cast<std::size_t>(columns[k])] = std::sqrt(covariance(index, index));
    }
  }

  const BlockRegistrationProblem& problem_;
  std::vector<Chain> chains_;
  std::vector<ContactSurface> planes_;
  Eigen::Isometry3d old_from_new_ = Eigen::Isometry3d::Identity();
  Eigen::MatrixXd rows_;
  Eigen::VectorXd residuals_;
};

}  // namespace

Eigen::Isometry3d block_pose_of(const KinematicModel& model) {
  return frame_transform(model.links[0]) * frame_transform(model.links[1]);
}

void set_block_pose(KinematicModel& model, const Eigen::Isometry3d& pose) {
  LinkParameters& base = model.links[0];
  LinkParameters& first = model.links[1];
  const Eigen::Matrix3d turn = pose.linear();
  const double sine = with_sign_of(std::hypot(turn(0, 2), turn(1, 2)), std::sin(first.alpha_rad));
  const double cosine = turn(2, 2);
  Eigen::Vector3d position = pose.translation();
  if (std::abs(sine) > kSineParallel) {
    base.theta_rad = std::atan2(turn(0, 2) / sine, -turn(1, 2) / sine);
    position = Eigen::AngleAxisd(-base.theta_rad, Eigen::Vector3d::UnitZ()) * position;
    first.r_m = -position.y() / sine;
    first.d_m = position.x();
  } else {  // parallel axes: r1 is kept, r0 takes the height
    const Eigen::Vector2d across = position.head<2>();
    const double sign = with_sign_of(1.0, first.d_m);
    first.d_m = sign * across.norm();
    base.theta_rad = std::atan2(sign * across.y(), sign * across.x());
  }
  first.alpha_rad = std::atan2(sine, cosine);
  first.beta_rad = 0.0;
  base.r_m = position.z() - cosine * first.r_m;
  const Eigen::Matrix3d rest = (Eigen::AngleAxisd(base.theta_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(first.alpha_rad, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix()
                                   .transpose() *
                               turn;
  first.theta_rad = std::atan2(rest(1, 0), rest(0, 0));
}

std::variant<BlockRegistration, BlockRegistrationRefusal> register_block(
    const BlockRegistrationProblem& problem) {
  return RegistrationFit(problem).solve();
}

}  // namespace calib
