#include <cmath>

#include "tests/val3/instructions.hpp"

namespace val3 {
namespace {

Eigen::Isometry3d frame_in_world(const Call& c, const std::string& name) {
  const auto found = c.application.globals.find(name);
  if (found == c.application.globals.end()) throw RuntimeError(162, "no frame " + name);
  return isometry(std::get<Frame>(found->second.place.read()).trsf);
}

Eigen::Isometry3d in_world(const Call& c, const Point& p) {
  return frame_in_world(c, p.father) * isometry(p.trsf);
}

Point point_of(const Call& c, const Joint& joints, const Tool& tool, const Frame& frame) {
  const Eigen::Isometry3d world_from_tool = c.cabinet.arm.world_from_flange(joints) * isometry(tool.trsf);
  return {.trsf = trsf(frame_in_world(c, frame.name).inverse() * world_from_tool), .father = frame.name};
}

std::optional<Joint> joints_of(const Call& c, const Tool& tool, const Joint& start, const Point& point) {
  return c.cabinet.arm.solve(in_world(c, point) * isometry(tool.trsf).inverse(), start);
}

void check(const Mdesc& m) {
  if (m.decel < m.vel) throw RuntimeError(kErrorMdesc, "decel is below vel");
  if (!(m.accel > 0 && m.vel > 0 && m.decel > 0 && m.tvel > 0 && m.rvel > 0))
    throw RuntimeError(kErrorMdesc - 2, "a field of a motion descriptor is not above 0");
}

Value queue(Call& c, const Joint& to) {
  const Mdesc& descriptor = c.value<Mdesc>(2);
  check(descriptor);
  if (auto& left = c.cabinet.moves_until_error; left && (*left)-- == 0) {
    left.reset();
    throw RuntimeError(kErrorImpossibleMove, "a move that a test wants to be impossible");
  }
  if (!c.cabinet.arm.in_range(to)) throw RuntimeError(kErrorImpossibleMove, "a move out of the joint ranges");
  return c.cabinet.queue_move(to, descriptor, isometry(c.value<Tool>(1).trsf));
}

Value move_to_point(Call& c) {
  const auto to = joints_of(c, c.value<Tool>(1), c.cabinet.joints_deg, c.value<Point>(0));
  if (!to) throw RuntimeError(kErrorImpossibleMove, "a point that cannot be reached");
  return queue(c, *to);
}

Value movej(Call& c) {
  return std::holds_alternative<Joint>(c.values[0]) ? queue(c, c.value<Joint>(0)) : move_to_point(c);
}

Value point_to_joint(Call& c) {
  const auto joints = joints_of(c, c.value<Tool>(0), c.value<Joint>(1), c.value<Point>(2));
  const bool found = joints && c.cabinet.arm.in_range(*joints);
  if (found) c.places[3].write(*joints);
  return found;
}

Value distance(Call& c) {
  if (c.values[0].index() != c.values[1].index())
    throw RuntimeError(kErrorInterpreter, "distance of two types");
  const auto place = [&](const Value& v) -> Eigen::Vector3d {
    if (const Trsf* t = std::get_if<Trsf>(&v)) return isometry(*t).translation();
    return in_world(c, std::get<Point>(v)).translation();
  };
  return (place(c.values[0]) - place(c.values[1])).norm() * 1000.0;
}

Value appro(Call& c) {
  Point result = c.value<Point>(0);
  result.trsf = trsf(isometry(result.trsf) * isometry(c.value<Trsf>(1)));
  return result;
}

Value position(Call& c) {
  return trsf(frame_in_world(c, c.value<Frame>(1).name).inverse() * in_world(c, c.value<Point>(0)));
}

Value set_latch(Call& c) {
  const std::string& link = c.value<Dio>(0).link;
  if (!c.cabinet.inputs.contains(link)) throw RuntimeError(kErrorNotLinked, "no input " + link);
  if (!c.cabinet.latch_inputs.contains(link)) throw RuntimeError(kErrorParameter, "an input without a latch");
  c.cabinet.arm_latch(link);
  return 0.0;
}

Value get_latch(Call& c) {
  if (!c.cabinet.latched) return false;
  c.places[0].write(*c.cabinet.latched);
  return true;
}

Value working_mode(Call& c) {
  constexpr int kHoldInLocalAndRemote = 2;
  if (!c.places.empty() && c.places[0].elements)
    c.places[0].write(c.cabinet.held ? double{kHoldInLocalAndRemote} : 0.0);
  return static_cast<double>(c.cabinet.mode);
}

Value enable_power(Call& c) {
  if (c.cabinet.mode == 4 && c.cabinet.emergency_stop == 0) c.cabinet.powered = true;
  return 0.0;
}

Value version(Call& c) {
  if (c.text(0) == "ArmType") return c.cabinet.arm_type;
  if (c.text(0) == "ArmSN") return std::string("F09_9EF3A1_A_01");
  if (c.text(0) != "VAL3" && c.text(0) != "System") throw RuntimeError(kErrorParameter, "version of what");
  return c.cabinet.version;
}

Value set_mutex(Call& c) {
  const bool was_free = !std::get<bool>(c.places[0].read());
  c.places[0].write(true);
  return was_free;
}

Value fill_zero(Call& c) {
  for (std::size_t i = 0; i < c.places[0].size(); ++i) c.places[0].element(static_cast<double>(i)).write(0.0);
  return 0.0;
}

void add_moves(std::vector<Instruction>& list) {
  list.push_back(instruction("num movej(jointRx|pointRx, tool, mdesc)", movej));
  list.push_back(instruction("num movel(pointRx, tool, mdesc)", move_to_point));
  list.push_back(instruction("void resetMotion(?jointRx)",
                             [](Call& c) -> Value { return c.cabinet.reset_motion(), 0.0; }));
  list.push_back(instruction("void stopMove()", [](Call& c) -> Value { return c.cabinet.stopped = true; }));
  list.push_back(
      instruction("void restartMove()", [](Call& c) -> Value { return c.cabinet.stopped = false; }));
  list.push_back(instruction("void autoConnectMove(bool)", [](Call&) -> Value { return 0.0; }));
  list.push_back(instruction("bool isEmpty()", [](Call& c) -> Value { return c.cabinet.is_empty(); }));
  list.push_back(instruction("bool isSettled()", [](Call& c) -> Value { return c.cabinet.is_settled(); }));
  list.push_back(instruction("num getMoveId()", [](Call& c) -> Value { return c.cabinet.move_id(); }));
  list.push_back(instruction("void setLatch(dio)", set_latch));
  list.push_back(instruction("bool getLatch(jointRx&)", get_latch));
}

void add_poses(std::vector<Instruction>& list) {
  list.push_back(instruction("jointRx herej()", [](Call& c) -> Value { return c.cabinet.joints_deg; }));
  list.push_back(instruction("pointRx here(tool, frame)", [](Call& c) -> Value {
    return point_of(c, c.cabinet.joints_deg, c.value<Tool>(0), c.value<Frame>(1));
  }));
  list.push_back(instruction("pointRx jointToPoint(tool, frame, jointRx)", [](Call& c) -> Value {
    return point_of(c, c.value<Joint>(2), c.value<Tool>(0), c.value<Frame>(1));
  }));
  list.push_back(instruction("bool pointToJoint(tool, jointRx, pointRx, jointRx&)", point_to_joint));
  list.push_back(instruction("bool isInRange(jointRx)",
                             [](Call& c) -> Value { return c.cabinet.arm.in_range(c.value<Joint>(0)); }));
  list.push_back(instruction("num distance(pointRx|trsf, pointRx|trsf)", distance));
  list.push_back(instruction("pointRx appro(pointRx, trsf)", appro));
  list.push_back(instruction("trsf position(pointRx, frame)", position));
  list.push_back(instruction("void getJointForce(num[]&)", fill_zero));
  list.push_back(instruction("jointRx getPositionErr()", [](Call&) -> Value { return Joint{}; }));
  list.push_back(instruction("num getSpeed(tool)", [](Call&) -> Value { return 0.0; }));
}

void add_operator(std::vector<Instruction>& list) {
  list.push_back(instruction("num workingMode(?num&)", working_mode));
  list.push_back(instruction("num esStatus()",
                             [](Call& c) -> Value { return static_cast<double>(c.cabinet.emergency_stop); }));
  list.push_back(instruction("bool isPowered()", [](Call& c) -> Value { return c.cabinet.powered; }));
  list.push_back(instruction("bool isCalibrated()", [](Call& c) -> Value { return c.cabinet.calibrated; }));
  list.push_back(instruction("void enablePower()", enable_power));
  list.push_back(
      instruction("void disablePower()", [](Call& c) -> Value { return c.cabinet.powered = false; }));
  list.push_back(
      instruction("num getMonitorSpeed()", [](Call& c) -> Value { return c.cabinet.monitor_speed; }));
  list.push_back(instruction("num setMonitorSpeed(num)",
                             [](Call& c) -> Value { return c.cabinet.mode == 4 ? -2.0 : -1.0; }));
  list.push_back(instruction("string getVersion(string)", version));
  list.push_back(instruction("num clock()", [](Call& c) -> Value { return c.cabinet.clock_s; }));
  list.push_back(instruction("bool setMutex(bool&)", set_mutex));
  list.push_back(instruction("void logMsg(string, ?num)",
                             [](Call& c) -> Value { return c.cabinet.log.push_back(c.text(0)), 0.0; }));
  list.push_back(instruction(
      "void popUpMsg(string)", [](Call& c) -> Value { return static_cast<double>(++c.cabinet.pop_ups); },
      true));
  // the user screen: nobody looks
  for (const char* screen : {"void userPage()", "void cls()", "void gotoxy(num, num)", "void title(string)",
                             "void put(string|num)", "void putln(string|num)"})
    list.push_back(instruction(screen, [](Call&) -> Value { return 0.0; }));
}

}  // namespace

std::vector<Instruction> arm_instructions() {
  std::vector<Instruction> list;
  add_moves(list);
  add_poses(list);
  add_operator(list);
  return list;
}

}  // namespace val3
