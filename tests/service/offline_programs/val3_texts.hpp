#pragma once

#include <string>

#include "service/offline_programs/data_filter.hpp"

/// VAL3 files as the programming systems of s5 to s8 write them, made here.
namespace cell {

inline constexpr const char* kBom = "\xEF\xBB\xBF";

/// `datas`: Data elements.
inline std::string new_data(const std::string& datas) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
         "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\n  <Datas>\n" +
         datas + "  </Datas>\n</Database>\n";
}

/// `values`: Value elements.
inline std::string variable(const std::string& name, const std::string& type, const std::string& values,
                            const std::string& size = "1") {
  return "    <Data name=\"" + name + "\" access=\"private\" xsi:type=\"array\" type=\"" + type +
         "\" size=\"" + size + "\">\n" + values + "    </Data>\n";
}

inline std::string value(const std::string& attributes) { return "      <Value " + attributes + " />\n"; }

/// `sections`: as in s5 and s6.
inline std::string old_data(const std::string& sections) {
  return "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\r\n<dataList xmlns=\"DataNameSpace\">\r\n" +
         sections + "</dataList>\r\n";
}

inline std::string new_program(const std::string& name, const std::string& code,
                               const std::string& declared = "") {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
         "<Programs xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n<Program name=\"" +
         name + "\">\n" + declared + "<Code><![CDATA[begin\n" + code +
         "end]]></Code>\n</Program>\n</Programs>\n";
}

inline std::string old_program(const std::string& name, const std::string& code,
                               const std::string& declared = "") {
  return "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\r\n<programList xmlns=\"ProgramNameSpace\">\r\n"
         "<program name=\"" +
         name + "\" public=\"false\">\r\n" + declared + "<source>\r\n<code>\r\nbegin\r\n" + code +
         "end\r\n</code>\r\n</source>\r\n</program>\r\n</programList>\r\n";
}

/// Poses moved in the world, turned not; each joint by its own step; nothing refused.
inline Corrector shifted_by(const Eigen::Vector3d& shift_mm, double joint_step_deg = 0.25) {
  return [=](const OfflineTarget& target) {
    Correction correction{.status = CorrectionStatus::kOk, .moved_mm = shift_mm.norm()};
    if (const auto* joints = std::get_if<OfflineJoints>(&target.place)) {
      for (std::size_t i = 0; i < 6; ++i)
        correction.joints_deg[i] = joints->joints_deg[i] + joint_step_deg * static_cast<double>(i + 1);
    } else {
      correction.world_from_tool = std::get<OfflinePose>(target.place).world_from_tool;
      correction.world_from_tool.pretranslate(1e-3 * shift_mm);
    }
    return correction;
  };
}

inline Corrector unchanged() { return shifted_by(Eigen::Vector3d::Zero(), 0.0); }

/// The file "cell.dtx" with a list "points.list" of these lines.
inline FilteredData filtered(const std::string& data, const std::string& list, const Corrector& corrector,
                             double mm_per_unit = 1.0) {
  return filter_data("cell.dtx", data, parse_filter_list("points.list", list), corrector, mm_per_unit);
}

}  // namespace cell
