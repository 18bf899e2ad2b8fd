#include "sim_controller/val3/language/instruction_table.hpp"

namespace val3::instruction_table {

std::vector<Row> of_system() {
  constexpr unsigned kWaits = kYields | kBlocks;
  return {
      // tasks and time
      {"taskSuspend", {"void(string)"}, 72, 84},
      {"taskResume", {"void(string, num)"}, 72, 84, kYields},
      {"taskKill", {"void(string)"}, 73, 85, kWaits},
      {"taskStatus", {"num(string)"}, 74, 86},
      {"setMutex", {"void(bool&)"}, 73, 85, kWaits},
      {"help", {"string(num)"}, 0, 85, kPlain, kS6},
      {"wait", {"void(bool)"}, 77, 89, kWaits},
      {"delay", {"void(num)"}, 77, 89, kWaits},
      {"watch", {"bool(bool, num)"}, 78, 90, kWaits},
      {"clock", {"num()"}, 78, 90},
      // libraries; libSave and libPath without an alias are of the application itself
      {"libLoad", {"num(string, string?)"}, 83, 97, kYields | kOnLibrary},
      {"libSave", {"num(string?)"}, 83, 97, kYields | kOnLibrary},
      {"libDelete", {"num(string)"}, 83, 97, kYields},
      {"libPath", {"string()"}, 84, 98, kOnLibrary},
      {"libList", {"bool(string, string&[])"}, 84, 98, kYields},
      {"libExist", {"bool(string)"}, 0, 98, kOnLibrary, kS64},
      // the controller
      {"enablePower", {"void()"}, 87, 101},
      {"disablePower", {"void()"}, 87, 101, kWaits},
      {"isPowered", {"bool()"}, 87, 101},
      {"isCalibrated", {"bool()"}, 88, 102},
      {"workingMode", {"num(num&?)"}, 88, 102},
      {"esStatus", {"num()"}, 89, 103},
      {"speedScale", {"num()"}, 89, 0},
      {"getMonitorSpeed", {"num()"}, 0, 104, kPlain, kS64},
      {"setMonitorSpeed", {"num(num)"}, 0, 104, kPlain, kS64},
      {"getVersion", {"string(string)"}, 0, 105, kPlain, kS64},
      {"safetyFault", {"any(string&?)"}, 0, 0, kPlain, kS7},
      {"setSafetyRestart", {"any()"}, 0, 0, kPlain, kS7},
      {"getSafeRefStatus", {"num()"}, 0, 0, kPlain, kS7},
      {"getJntRef", {"any(string)"}, 0, 0, kPlain, kS7},
      {"hasCpuExtPowerSupply", {"bool()"}, 0, 0, kPlain, kS7},
      {"wakeUpRobot", {"num()"}, 0, 0, kPlain, kS7},
      // the manuals' option and add-ons of file access
      {"getLicence", {"num(string, string)"}, 0, 175, kPlain, kS61},
      {"$fileOpen", {"num(string, string)"}, 0, 0, kYields, kS53, "files"},
      {"$fileGet", {"num(num, string|num&[], num)"}, 0, 0, kYields, kS53, "files"},
      {"$fileSet", {"num(num, string|num[], num)"}, 0, 0, kYields, kS53, "files"},
      {"$fileClose", {"any(num)"}, 0, 0, kYields, kS53, "files"},
  };
}

}  // namespace val3::instruction_table
