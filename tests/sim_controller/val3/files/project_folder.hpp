#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sim_controller/val3/files/read_application.hpp"

namespace val3 {

/// A folder of user applications that is gone with its owner.
class ProjectFolder {
 public:
  ProjectFolder() {
    std::string name = testing::TempDir() + "val3_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = std::filesystem::canonical(name);
  }
  ~ProjectFolder() { std::filesystem::remove_all(folder_); }
  ProjectFolder(const ProjectFolder&) = delete;
  ProjectFolder& operator=(const ProjectFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  ProjectFolder& write(const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return *this;
  }

  /// An application of s7 in the folder `name`: `items` are its file elements, as program(), data() ... give.
  ProjectFolder& project(const std::string& name, const std::string& items,
                         const std::string& version = "s7.7.2") {
    return write(name + "/" + name.substr(name.rfind('/') + 1) + ".pjx",
                 "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
                 "<Project xmlns=\"http://www.staubli.com/robotics/VAL3/Project/3\">\n"
                 "  <Parameters version=\"" +
                     version + "\" stackSize=\"5000\" millimeterUnit=\"true\" />\n" + items + "</Project>\n");
  }
  ProjectFolder& data(const std::string& file, const std::string& datas) {
    return write(file,
                 "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
                 "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
                 "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\n<Datas>\n" +
                     datas + "</Datas>\n</Database>\n");
  }
  /// `declared`: Parameters and Locals. The code begins in line 4 with `begin`, behind lines of `declared`.
  ProjectFolder& program(const std::string& file, const std::string& code = "",
                         const std::string& declared = "") {
    const std::string name = std::filesystem::path(file).stem().string();
    return write(file,
                 "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
                 "<Programs xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
                 "xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n"
                 "<Program name=\"" +
                     name + "\">\n" + declared + "<Code><![CDATA[begin\n" + code +
                     "end]]></Code>\n</Program>\n</Programs>\n");
  }
  /// An application `app` with start(), stop() and these variables.
  ProjectFolder& small(const std::string& datas, const std::string& more_items = "",
                       const std::string& version = "s7.7.2") {
    project("app", kStartAndStop + ("<Database><Data file=\"app.dtx\"/></Database>\n" + more_items), version);
    data("app/app.dtx", datas);
    return program("app/start.pgx").program("app/stop.pgx");
  }

  [[nodiscard]] ReadApplication read(const std::string& name = "app") const {
    return read_application(folder_ / name);
  }

  inline static const std::string kStartAndStop =
      "<Programs><Program file=\"start.pgx\"/><Program file=\"stop.pgx\"/></Programs>\n";

 private:
  std::filesystem::path folder_;
};

/// "app.dtx:5 bad-value"
inline std::vector<std::string> told(const Findings& findings) {
  std::vector<std::string> result;
  for (const Finding& finding : findings)
    result.push_back(finding.at.file + ":" + std::to_string(finding.at.line) + " " + finding.rule);
  std::ranges::sort(result);
  return result;
}

}  // namespace val3
