#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/read_config.hpp"
#include "service/base/durable_file.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/setup_directory.hpp"
#include "service/cli/setup_trial.hpp"
#include "service/setup/cell_files.hpp"
#include "service/setup/dialogue.hpp"
#include "service/setup/scene_drawing.hpp"
#include "service/setup/setup_results.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

/// Of the shipped cell `demo`, where there is no plan to take them from.
const std::map<std::string, double> kDemoTipBoxMaxMm{{"quick", 0.4}, {"best", 0.27}, {"places", 0.27}};

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
  void demand_park(const SetupAnswers& answers) {
    demand_clear_park(answers, setup_scene(answers, arm_of(answers.arm)));
  }
  CellFiles files(const SetupAnswers& answers) { return cell_files(answers, arm_of(answers.arm), recipes_); }
  Cell cell(const SetupAnswers& answers) {
    return check_cell_files(files(answers), fs::temp_directory_path());
  }

 private:
  const SetupArm& arm_of(const ArmChoice& choice) {
    if (choice != chosen_) {
      arm_ = read_setup_arm(choice, shipped_);
      chosen_ = choice;
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
  std::optional<ArmChoice> chosen_;
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
      fmt::format("{}: changed since touchcal setup wrote it, or written by an earlier version of it: {}; "
                  "what was changed by hand would be lost: go on "
                  "changing the files themselves, or "
                  "give --force",
                  arguments.directory.string(), names));
}

/// What is written, from answers that are good for it.
struct FinishedCell {
  SetupAnswers answers;
  std::vector<std::string> remarks;
  CellFiles files;
};

/// All that is demanded of a cell before it is written. ConfigError whose pointer is the answer in the way.
FinishedCell finished(const SetupArguments& arguments, CellMaking& making, const SetupAnswers& given) {
  FinishedCell made{.answers = with_whole_paths(given)};
  made.remarks = making.check(made.answers);
  making.demand_park(made.answers);
  const bool from_plans = made.answers.limits.from_plans;
  if (from_plans) made.answers.limits.tip_box_max_by_recipe_mm = kDemoTipBoxMaxMm;
  if (made.answers.block.places.empty())
    made.answers.limits.tip_box_max_by_recipe_mm.erase(std::string(kSetupPlacesRecipe));
  const Cell cell = making.cell(made.answers);
  if (arguments.without_plans) {
    demand_touchable_faces(cell);
  } else {
    const RecipeTrial trial = try_recipes(cell, !from_plans);
    made.remarks.insert(made.remarks.end(), trial.remarks.begin(), trial.remarks.end());
    if (from_plans)
      for (const auto& [recipe, limit_mm] : trial.tip_box_max_mm)
        made.answers.limits.tip_box_max_by_recipe_mm[recipe] = limit_mm;
  }
  made.files = making.files(made.answers);
  check_cell_files(made.files, fs::temp_directory_path());
  return made;
}

/// The terminal's side of the dialogue.
class Asking {
 public:
  Asking(const SetupArguments& arguments, CellMaking& making, std::FILE* screen)
      : arguments_(arguments), making_(making), screen_(screen), draft_(draft_file(arguments.directory)) {}

  /// Nothing when the input ends before the cell is finished.
  std::optional<FinishedCell> ask() {
    const auto first = first_answers();
    if (!first) return std::nullopt;
    SetupDialogue dialogue(*first, [&](const SetupAnswers& answers) { return making_.check(answers); });
    kept_ = setup_document(with_whole_paths(*first));
    fs::create_directories(draft_.parent_path());
    fmt::print(
        screen_,
        "Enter keeps what is in brackets; back goes one question back; ? explains; done keeps all that "
        "are left.\nNothing is lost when this is broken off: answers are kept in {}.\n",
        draft_.string());
    while (true) {
      while (!dialogue.is_over()) {
        const auto line = typed(dialogue.prompt());
        if (!line) return std::nullopt;
        fmt::print(screen_, "{}", dialogue.give(*line));
        keep(dialogue.answers());
      }
      try {
        fmt::print(screen_, "{}", arguments_.without_plans ? "" : "Planning what a run touches ...\n");
        std::fflush(screen_);
        return finished(arguments_, making_, dialogue.answers());
      } catch (const ConfigError& error) {
        fmt::print(screen_, "{}", dialogue.refuse(error));
      }
    }
  }

 private:
  std::optional<std::string> typed(const std::string& prompt) {
    fmt::print(screen_, "{}", prompt);
    std::fflush(screen_);
    std::string line;
    if (std::getline(std::cin, line)) return line;
    fmt::print(screen_, "\n");
    return std::nullopt;
  }
  /// Nothing when the input ends.
  std::optional<bool> goes_on_with_draft() {
    while (const auto line = typed(
               draft_.string() + " has the answers of a setup that was not finished; go on with them, yes or "
                                 "no [yes]: ")) {
      if (*line == "" || *line == "yes" || *line == "y") return true;
      if (*line == "no" || *line == "n") return false;
    }
    return std::nullopt;
  }
  /// What the dialogue begins with; nothing when the input ends.
  std::optional<SetupAnswers> first_answers() {
    if (fs::exists(draft_)) {
      const auto goes_on = goes_on_with_draft();
      if (!goes_on) return std::nullopt;
      if (*goes_on) return answers_in(draft_);
    }
    if (arguments_.change) return answers_in(arguments_.directory / kSetupAnswersFile);
    SetupAnswers answers;
    answers.name = fs::absolute(arguments_.directory / "x").parent_path().filename().string();
    return answers;
  }
  void keep(const SetupAnswers& answers) {
    std::string now = setup_document(with_whole_paths(answers));
    if (now == kept_) return;
    replace_file(draft_, now);
    kept_ = std::move(now);
  }

  const SetupArguments& arguments_;
  CellMaking& making_;
  std::FILE* screen_;
  fs::path draft_;
  std::string kept_;
};

void tell(const SetupArguments& arguments, const FinishedCell& made, bool json) {
  const auto& [answers, remarks, files] = made;
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
      "next:\n"
      "  touchcald --cell {0} --check\n"
      "  touchcal plan --cell {0}\n"
      "  cs8sim --cell {0} --speed max    in place of the controller: simulates the cell, with the errors of "
      "truth.json\n"
      "  touchcald --cell {0}             and then touchcal locate, which finds the block by six touches\n",
      cell);
}

}  // namespace

ExitCode setup_command(const SetupArguments& arguments, bool json) {
  if (complete_change(arguments.directory))
    fmt::print(stderr, "{}: a change that was broken off is complete now\n", arguments.directory.string());
  if (has_cell(arguments.directory) && !arguments.change)
    throw std::invalid_argument(arguments.directory.string() +
                                " has a cell already; give --change to change it, or another directory");
  if (arguments.change && !has_cell(arguments.directory))
    throw std::invalid_argument(arguments.directory.string() + " has no cell to change; leave --change out");
  CellMaking making(arguments);
  if (arguments.change) demand_as_made(arguments, making);
  std::optional<FinishedCell> made;
  if (!arguments.answers_file.empty()) {
    made = finished(arguments, making, answers_in(arguments.answers_file));
  } else {
    made = Asking(arguments, making, json ? stderr : stdout).ask();
  }
  if (!made) {
    fmt::print(stderr,
               "{}: nothing is written, as the answers ended before the cell was finished; the next touchcal "
               "setup there goes on with them ({})\n",
               arguments.directory.string(), draft_file(arguments.directory).string());
    return kExitUsage;
  }
  write_cell_directory(arguments.directory, made->files);
  read_cell(arguments.directory / kSetupCellFile);
  remove_file(draft_file(arguments.directory));
  tell(arguments, *made, json);
  return kExitDone;
}

}  // namespace cell
