#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <stdexcept>

#include "config/arm_file.hpp"
#include "config/arm_writer.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/offline.hpp"
#include "service/setup/dh_arm.hpp"
#include "service/setup/setup_results.hpp"
#include "service/setup/urdf_arm.hpp"

namespace cell {
namespace {

MadeArm made_of(const SetupArmArguments& arguments) {
  if (!arguments.urdf_file.empty())
    return arm_of_urdf_file(arguments.urdf_file, arguments.base_link, arguments.tip_link);
  if (!arguments.dh_file.empty()) return arm_of_dh_file(arguments.dh_file, arguments.dh_convention);
  throw std::invalid_argument("setup-arm: give --urdf FILE --base LINK --tip LINK, or --dh FILE.csv");
}

}  // namespace

ExitCode setup_arm_command(const SetupArmArguments& arguments, bool json) {
  MadeArm made = made_of(arguments);
  made.arm.name = arguments.name;
  const std::string document = arm_document(made.arm);
  // What is written is read: the reader refuses what the description had beyond its ranges.
  read_arm_text(arguments.file, document);
  if (json && arguments.file == "-")
    throw std::invalid_argument("--out: standard output has the document with --json; name a file");
  write_whole_file(arguments.file, document, arguments.overwrite);
  if (json) {
    fmt::print("{}\n", setup_arm_result_document(arguments.name, arguments.file, made.remarks));
    return kExitDone;
  }
  for (const std::string& remark : made.remarks) fmt::print(stderr, "note: {}\n", remark);
  if (arguments.file != "-")
    fmt::print("{0} is written. next:\n  touchcal setup DIR    and {0} as the arm\n", arguments.file);
  return kExitDone;
}

}  // namespace cell
