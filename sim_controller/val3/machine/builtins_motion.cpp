// Motion (manual 6, pages 156 to 162) and the latch (pages 111 and 112).
#include <cmath>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/motion.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

/// A descriptor's fields may not be negative; no manual gives their upper limits.
void check(const Mdesc& m) {
  const auto demand = [](double value, RunError error, const char* name) {
    if (!(value >= 0.0)) throw RunFailure(error, std::string(name) + " of a motion descriptor is negative");
  };
  demand(m.vel, kErrorVel, "vel");
  demand(m.accel, kErrorAccel, "accel");
  demand(m.decel, kErrorDecel, "decel");
  demand(m.tvel, kErrorTvel, "tvel");
  demand(m.rvel, kErrorRvel, "rvel");
  demand(m.reach, kErrorReach, "reach");
  demand(m.leave, kErrorLeave, "leave");
}

void demand_no_failed_move(const Context& context) {
  if (const RunError error = context.system.move_error(); error != kErrorNone)
    throw RunFailure(error, "an earlier move could not be completed");
}

/// The line that is carried out.
MoveOrigin origin_of(const Context& context) {
  const Program& program = *context.here->code->program;
  return {context.task.name, program.file, program.lines[context.here->next - 1].line};
}

/// The number of the stored move.
double store(Context& context, MoveOrder order, const Tool& tool, const Mdesc& descriptor) {
  demand_no_failed_move(context);
  check(descriptor);
  if (context.system.store_is_full()) throw Wait{};
  const double unit_mm = context.here->code->instance->unit_mm;
  order.tool = scaled(context.tasks.fathers.flange_from(tool), unit_mm);
  order.descriptor = descriptor;
  for (double Mdesc::*length : {&Mdesc::tvel, &Mdesc::leave, &Mdesc::reach})
    order.descriptor.*length *= unit_mm;
  if (!is_finite(order.to) || !is_finite(order.to_pose) || !is_finite(order.via_pose) ||
      !is_finite(order.tool) || !is_finite(order.descriptor))
    throw RunFailure(kErrorInvalidMove, "a move to what is no number");
  order.origin = origin_of(context);
  if (const RunError error = context.system.store(order); error != kErrorNone)
    throw RunFailure(error, "a move that cannot be stored");
  return context.system.last_move_id();
}

MoveOrder order_to(const Context& context, MoveOrder::Shape shape, const Point& point, const Tool& tool) {
  const double unit_mm = context.here->code->instance->unit_mm;
  MoveOrder order{.shape = shape, .to_pose = scaled(point_in_world(context, point), unit_mm)};
  order.config = point.config;
  const auto joints = joints_at(context, tool, context.system.last_stored(), point);
  order.reachable = joints.has_value();
  if (joints) order.to = *joints;
  return order;
}

double move_joints(Context& context, const Joint& to, const Tool& tool, const Mdesc& descriptor) {
  MoveOrder order{.shape = MoveOrder::Shape::kJoint, .to = to};
  return store(context, order, tool, descriptor);
}

template <MoveOrder::Shape kShape>
double move_to(Context& context, const Point& point, const Tool& tool, const Mdesc& descriptor) {
  return store(context, order_to(context, kShape, point, tool), tool, descriptor);
}

double move_arc(Context& context, const Point& via, const Point& to, const Tool& tool,
                const Mdesc& descriptor) {
  MoveOrder order = order_to(context, MoveOrder::Shape::kCircle, to, tool);
  order.via_pose = scaled(point_in_world(context, via), context.here->code->instance->unit_mm);
  return store(context, order, tool, descriptor);
}

Nothing wait_end(Context& context) {
  demand_no_failed_move(context);
  context.system.cancel_blend();
  if (!context.system.is_empty()) throw Wait{};
  return {};
}

/// open() and close(): the arm comes to its end, then the valve switches and the time of the tool passes.
template <bool Open>
Nothing grip(Context& context, const Tool& tool) {
  const void* who = context.here->code->operations[context.here->next - 1].get();
  if (context.task.waits_in != who) {
    wait_end(context);
    if (tool.gripper.id >= 0) context.system.set_digital(tool.gripper.id, Open);
  }
  if (!context.tasks.is_over(context.task, who, Open ? tool.open_s : tool.close_s)) throw Wait{};
  return {};
}

bool take_latch(Context& context, const Out<Joint>& joints) {
  const auto latched = context.system.latched();
  if (latched) joints.value() = *latched;
  return latched.has_value();
}

Nothing joint_force(Context& context, const Slice<double>& force) {
  const Joint forces = context.system.joint_force();
  if (force.size() < forces.size()) throw RunFailure(kErrorParameter, "an array of fewer elements than axes");
  for (std::size_t i = 0; i < forces.size(); ++i) force[i] = forces[i];
  return {};
}

void define_state(Builtins& list) {
  list.define<bool>("isEmpty", [](Context& c) { return c.system.is_empty(); });
  list.define<bool>("isSettled", [](Context& c) { return c.system.is_settled(); });
  list.define<double>("getMoveId", [](Context& c) { return c.system.move_id(); });
  list.define<Nothing, double>("setMoveId", [](Context& c, double id) {
    c.system.set_move_id(id);
    return Nothing{};
  });
  list.define<double, Tool>("getSpeed", [](Context& c, const Tool& tool) {
    const double unit_mm = c.here->code->instance->unit_mm;
    return c.system.tool_speed(scaled(c.tasks.fathers.flange_from(tool), unit_mm)) / unit_mm;
  });
  list.define<Joint>("getPositionErr", [](Context& c) { return c.system.position_error(); });
  list.define<Nothing, Slice<double>>("getJointForce", joint_force);
  list.define<Nothing, Dio>("setLatch", [](Context& c, const Dio& signal) {
    if (signal.id < 0) throw RunFailure(kErrorNotLinked, "an input that is not linked");
    if (const RunError error = c.system.arm_latch(signal.id); error != kErrorNone)
      throw RunFailure(error, "an input without a latch");
    return Nothing{};
  });
  list.define<bool, Out<Joint>>("getLatch", take_latch);
}

}  // namespace

void define_motion(Builtins& list) {
  define_state(list);
  list.define<double, Joint, Tool, Mdesc>("movej", move_joints);
  list.define<double, Point, Tool, Mdesc>("movej", move_to<MoveOrder::Shape::kJoint>);
  list.define<double, Point, Tool, Mdesc>("movel", move_to<MoveOrder::Shape::kLine>);
  list.define<double, Point, Point, Tool, Mdesc>("movec", move_arc);
  list.define<Nothing>("waitEndMove", wait_end);
  list.define<Nothing, Tool>("open", grip<true>);
  list.define<Nothing, Tool>("close", grip<false>);
  list.define<Nothing>("stopMove", [](Context& c) {
    c.system.stop_move();
    return Nothing{};
  });
  list.define<Nothing>("restartMove", [](Context& c) {
    c.system.restart_move();
    return Nothing{};
  });
  list.define<Nothing>("resetMotion", [](Context& c) {
    c.system.reset_motion({});
    return Nothing{};
  });
  list.define<Nothing, Joint>("resetMotion", [](Context& c, const Joint& start) {
    c.system.reset_motion(start);
    return Nothing{};
  });
  list.define<Nothing, bool>("autoConnectMove", [](Context& c, bool on) {
    c.system.set_auto_connect(on);
    return Nothing{};
  });
  list.define<bool>("autoConnectMove", [](Context& c) { return c.system.auto_connect(); });
}

}  // namespace val3
