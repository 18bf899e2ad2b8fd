// Points, frames, tools and joints (manual 6, pages 107 to 137).
#include <Eigen/Geometry>
#include <cmath>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/motion.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

/// Points of setFrame nearer than this to one another, or to the x axis, make no frame. The manual gives no
/// limit.
constexpr double kFramePointsMin = 1e-3;

Point point_at(const Context& context, const Joint& joints, const Tool& tool, const Father& father) {
  const Trsf world = tool_in_world(context, joints, tool);
  const Trsf frame = context.tasks.fathers.frame_in_world(father);
  return {
      .trsf = composed(inverse(frame), world), .config = context.system.config_of(joints), .father = father};
}

bool point_to_joint(Context& context, const Tool& tool, const Joint& near, const Point& point,
                    const Out<Joint>& result) {
  const auto solved = joints_at(context, tool, near, point);
  if (!solved || !context.system.in_range(*solved)) return false;
  result.value() = *solved;
  return true;
}

/// In the coordinates of the frame, before the point: a rotation swings its place about the frame's origin.
Point compose_in(Context& context, const Point& point, const FrameRef& frame, const Trsf& trsf) {
  const Trsf frame_in = context.tasks.fathers.frame_in_world(frame.father);
  const Trsf in_frame = composed(inverse(frame_in), point_in_world(context, point));
  const Trsf moved = composed(frame_in, composed(trsf, in_frame));
  Point result = point;
  result.trsf = composed(inverse(context.tasks.fathers.frame_in_world(point.father)), moved);
  return result;
}

double set_frame(Context& context, const Point& origin, const Point& on_x, const Point& on_xy,
                 const Out<Frame>& frame) {
  const auto place = [&](const Point& p) -> Eigen::Vector3d {
    return isometry(point_in_world(context, p)).translation();
  };
  const Eigen::Vector3d o = place(origin);
  const Eigen::Vector3d x = place(on_x) - o;
  if (x.norm() < kFramePointsMin) return -1.0;
  const Eigen::Vector3d z = x.cross(place(on_xy) - o);
  if (z.norm() / x.norm() < kFramePointsMin) return -2.0;
  Eigen::Isometry3d world = Eigen::Isometry3d::Identity();
  world.linear().col(0) = x.normalized();
  world.linear().col(2) = z.normalized();
  world.linear().col(1) = world.linear().col(2).cross(world.linear().col(0));
  world.translation() = o;
  Frame& made = frame.value();
  made.trsf =
      demand_finite(composed(inverse(context.tasks.fathers.frame_in_world(made.father)), trsf_of(world)));
  return 0.0;
}

/// As movel goes from one to the other; 0 the first, 1 the second (manual 6, page 117).
Trsf between_poses(Context&, const Trsf& from, const Trsf& to, double share) {
  if (!(share > -1.0 && share < 2.0))
    throw RunFailure(kErrorParameter, "a share that is not between -1 and 2");
  const Eigen::Isometry3d a = isometry(from);
  const Eigen::Isometry3d b = isometry(to);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(a.linear().transpose() * b.linear()));
  Eigen::Isometry3d result;
  result.linear() = a.linear() * Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
  result.translation() = a.translation() + share * (b.translation() - a.translation());
  result.makeAffine();
  return trsf_of(result);
}

/// Turns Z onto the nearest axis of the reference; the place stays (manual 6, page 119).
Trsf aligned(Context&, const Trsf& trsf, const Trsf& reference) {
  Eigen::Isometry3d turned = isometry(trsf);
  const Eigen::Matrix3d axes = isometry(reference).linear();
  const Eigen::Vector3d z = turned.linear().col(2);
  const Eigen::Vector3d along = axes.transpose() * z;
  Eigen::Index nearest = 0;
  along.cwiseAbs().maxCoeff(&nearest);
  const Eigen::Vector3d goal = axes.col(nearest) * (along[nearest] < 0.0 ? -1.0 : 1.0);
  turned.linear() = Eigen::Quaterniond::FromTwoVectors(z, goal).toRotationMatrix() * turned.linear();
  return trsf_of(turned);
}

template <class Linked, class FatherRef>
Nothing link_to(Context& context, const Out<Linked>& linked, const FatherRef& to) {
  context.tasks.fathers.demand_link(linked.ref, to.father);
  linked.value().father = to.father;
  return {};
}

Trsf position_of_frame(Context& context, const FrameRef& frame, const FrameRef& in) {
  const Fathers& fathers = context.tasks.fathers;
  return composed(inverse(fathers.frame_in_world(in.father)), fathers.frame_in_world(frame.father));
}

Trsf position_of_tool(Context& context, const Tool& tool, const Tool& in) {
  const Fathers& fathers = context.tasks.fathers;
  return composed(inverse(fathers.flange_from(in)), fathers.flange_from(tool));
}

void define_frames(Builtins& list) {
  list.define<double, Point, Point, Point, Out<Frame>>("setFrame", set_frame);
  list.define<Trsf, Point, FrameRef>("position", [](Context& c, const Point& point, const FrameRef& frame) {
    return composed(inverse(c.tasks.fathers.frame_in_world(frame.father)), point_in_world(c, point));
  });
  list.define<Trsf, FrameRef, FrameRef>("position", position_of_frame);
  list.define<Trsf, Tool, Tool>("position", position_of_tool);
  list.define<Nothing, Out<Point>, FrameRef>("link", link_to<Point, FrameRef>);
  list.define<Nothing, Out<Frame>, FrameRef>("link", link_to<Frame, FrameRef>);
  list.define<Nothing, Out<Tool>, ToolRef>("link", link_to<Tool, ToolRef>);
  list.define<Trsf, Trsf, Trsf, double>("interpolateL", between_poses);
  list.define<Trsf, Trsf, Trsf>("align", aligned);
}

}  // namespace

Trsf point_in_world(const Context& context, const Point& point) {
  return composed(context.tasks.fathers.frame_in_world(point.father), point.trsf);
}

Trsf tool_in_world(const Context& context, const Joint& joints, const Tool& tool) {
  const double unit_mm = context.here->code->instance->unit_mm;
  return composed(scaled(context.system.flange_at(joints), 1.0 / unit_mm),
                  context.tasks.fathers.flange_from(tool));
}

std::optional<Joint> joints_at(const Context& context, const Tool& tool, const Joint& near,
                               const Point& point) {
  const double unit_mm = context.here->code->instance->unit_mm;
  const Trsf flange =
      composed(point_in_world(context, point), inverse(context.tasks.fathers.flange_from(tool)));
  return context.system.solve(scaled(flange, unit_mm), point.config, near);
}

void define_geometry(Builtins& list) {
  define_frames(list);
  list.define<Joint>("herej", [](Context& c) { return c.system.joints(); });
  list.define<Point, Tool, FrameRef>("here", [](Context& c, const Tool& tool, const FrameRef& frame) {
    return point_at(c, c.system.joints(), tool, frame.father);
  });
  list.define<Point, Tool, FrameRef, Joint>(
      "jointToPoint", [](Context& c, const Tool& tool, const FrameRef& frame, const Joint& joints) {
        return point_at(c, joints, tool, frame.father);
      });
  list.define<bool, Tool, Joint, Point, Out<Joint>>("pointToJoint", point_to_joint);
  list.define<bool, Joint>("isInRange",
                           [](Context& c, const Joint& joints) { return c.system.in_range(joints); });
  list.define<Config, Joint>("config",
                             [](Context& c, const Joint& joints) { return c.system.config_of(joints); });
  list.define<double, Trsf, Trsf>("distance",
                                  [](Context&, const Trsf& a, const Trsf& b) { return distance(a, b); });
  list.define<double, Point, Point>("distance", [](Context& c, const Point& a, const Point& b) {
    return distance(point_in_world(c, a), point_in_world(c, b));
  });
  list.define<Point, Point, Trsf>("appro", [](Context&, Point point, const Trsf& trsf) {
    point.trsf = composed(point.trsf, trsf);
    return point;
  });
  list.define<Point, Point, FrameRef, Trsf>("compose", compose_in);
}

}  // namespace val3
