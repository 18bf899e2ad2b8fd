#pragma once

#include <map>
#include <string>

#include "tests/sim_controller/val3/files/project_folder.hpp"

namespace val3 {

/// Writes an application of s6, or of an earlier version, into the folder `name`: `data` are sections of its
/// data file, `programs` the code of each, to which an empty stop() is added. A code's first line is line 4
/// of its file, behind `begin`.
inline void write_old_project(ProjectFolder& into, const std::string& name, const std::string& data,
                              std::map<std::string, std::string> programs,
                              const std::string& version = "s6.8") {
  const std::string xml = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
  programs.emplace("stop", "");
  std::string list;
  for (const auto& [program, code] : programs) {
    list += "<program file=\"" + program + ".pgx\"/>";
    into.write(
        name + "/" + program + ".pgx",
        xml + "<programList xmlns=\"ProgramNameSpace\"><program name=\"" + program +
            "\" public=\"false\"><description/>\n<paramSection/><localSection/>\n<source><code>begin\n" +
            code + "\nend</code></source></program></programList>");
  }
  into.write(name + "/" + name + ".dtx", xml + "<dataList xmlns=\"DataNameSpace\">\n" + data + "</dataList>");
  into.write(name + "/" + name + ".pjx",
             xml + "<project xmlns=\"ProjectNameSpace\"><parameters version=\"" + version +
                 "\" stackSize=\"5000\" "
                 "millimeterUnit=\"true\"/>\n<programSection>" +
                 list + "</programSection><dataSection><data file=\"" + name +
                 ".dtx\"/></dataSection><aliasSection>" +
                 (name == "io" ? "" : "<alias name=\"io\" interface=\"io\" autoload=\"true\"/>") +
                 "</aliasSection></project>");
}

}  // namespace val3
