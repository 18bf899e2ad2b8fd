#include "sim_controller/val3/language/instruction_table.hpp"

namespace val3::instruction_table {

std::vector<Row> of_motion() {
  constexpr unsigned kWaits = kYields | kBlocks;
  constexpr std::string_view kCompliance = "compliance", kAlter = "alter", kServo = "servo";
  return {
      // geometry
      {"herej", {"joint()"}, 94, 110},
      {"here", {"point(tool, frame)"}, 108, 130},
      {"isInRange", {"bool(joint|jointRs)"}, 94, 110},
      {"config", {"config(joint)", "configRs(jointRs)"}, 115, 137},
      {"jointToPoint", {"point(tool, frame, joint)", "pointRs(tool, frame, jointRs)"}, 109, 131},
      {"pointToJoint",
       {"bool(tool, joint, point, joint&)", "bool(tool, jointRs, pointRs, jointRs&)"},
       109,
       131},
      {"distance", {"num(trsf, trsf)", "num(point|pointRs, point|pointRs)"}, 100, 116},
      {"appro", {"point(point, trsf)", "pointRs(pointRs, trsf)"}, 108, 130},
      {"compose", {"point(point, frame, trsf)", "pointRs(pointRs, frame, trsf)"}, 107, 129},
      {"position",
       {"trsf(point|pointRs, frame)", "s6.4 trsf(frame, frame)", "s6.4 trsf(tool, tool)"},
       110,
       121},
      {"setFrame", {"num(point, point, point, frame&)", "num(pointRs, pointRs, pointRs, frame&)"}, 102, 121},
      {"interpolateL", {"trsf(trsf, trsf, num)"}, 0, 117, kPlain, kS64},
      {"interpolateC", {"trsf(trsf, trsf, trsf, num)"}, 0, 118, kPlain, kS64},
      {"align", {"trsf(trsf, trsf)"}, 0, 119, kPlain, kS64},
      {"link", {"any(point|pointRs&, frame)", "any(frame&, frame)", "any(tool&, tool)"}, 0, 0, kPlain, kS7},
      // latch
      {"setLatch", {"void(dio)"}, 95, 111, kPlain, kS53},
      {"getLatch", {"bool(joint|jointRs&)"}, 96, 112, kPlain, kS53},
      // motion; a move waits only while the store of moves is full, and has a result since s7
      {"movej", {"num(joint|point|jointRs|pointRs, tool, mdesc)"}, 133, 156, kBlocks},
      {"movel", {"num(point|pointRs, tool, mdesc)"}, 134, 157, kBlocks},
      {"movec", {"num(point|pointRs, point|pointRs, tool, mdesc)"}, 135, 158, kBlocks},
      {"open", {"void(tool)"}, 104, 124, kWaits},
      {"close", {"void(tool)"}, 104, 124, kWaits},
      {"waitEndMove", {"void()"}, 137, 160, kWaits},
      {"isEmpty", {"bool()"}, 138, 161},
      {"isSettled", {"bool()"}, 138, 161},
      {"stopMove", {"void()"}, 136, 159},
      {"restartMove", {"void()"}, 137, 160},
      {"resetMotion", {"void(joint|jointRs?)"}, 136, 159},
      {"autoConnectMove", {"bool()", "void(bool)"}, 138, 161},
      {"getSpeed", {"num(tool)"}, 0, 162, kPlain, kS64},
      // the manual's heading says num, the add-on before it gave a joint
      {"getPositionErr", {"any()"}, 0, 162, kPlain, kS64},
      {"getJointForce", {"any(num&[])"}, 0, 162, kPlain, kS64},
      {"getMoveId", {"num()"}, 0, 0, kPlain, kS7},
      {"setMoveId", {"any(num)"}, 0, 0, kPlain, kS7},
      {"setPayload", {"any(...)"}, 0, 0, kPlain, kS7},
      // options
      {"movejf", {"num(joint|point|jointRs|pointRs, tool, mdesc, num)"}, 142, 166, kBlocks, kS5, kCompliance},
      {"movelf", {"num(point|pointRs, tool, mdesc, num)"}, 143, 167, kBlocks, kS5, kCompliance},
      {"isCompliant", {"bool()"}, 144, 168, kPlain, kS5, kCompliance},
      {"alterMovej", {"num(joint|point|jointRs|pointRs, tool, mdesc)"}, 146, 170, kBlocks, kS5, kAlter},
      {"alterMovel", {"num(point|pointRs, tool, mdesc)"}, 147, 171, kBlocks, kS5, kAlter},
      {"alterMovec", {"num(point|pointRs, point|pointRs, tool, mdesc)"}, 147, 171, kBlocks, kS5, kAlter},
      {"alterBegin", {"num(frame|tool, mdesc)"}, 148, 172, kPlain, kS5, kAlter},
      {"alter", {"num(trsf)"}, 149, 173, kPlain, kS5, kAlter},
      {"alterEnd", {"num()"}, 149, 173, kPlain, kS5, kAlter},
      {"alterStopTime", {"num()"}, 150, 174, kPlain, kS5, kAlter},
      // add-ons
      {"$movejSync", {"any(...)"}, 0, 0, kBlocks, kS53, "synchronised motion"},
      {"$getJntFbk", {"joint()"}, 0, 0, kPlain, kS53, kServo},
  };
}

}  // namespace val3::instruction_table
