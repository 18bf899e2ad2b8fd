#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/read_config.hpp"
#include "service/base/durable_file.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/planning_bar.hpp"
#include "service/cli/setup_directory.hpp"
#include "service/documents/plan.hpp"
#include "service/documents/plan_document.hpp"
#include "service/setup/cell_files.hpp"
#include "service/setup/dialogue.hpp"
#include "service/setup/scene_drawing.hpp"
#include "service/setup/setup_results.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

/// Of the shipped cell `demo`, where there is no plan to take them from.
const std::map<std::string, double> kDemoTipBoxMaxMm{{"quick", 0.4}, {"best", 0.27}};

/// Answers become files here; the arm is read again only when another one is chosen.
class CellMaking {
 public:
  explicit CellMaking(const SetupArguments& arguments)
      : arguments_(arguments),
        shipped_(shipped_config_of(fs::read_symlink("/proc/self/exe"), std::getenv("TOUCHCAL_CONFIG"))),
        recipes_(shipped_recipes(shipped_)) {}

  /// What is doubtful; ConfigError where the answers make no cell. Draws the scene.
  std::vector<std::string> check(const SetupAnswers& answers) {
    const SetupArm& arm = arm_of(answers.arm);
    check_cell_files(cell_files(answers, arm, recipes_), fs::temp_directory_path());
    const Cell scene = setup_scene(answers, arm);
    std::vector<std::string> remarks = scene_remarks(scene);
    remarks.insert(remarks.end(), arm.remarks.begin(), arm.remarks.end());
    draw(scene, remarks);
    return remarks;
  }
  CellFiles files(const SetupAnswers& answers) { return cell_files(answers, arm_of(answers.arm), recipes_); }
  Cell cell(const SetupAnswers& answers) {
    return check_cell_files(files(answers), fs::temp_directory_path());
  }

 private:
  const SetupArm& arm_of(const ArmChoice& choice) {
    const std::string wanted = choice.file + '\n' + choice.urdf + '\n' + choice.base_link + '\n' +
                               choice.tip_link + '\n' + choice.dh + '\n' + choice.dh_convention;
    if (wanted != chosen_) {
      arm_ = read_setup_arm(choice, shipped_);
      chosen_ = wanted;
    }
    return arm_;
  }
  void draw(const Cell& scene, const std::vector<std::string>& remarks) const {
    if (arguments_.scene_file.empty()) return;
    const bool is_svg = arguments_.scene_file.extension() == ".svg";
    write_replaced(arguments_.scene_file, is_svg ? scene_svg(scene) : scene_html(scene, remarks));
  }

  const SetupArguments& arguments_;
  fs::path shipped_;
  std::map<std::string, std::string> recipes_;
  std::string chosen_;
  SetupArm arm_;
};

/// Paths in the answers that are kept hold from every working directory.
SetupAnswers with_whole_paths(SetupAnswers answers) {
  for (std::string* file : {&answers.arm.file, &answers.arm.urdf, &answers.arm.dh}) {
    std::error_code unknown;
    const bool is_path = file->find('/') != std::string::npos || fs::path(*file).has_extension();
    if (is_path && fs::is_regular_file(*file, unknown))
      *file = fs::absolute(*file).lexically_normal().string();
  }
  return answers;
}

SetupAnswers answers_in(const fs::path& file) {
  return read_setup_answers(file.string(), read_file_bytes(file, kConfigFileSizeMax));
}

/// What the dialogue begins with.
SetupAnswers first_answers(const SetupArguments& arguments) {
  if (!arguments.answers_file.empty()) return answers_in(arguments.answers_file);
  if (fs::exists(draft_file(arguments.directory))) return answers_in(draft_file(arguments.directory));
  if (arguments.change) return answers_in(arguments.directory / kSetupAnswersFile);
  SetupAnswers answers;
  answers.name = fs::absolute(arguments.directory / "x").parent_path().filename().string();
  return answers;
}

/// Files that a person has changed are not overwritten unasked.
void demand_as_made(const SetupArguments& arguments, CellMaking& making) {
  const fs::path made_of = arguments.directory / kSetupAnswersFile;
  if (!fs::exists(made_of))
    throw ConfigError(
        made_of.string(), "",
        "is not there: this cell was not made by touchcal setup; change its files themselves, or give "
        "another directory");
  if (arguments.overwrite) return;
  const auto changed = changed_by_hand(arguments.directory, making.files(answers_in(made_of)));
  if (changed.empty()) return;
  std::string names;
  for (const std::string& name : changed) names += (names.empty() ? "" : ", ") + name;
  throw std::invalid_argument(
      fmt::format("{}: changed since touchcal setup wrote it: {}; these changes would be lost: go on "
                  "changing the files themselves, or "
                  "give --force",
                  arguments.directory.string(), names));
}

/// Nothing when the input ends before the last question.
std::optional<SetupAnswers> asked(const SetupArguments& arguments, CellMaking& making, std::FILE* screen) {
  SetupDialogue dialogue(first_answers(arguments),
                         [&](const SetupAnswers& answers) { return making.check(answers); });
  fmt::print(screen, "Enter keeps what is in brackets; back goes one question back; ? explains.\n");
  bool any = false;
  while (!dialogue.is_over()) {
    fmt::print(screen, "{}", dialogue.prompt());
    std::fflush(screen);
    std::string line;
    if (!std::getline(std::cin, line)) {
      fmt::print(screen, "\n");
      if (any)
        replace_file(draft_file(arguments.directory), setup_document(with_whole_paths(dialogue.answers())));
      return std::nullopt;
    }
    fmt::print(screen, "{}", dialogue.give(line));
    any = true;
  }
  return dialogue.answers();
}

/// What the plan of a recipe promises of the tip where it is worst in the box, and half of it more; to two
/// digits.
std::optional<double> promised_limit_mm(const TipRegions& regions, const Recipe& recipe,
                                        std::vector<std::string>& remarks) {
  PlanningBar bar(isatty(STDERR_FILENO) == 1);
  const auto outcome = make_plan(regions, recipe, bar.progress());
  bar.finish();
  if (const auto* refusal = std::get_if<PlanRefusal>(&outcome)) {
    remarks.push_back(fmt::format("recipe {}: {}", recipe.name, refusal->message));
    return std::nullopt;
  }
  const PlanDocument plan = read_plan(std::get<Plan>(outcome).document);
  const auto worst_mm = plan.tip_uncertainty.expanded.box_max_mm;
  if (!worst_mm || *worst_mm <= 0.0) return std::nullopt;
  constexpr double kRoom = 1.5;
  const double last = std::pow(10.0, std::floor(std::log10(kRoom * *worst_mm)) - 1.0);
  return std::round(std::ceil(kRoom * *worst_mm / last) * last * 1e6) / 1e6;
}

void set_limits(const SetupArguments& arguments, CellMaking& making, SetupAnswers& answers,
                std::vector<std::string>& remarks) {
  if (!answers.limits.from_plans) return;
  answers.limits.tip_box_max_by_recipe_mm = kDemoTipBoxMaxMm;
  if (arguments.without_plans) return;
  const Cell cell = making.cell(answers);
  const TipRegions regions(cell);
  for (const auto& [name, recipe] : cell.recipes)
    if (const auto limit = promised_limit_mm(regions, recipe, remarks))
      answers.limits.tip_box_max_by_recipe_mm[name] = *limit;
}

void tell(const SetupArguments& arguments, const SetupAnswers& answers, const CellFiles& files,
          const std::vector<std::string>& remarks, bool json) {
  const std::string cell = (arguments.directory / kSetupCellFile).string();
  if (json) {
    std::vector<std::string> names;
    for (const auto& [name, unused] : files) names.push_back(name);
    fmt::print("{}\n", setup_result_document(cell, names, remarks, answers.limits.tip_box_max_by_recipe_mm));
    return;
  }
  for (const std::string& remark : remarks) fmt::print(stderr, "note: {}\n", remark);
  fmt::print(
      "{} is written with the files that it names; they are the truth, setup.json keeps the answers.\n",
      cell);
  for (const auto& [recipe, limit_mm] : answers.limits.tip_box_max_by_recipe_mm)
    fmt::print("limit of the tip in the box for {}: {} mm\n", recipe, limit_mm);
  fmt::print(
      "next:\n  touchcald --cell {0} --check\n  touchcal plan --cell {0}\n  touchcald --cell {0}    and then "
      "touchcal "
      "locate, which finds the block by six touches\n",
      cell);
}

}  // namespace

ExitCode setup_command(const SetupArguments& arguments, bool json) {
  if (has_cell(arguments.directory) && !arguments.change)
    throw std::invalid_argument(arguments.directory.string() +
                                " has a cell already; give --change to change it, or another directory");
  if (arguments.change && !has_cell(arguments.directory))
    throw std::invalid_argument(arguments.directory.string() + " has no cell to change; leave --change out");
  CellMaking making(arguments);
  if (arguments.change) demand_as_made(arguments, making);
  SetupAnswers answers;
  if (!arguments.answers_file.empty()) {
    answers = first_answers(arguments);
  } else if (const auto given = asked(arguments, making, json ? stderr : stdout)) {
    answers = *given;
  } else {
    fmt::print(stderr,
               "{}: nothing is written, as the answers ended before the last question; those that were given "
               "are the "
               "defaults of the next touchcal setup there\n",
               arguments.directory.string());
    return kExitUsage;
  }
  answers = with_whole_paths(answers);
  std::vector<std::string> remarks = making.check(answers);
  set_limits(arguments, making, answers, remarks);
  const CellFiles files = making.files(answers);
  check_cell_files(files, fs::temp_directory_path());
  write_cell_directory(arguments.directory, files);
  read_cell(arguments.directory / kSetupCellFile);
  remove_file(draft_file(arguments.directory));
  tell(arguments, answers, files, remarks, json);
  return kExitDone;
}

}  // namespace cell
