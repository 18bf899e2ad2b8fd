// The library touchcal_abs with the numbers of an arm, called by an application on the simulated controller.
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "config/read_config.hpp"
#include "service/exports/correction_library.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "sim_controller/val3_controller.hpp"
#include "sim_controller/val3_units.hpp"
#include "tests/sim_controller/val3/files/project_folder.hpp"

namespace val3 {
namespace {

using calib::CompensatedTarget;
using calib::CompensationReason;
using calib::CompensationStatus;

constexpr double kFlangeMetres = 0.1;
constexpr double kMicrometre = 1e-6;

const cell::Cell& demo() {
  static const cell::Cell cell = cell::read_cell(TOUCHCAL_SOURCE_DIR "/config/cells/demo/cell.json");
  return cell;
}

/// Errors of all parameters, joints that gravity bends, uneven gears.
calib::KinematicModel calibrated_arm() {
  constexpr double kErrorMax = 0.003;  // mm and mrad of a bad arm
  calib::UniformChance chance(11);
  calib::ErrorVector errors;
  for (double& error : errors) error = kErrorMax * (2.0 * chance() - 1.0);
  calib::KinematicModel model = calib::apply(demo().arm.model, errors);
  model.compliance_rad_per_nm = {0.0, 0.8e-6, 2.2e-6, 3e-6, 5e-6, 8e-6};
  for (std::size_t joint = 0; joint < calib::kJointCount; ++joint)
    model.harmonics_rad[joint] = {4e-5 * static_cast<double>(joint), -7e-5};
  return model;
}

cell::CorrectionLibrary numbers() {
  return {.arms = {.nominal = demo().arm.model,
                   .calibrated = calibrated_arm(),
                   .joint_ranges = demo().arm.joint_ranges,
                   .covariance = {}},
          .wrist_to_flange_m = kFlangeMetres,
          .serial = demo().arm_serial.value(),
          .model = std::string(64, 'a'),
          .warmth = "as warm as at the calibration",
          .from = 20261101,
          .valid_until = 20261231};
}

const Trsf kGripper{.x = 30.0, .y = -20.0, .z = 150.0, .rx = 10.0, .ry = 25.0, .rz = -40.0};
const Trsf kPallet{.x = 400.0, .y = -300.0, .z = -200.0, .rx = 3.0, .ry = -7.0, .rz = 65.0};

calib::CompensationTool gripper() {
  const Eigen::Translation3d flange(0.0, 0.0, kFlangeMetres);
  return calib::drawn_tool(flange * sim::pose_from_val3(kGripper));
}

std::string attributes(const Trsf& t) {
  return fmt::format(R"(x="{:.12f}" y="{:.12f}" z="{:.12f}" rx="{:.12f}" ry="{:.12f}" rz="{:.12f}")", t.x,
                     t.y, t.z, t.rx, t.ry, t.rz);
}

struct Meant {
  calib::JointVector near;
  bool on_pallet = false;  // given in that frame, else in world
  std::string config = R"(shoulder="ssame" elbow="esame" wrist="wsame")";
};

/// What the application got of one target.
struct Got {
  int status = 0;
  calib::JointVector joints;                 // of the corrected point, near to the joints that were given
  calib::JointVector joints_from_elsewhere;  // ... to the same with the wrist turned over
};

/// An application that hands each target to the library, on a controller of its own.
class LibraryRun {
 public:
  explicit LibraryRun(std::vector<Meant> meant) : meant_(std::move(meant)) {
    std::filesystem::copy(TOUCHCAL_SOURCE_DIR "/cs8_protocol/val3/touchcal_abs",
                          folder_.path() / "touchcal_abs");
  }
  LibraryRun& with(const cell::CorrectionLibrary& library) {
    folder_.write("touchcal_abs/touchcal_abs.dtx", cell::correction_library_data(library));
    return *this;
  }

  std::vector<Got> on(const calib::KinematicModel& controllers_arm = demo().arm.model) {
    write_application(kStart);
    cell::Cell cell = demo();
    cell.arm.model = controllers_arm;
    std::vector<Got> got;
    run(cell, [&](sim::Val3Controller& controller) {
      for (const std::string& told : controller.tick().told) ADD_FAILURE() << told;
      if (controller.machine().number("nDone") == 0.0) return false;
      said_ = controller.machine().text("sSaid");
      const auto joints = [&](std::size_t first) {
        Joint joints_deg{};
        for (std::size_t j = 0; j < joints_deg.size(); ++j)
          joints_deg[j] = controller.machine().number("nJoint", first + j);
        return sim::joints_from_val3(joints_deg);
      };
      for (std::size_t i = 0; i < meant_.size(); ++i)
        got.push_back({.status = static_cast<int>(controller.machine().number("nStatus", i)),
                       .joints = joints(12 * i),
                       .joints_from_elsewhere = joints(12 * i + 6)});
      return true;
    });
    return got;
  }
  /// The status that a caller sees where a point without a father ends the task within the library.
  int status_after_an_error() {
    write_application("call abs:correct(l_pOut,tGrip,jNear[0],l_pOut,nStatus[0])\nnDone=1\n");
    int status = 0;
    run(demo(), [&](sim::Val3Controller& controller) {
      const bool has_failed = !controller.tick().told.empty();
      EXPECT_EQ(controller.machine().number("nDone"), 0.0);
      status = static_cast<int>(controller.machine().number("nStatus"));
      return has_failed;
    });
    return status;
  }
  /// What statusText says of the first target.
  [[nodiscard]] const std::string& said() const { return said_; }

 private:
  /// Each target by the library, then the joints of what came back: near to those that were given, and to the
  /// same with the wrist turned over.
  static constexpr const char* kStart =
      "for l_n=0 to size(pMeant)-1\n"
      "call abs:correct(pMeant[l_n],tGrip,jNear[l_n],l_pOut,nStatus[l_n])\n"
      "pointToJoint(tGrip,jNear[l_n],l_pOut,l_jOut)\n"
      "nJoint[12*l_n]=l_jOut.j1\nnJoint[12*l_n+1]=l_jOut.j2\nnJoint[12*l_n+2]=l_jOut.j3\n"
      "nJoint[12*l_n+3]=l_jOut.j4\nnJoint[12*l_n+4]=l_jOut.j5\nnJoint[12*l_n+5]=l_jOut.j6\n"
      "l_jOut=jNear[l_n]\nl_jOut.j5=-l_jOut.j5\n"
      "pointToJoint(tGrip,l_jOut,l_pOut,l_jOut)\n"
      "nJoint[12*l_n+6]=l_jOut.j1\nnJoint[12*l_n+7]=l_jOut.j2\nnJoint[12*l_n+8]=l_jOut.j3\n"
      "nJoint[12*l_n+9]=l_jOut.j4\nnJoint[12*l_n+10]=l_jOut.j5\nnJoint[12*l_n+11]=l_jOut.j6\n"
      "endFor\n"
      "call abs:statusText(nStatus[0],sSaid)\nnDone=1\n";

  /// On a controller of that cell, until `look` at it after a tick has seen enough.
  template <class Look>
  void run(const cell::Cell& cell, const Look& look) {
    ReadApplication read = folder_.read();
    resolve(read.application, read.findings);
    const auto today = std::chrono::sys_days(std::chrono::year(2026) / 11 / 29);
    sim::Val3Controller controller(sim::make_plant(cell, calib::ErrorVector::Zero()), read.application,
                                   {.system = {.date = today}}, read.findings);
    for (const Finding& found : read.findings)
      EXPECT_NE(found.severity, Severity::kError)
          << found.at.file << ':' << found.at.line << ": " << found.what;
    constexpr int kTicksMax = 2'000;
    int tick = 0;
    while (tick < kTicksMax && !look(controller)) ++tick;
    EXPECT_LT(tick, kTicksMax);
  }
  static std::string data(const std::string& name, const std::string& type,
                          const std::vector<std::string>& values) {
    std::string text =
        fmt::format(R"(<Data name="{}" access="private" xsi:type="array" type="{}" size="{}">)", name, type,
                    values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      text += fmt::format(R"(<Value key="{}" {} />)", i, values[i]);
    return text + "</Data>\n";
  }
  void write_application(const std::string& start) {
    const calib::Compensation nominal(numbers().arms);
    std::vector<std::string> points, near;
    for (const Meant& one : meant_) {
      const Eigen::Isometry3d pose = nominal.nominal_world_from_tool(gripper(), one.near);
      const Eigen::Isometry3d in_father =
          one.on_pallet ? sim::pose_from_val3(kPallet).inverse() * pose : pose;
      points.push_back(fmt::format(R"({} {} fatherId="{}[0]")", attributes(sim::val3_from_pose(in_father)),
                                   one.config, one.on_pallet ? "fPallet" : "world"));
      const Joint j = sim::val3_from_joints(one.near);
      near.push_back(
          fmt::format(R"(j1="{:.12f}" j2="{:.12f}" j3="{:.12f}" j4="{:.12f}" j5="{:.12f}" j6="{:.12f}")",
                      j[0], j[1], j[2], j[3], j[4], j[5]));
    }
    const std::vector<std::string> nothing(meant_.size(), "value=\"0\""),
        twelve(12 * meant_.size(), "value=\"0\"");
    folder_.small(
        data("tGrip", "tool", {attributes(kGripper) + R"( fatherId="flange[0]")"}) +
            data("fPallet", "frame", {attributes(kPallet) + R"( fatherId="world[0]")"}) +
            data("pMeant", "pointRx", points) + data("jNear", "jointRx", near) +
            data("nStatus", "num", nothing) + data("nJoint", "num", twelve) +
            data("nDone", "num", {"value=\"0\""}) + data("sSaid", "string", {"value=\"\""}),
        R"(<Libraries><Library alias="abs" path="Disk://touchcal_abs/touchcal_abs.pjx" autoload="true"/></Libraries>)");
    folder_.program("app/start.pgx", start,
                    R"(<Locals><Local name="l_n" type="num" xsi:type="array" size="1"/>)"
                    R"(<Local name="l_pOut" type="pointRx" xsi:type="array" size="1"/>)"
                    R"(<Local name="l_jOut" type="jointRx" xsi:type="array" size="1"/></Locals>)"
                    "\n");
  }

  std::vector<Meant> meant_;
  ProjectFolder folder_;
  std::string said_;
};

std::vector<Meant> spread_targets(int count) {
  std::vector<Meant> meant;
  for (int i = 1; i <= count; ++i)
    meant.push_back({.near = calib::halton_posture(i, demo().arm.joint_ranges), .on_pallet = i % 2 == 0});
  return meant;
}

calib::JointVector bent(double joint3_deg, double joint5_deg) {
  calib::JointVector joints;
  joints << 20.0, -30.0, joint3_deg, 15.0, joint5_deg, 40.0;
  return joints * calib::kRadiansPerDegree;
}

/// As the library would say it; nothing where it has several words for it.
std::optional<int> status_of(const CompensatedTarget& target) {
  switch (target.reason) {
    case CompensationReason::kNone:
      return 0;
    case CompensationReason::kStraightWrist:
      return target.status == CompensationStatus::kWarned ? 1 : -6;
    case CompensationReason::kStretchedElbow:
      return target.status == CompensationStatus::kWarned ? 1 : -7;
    default:
      return std::nullopt;
  }
}

TEST(AbsLibrary, AgreesWithCompensateToAMicrometre) {
  const std::vector<Meant> meant = spread_targets(400);
  const std::vector<Got> got = LibraryRun(meant).with(numbers()).on();
  const calib::Compensation compensation(numbers().arms);
  int compared = 0;
  double worst_m = 0.0, moved_m = 0.0;
  for (std::size_t i = 0; i < meant.size(); ++i) {
    const CompensatedTarget wanted = compensation.at_joints(gripper(), meant[i].near);
    if (const auto status = status_of(wanted)) {
      EXPECT_EQ(got[i].status, *status) << i;
    } else {
      EXPECT_LT(got[i].status, 0) << i;
    }
    if (!wanted.joints) continue;
    ++compared;
    const Eigen::Isometry3d apart =
        compensation.calibrated_world_from_tool(gripper(), *wanted.joints).inverse() *
        compensation.calibrated_world_from_tool(gripper(), got[i].joints);
    worst_m = std::max(worst_m, apart.translation().norm());
    EXPECT_LT(apart.translation().norm(), kMicrometre)
        << i << ", joint 5 at " << calib::degrees_from_radians(meant[i].near[4]);
    EXPECT_LT(Eigen::AngleAxisd(apart.linear()).angle(), kMicrometre) << i;
    moved_m = std::max(moved_m, *wanted.moved_m);
  }
  EXPECT_GT(compared, 300);
  EXPECT_GT(moved_m, 0.005) << "there is something to correct";
  fmt::print(
      "touchcal_abs and compensate: {} targets, at most {:.4f} um apart, corrected by up to {:.1f} mm\n",
      compared, worst_m / kMicrometre, 1e3 * moved_m);
}

TEST(AbsLibrary, RefusesNearALostDirectionAndSaysThatItIsNear) {
  struct Row {
    double joint3_deg, joint5_deg;
    int status;
  };
  for (const Row& row : {Row{60.0, 1.5, -6}, Row{60.0, -1.5, -6}, Row{3.5, 40.0, -7}, Row{60.0, 3.0, 1},
                         Row{-6.5, 40.0, 1}, Row{60.0, 40.0, 0}}) {
    const std::vector<Got> got =
        LibraryRun({{.near = bent(row.joint3_deg, row.joint5_deg)}}).with(numbers()).on();
    EXPECT_EQ(got.at(0).status, row.status) << row.joint3_deg << ", " << row.joint5_deg;
  }
}

/// Joints at which nothing is changed, as far as a controller's numbers go.
void expect_unchanged(const Got& got, const calib::JointVector& meant) {
  EXPECT_LT((got.joints - meant).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(AbsLibrary, OfAnotherArmCorrectsNothing) {
  LibraryRun run({{.near = bent(60.0, 40.0)}});
  cell::CorrectionLibrary other = numbers();
  other.serial = "F10_000000_A_01";
  const std::vector<Got> got = run.with(other).on();
  EXPECT_EQ(got.at(0).status, -2);
  EXPECT_EQ(run.said(), "the numbers are of another arm than " + demo().arm_serial.value());
  expect_unchanged(got[0], bent(60.0, 40.0));
}

TEST(AbsLibrary, CountsFromItsFirstDayToItsLast) {
  struct Row {
    int from, until, status;
  };
  for (const Row& row :
       {Row{20261101, 20261129, 0}, Row{20261101, 20261128, -3}, Row{20261129, 0, 0}, Row{20261130, 0, -3}}) {
    cell::CorrectionLibrary dated = numbers();
    dated.from = row.from;
    dated.valid_until = row.until;
    const std::vector<Got> got = LibraryRun({{.near = bent(60.0, 40.0)}}).with(dated).on();
    EXPECT_EQ(got.at(0).status, row.status) << row.from << " to " << row.until;
    if (row.status < 0) expect_unchanged(got[0], bent(60.0, 40.0));
  }
}

TEST(AbsLibrary, NamesThePostureInWhichAPointIsRight) {
  // With the wrist the other way round the arm errs otherwise.
  const calib::JointVector near = bent(60.0, 40.0);
  for (const char* config : {R"(shoulder="ssame" elbow="esame" wrist="wsame")",
                             R"(shoulder="sfree" elbow="efree" wrist="wfree")"}) {
    LibraryRun run({{.near = near, .config = config}});
    const std::vector<Got> got = run.with(numbers()).on();
    EXPECT_EQ(got.at(0).status, 0);
    const calib::Compensation compensation(numbers().arms);
    const auto wanted = compensation.at_joints(gripper(), near);
    EXPECT_LT((got[0].joints - *wanted.joints).cwiseAbs().maxCoeff(), 1e-8) << "asked from " << config;
    EXPECT_LT((got[0].joints_from_elsewhere - *wanted.joints).cwiseAbs().maxCoeff(), 1e-8)
        << "asked from elsewhere";
  }
}

TEST(AbsLibrary, EndedByAnErrorSaysThatItIsNotFinished) {
  LibraryRun run({{.near = bent(60.0, 40.0)}});
  run.with(numbers());
  EXPECT_EQ(run.status_after_an_error(), -11);
}

TEST(AbsLibrary, AsItIsShippedCorrectsNothing) {
  LibraryRun run({{.near = bent(60.0, 40.0)}});
  const std::vector<Got> got = run.on();
  EXPECT_EQ(got.at(0).status, -1);
  EXPECT_EQ(run.said(), "no numbers yet: put touchcal_abs.dtx here");
  expect_unchanged(got[0], bent(60.0, 40.0));
}

TEST(AbsLibrary, OnAControllerThatHasAModelOfItsOwnCorrectsNothing) {
  calib::KinematicModel longer = demo().arm.model;
  longer.links[4].r_m += 1e-4;
  calib::KinematicModel turned = demo().arm.model;
  turned.links[5].theta_rad += 3e-5;
  for (const calib::KinematicModel& own : {longer, turned}) {
    const std::vector<Got> got = LibraryRun({{.near = bent(60.0, 40.0)}}).with(numbers()).on(own);
    EXPECT_EQ(got.at(0).status, -4);
  }
}

TEST(AbsLibrary, WithoutAPostureAtThePointSaysSo) {
  calib::JointVector out = bent(60.0, 40.0);
  out[1] = demo().arm.joint_ranges.upper[1] + calib::radians_from_degrees(1.0);
  EXPECT_EQ(LibraryRun({{.near = out}}).with(numbers()).on().at(0).status, -5);
}

}  // namespace
}  // namespace val3
