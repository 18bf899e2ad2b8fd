#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace val3 {

/// A VAL3 project of a few lines, written to a folder of its own that goes with it.
class SmallProject {
 public:
  explicit SmallProject(const std::string& name = "small") : name_(name) {
    static int count = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("val3-" + std::to_string(::getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(folder_ / name_);
  }
  ~SmallProject() { std::filesystem::remove_all(folder_); }
  SmallProject(const SmallProject&) = delete;
  SmallProject& operator=(const SmallProject&) = delete;

  SmallProject& number(const std::string& variable, int size = 1) { return data(variable, "num", "", size); }
  SmallProject& flag(const std::string& variable, int size = 1) { return data(variable, "bool", "", size); }
  SmallProject& data(const std::string& variable, const std::string& type, const std::string& values,
                     int size = 1) {
    data_ += "<Data name=\"" + variable + "\" access=\"private\" xsi:type=\"array\" type=\"" + type +
             "\" size=\"" + std::to_string(size) + "\">" + values + "</Data>\n";
    return *this;
  }
  /// A whole Data element.
  SmallProject& file_data(const std::string& element) {
    data_ += element + "\n";
    return *this;
  }
  /// `declarations`: the Parameters and Locals elements.
  SmallProject& program(const std::string& program, const std::string& code,
                        const std::string& declarations = "") {
    programs_[program] = "<Program name=\"" + program + "\" access=\"private\">" + declarations +
                         "<Code><![CDATA[begin\n" + code + "\nend]]></Code></Program>";
    return *this;
  }
  static std::string parameter(const std::string& variable, const std::string& type,
                               const std::string& more) {
    return "<Parameter name=\"" + variable + "\" type=\"" + type + "\" " + more + "/>";
  }
  static std::string parameters(const std::string& list) {
    return "<Parameters xmlns=\"http://www.staubli.com/robotics/VAL3/Param/1\">" + list + "</Parameters>";
  }
  static std::string local(const std::string& variable, const std::string& type, int size = 1) {
    return locals(local_variable(variable, type, size));
  }
  static std::string local_variable(const std::string& variable, const std::string& type, int size = 1) {
    return "<Local name=\"" + variable + "\" type=\"" + type + "\" xsi:type=\"array\" size=\"" +
           std::to_string(size) + "\"/>";
  }
  static std::string locals(const std::string& list) { return "<Locals>" + list + "</Locals>"; }

  /// A type of the application, of its project's name; that is written and outlives this.
  SmallProject& type(const SmallProject& of) {
    types_ += "<Type name=\"" + of.name_ + "\" path=\"../../" + of.folder_.filename().string() + "/" +
              of.name_ + "/" + of.name_ + ".pjx\"/>";
    return *this;
  }

  /// The project's stackSize.
  SmallProject& stack(std::size_t bytes) {
    stack_bytes_ = bytes;
    return *this;
  }

  /// Writes the files; `stop` and the program list are added.
  SmallProject& write() {
    if (!programs_.contains("stop")) program("stop", "");
    std::string list;
    for (const auto& [program, text] : programs_) {
      list += "<Program file=\"" + program + ".pgx\"/>\n";
      file(program + ".pgx",
           "<Programs " + kXsi + " xmlns=\"" + kSpace + "Program/2\">" + text + "</Programs>");
    }
    file(name_ + ".dtx",
         "<Database " + kXsi + " xmlns=\"" + kSpace + "Data/2\">\n<Datas>\n" + data_ + "</Datas></Database>");
    file(name_ + ".pjx", "<Project xmlns=\"" + kSpace +
                             "Project/3\">\n<Parameters version=\"s7.7.2\" stackSize=\"" +
                             std::to_string(stack_bytes_) +
                             "\" "
                             "millimeterUnit=\"true\"/>\n<Programs>" +
                             list + "</Programs><Database><Data file=\"" + name_ +
                             ".dtx\"/></Database><Libraries/><Types>" + types_ + "</Types></Project>");
    return *this;
  }
  void file(const std::string& name, const std::string& xml) const {
    std::ofstream(folder_ / name_ / name) << "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" << xml;
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_ / name_ / (name_ + ".pjx"); }

 private:
  static inline const std::string kXsi = "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\"";
  static inline const std::string kSpace = "http://www.staubli.com/robotics/VAL3/";
  std::string name_;
  std::size_t stack_bytes_ = 5000;
  std::filesystem::path folder_;
  std::string data_;
  std::string types_;
  std::map<std::string, std::string> programs_;
};

}  // namespace val3
