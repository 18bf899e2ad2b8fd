#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "service/documents/cell_view.hpp"
#include "tests/simulation/made_table.hpp"

namespace simulation {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::UnorderedElementsAreArray;
using namespace std::chrono_literals;

constexpr std::size_t kCellsWanted = 800;
/// Of each row, where it has so many; the whole table is `touchcal-sim --table --check`.
constexpr std::size_t kSampledOfRow = 2;

const std::string& document() {
  static const std::string text = [] {
    std::ifstream file(TOUCHCAL_SOURCE_DIR "/service/doc/fault_modes.md");
    std::stringstream read;
    read << file.rdbuf();
    return read.str();
  }();
  return text;
}

const std::map<CellNumber, std::string>& documented_cells() {
  static const std::map<CellNumber, std::string> cells = cells_of_document(document());
  return cells;
}

const std::map<CellNumber, std::vector<std::string>>& documented_contradictions() {
  static const std::map<CellNumber, std::vector<std::string>> found = contradictions_of_document(document());
  return found;
}

bool was_run(const std::string& cell) { return !cell.starts_with("cannot happen"); }

/// Of a step, made once.
struct StepWorld {
  RestRecord around;
  TableCell without;
};

const StepWorld& step_world(std::size_t number) {
  static std::map<std::size_t, StepWorld> made;
  const auto found = made.find(number);
  if (found != made.end()) return found->second;
  const TableStep& step = table_steps()[number - 1];
  const RestRecord around = undisturbed(step);
  return made.emplace(number, StepWorld{around, try_cell(table_modes()[0], step, around).cell}).first->second;
}

void expect_as_documented(CellNumber number) {
  const auto& [mode, step] = number;
  const StepWorld& world = step_world(step);
  const TriedCell tried = try_cell(table_modes()[mode], table_steps()[step - 1], world.around);
  EXPECT_EQ(cell_text(tried.cell, mode == 0 ? TableCell{} : world.without), documented_cells().at(number))
      << "touchcal-sim --cell " << mode << "," << step;
  const auto known = documented_contradictions().find(number);
  EXPECT_THAT(tried.contradictions, UnorderedElementsAreArray(known == documented_contradictions().end()
                                                                  ? std::vector<std::string>{}
                                                                  : known->second))
      << "touchcal-sim --cell " << mode << "," << step;
}

/// Those of the row that were run, from another step on in each row, so that every step is among them.
std::vector<CellNumber> sample_of(std::size_t mode) {
  std::vector<CellNumber> sample;
  const std::size_t count = table_steps().size();
  for (std::size_t i = 0; i < count && sample.size() < kSampledOfRow; ++i) {
    const CellNumber number{mode, 1 + (kSampledOfRow * mode + i) % count};
    if (was_run(documented_cells().at(number))) sample.push_back(number);
  }
  return sample;
}

void expect_rows_as_documented(std::size_t part, std::size_t parts) {
  for (std::size_t mode = part; mode < table_modes().size(); mode += parts)
    for (const CellNumber& number : sample_of(mode)) expect_as_documented(number);
}

TEST(FaultModes, OfAThirdOfTheRowsAreAsTheDocumentSays) { expect_rows_as_documented(0, 3); }
TEST(FaultModes, OfAnotherThirdAreAsTheDocumentSays) { expect_rows_as_documented(1, 3); }
TEST(FaultModes, OfTheLastThirdAreAsTheDocumentSays) { expect_rows_as_documented(2, 3); }

TEST(FaultModes, AreSampledAtEveryStep) {
  std::set<std::size_t> steps;
  for (std::size_t mode = 0; mode < table_modes().size(); ++mode) {
    EXPECT_THAT(sample_of(mode), Not(IsEmpty())) << table_modes()[mode].name;
    for (const CellNumber& number : sample_of(mode)) steps.insert(number.second);
  }
  EXPECT_EQ(steps.size(), table_steps().size());
}

TEST(FaultModes, HaveEveryCellInTheDocumentAndWereRunInEnoughOfThem) {
  EXPECT_EQ(documented_cells().size(), table_modes().size() * table_steps().size());
  const auto count =
      std::ranges::count_if(documented_cells(), was_run, &std::pair<const CellNumber, std::string>::second);
  EXPECT_GE(static_cast<std::size_t>(count), kCellsWanted);
  EXPECT_THAT(document(), HasSubstr(std::to_string(count) + " cells that were run"));
}

/// What GET /api/v1/faults answers.
nlohmann::json served_faults() { return nlohmann::json::parse(cell::faults_document()).at("faults"); }

std::set<std::string> codes_in_cells() {
  const std::regex code("`([a-z_]+)`|(?:warning|refused) ([a-z_]+)");
  std::set<std::string> codes;
  for (const auto& [number, cell] : documented_cells())
    for (std::sregex_iterator match(cell.begin(), cell.end(), code), end; match != end; ++match)
      codes.insert((*match)[1].matched ? (*match)[1] : (*match)[2]);
  return codes;
}

TEST(FaultModes, HaveTheCodesThatAreServedWithTheirRobotActionAndNextStep) {
  std::set<std::string> served;
  for (const auto& fault : served_faults()) {
    const std::string code = fault.at("code");
    served.insert(code);
    if (!codes_in_cells().contains(code)) continue;
    EXPECT_THAT(document(), HasSubstr("| `" + code + "` | " + fault.at("robot_action").get<std::string>() +
                                      " | " + fault.at("next_step").get<std::string>() + " |\n"));
  }
  for (const std::string& code : codes_in_cells()) EXPECT_TRUE(served.contains(code)) << code;
}

TEST(FaultModes, NameEachCodeThatTheyDoNotReachWithAReason) {
  for (const auto& [code, reason] : codes_without_cell()) {
    EXPECT_THAT(served_faults().dump(), HasSubstr("\"" + code + "\""));
    EXPECT_THAT(document(), HasSubstr("| `" + code + "` | " + reason + " |\n"));
  }
  EXPECT_THAT(document(), Not(HasSubstr("` | ? |"))) << "a code has neither a cell nor a reason";
}

TEST(FaultModes, AreAllOfTheModesOfProbingOrSayWhereThoseAreTested) {
  std::string rows;
  for (const TableMode& mode : table_modes()) rows += std::string(mode.modes) + " ";
  for (int number = 1; number <= 42; ++number) {
    const std::string name = (number < 10 ? "P0" : "P") + std::to_string(number);
    EXPECT_NE(rows.find(name + " ") != std::string::npos, modes_without_row().contains(name)) << name;
  }
}

TEST(Script, WaitsForItsSightsInTheirOrderAndIsDoneOnce) {
  const std::vector<ScriptStep> steps{{"one", {}}, {"two", {commanded(cell::Command::kStop)}}, {"three", {}}};
  Script script(steps);
  script.see("two");
  EXPECT_EQ(script.take_due(), nullptr);
  script.see("one");
  EXPECT_EQ(script.take_due(), nullptr);
  script.see("two");
  EXPECT_EQ(script.take_due(), &steps[1].then);
  EXPECT_EQ(script.take_due(), nullptr);
  EXPECT_FALSE(script.is_over());
  script.see("three");
  EXPECT_EQ(script.take_due(), &steps[2].then);
  EXPECT_TRUE(script.is_over());
}

Outcome held_with(cell::FaultCode code) {
  Outcome outcome;
  RestRecord& rest = outcome.record.rest;
  rest.struck_at = 10s;
  rest.at = 60s;
  rest.told_at = 11s;
  rest.state = cell::State::kHeld;
  rest.fault = code;
  rest.told = {"fault " + std::string(cell::describe(code).name)};
  rest.exits = cell::exits(rest.state);
  rest.is_clear = true;
  return outcome;
}

TEST(Contradictions, AreFoundInWhatTheRobotIsSaidToHaveDone) {
  Outcome nothing_moved = held_with(cell::FaultCode::kNotConfirmed);
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, nothing_moved), IsEmpty());
  nothing_moved.record.rest.last_moved_at = 10100ms;
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, nothing_moved), Contains(HasSubstr("the arm moved")));

  Outcome stands = held_with(cell::FaultCode::kLinkLost);
  stands.record.rest.last_moved_at = 11500ms;  // it brakes
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, stands), IsEmpty());
  stands.record.rest.last_moved_at = 13s;
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, stands),
              Contains(HasSubstr("more than a second later")));

  Outcome clear = held_with(cell::FaultCode::kFalseTrigger);
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, clear), IsEmpty());
  clear.record.rest.is_clear = false;
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, clear),
              Contains(HasSubstr("way back from a face is due")));
}

TEST(Contradictions, AreFoundWhereTheNextStepNamesNoCommandThatIsTaken) {
  Outcome outcome = held_with(cell::FaultCode::kNotConfirmed);
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, outcome), IsEmpty());
  outcome.record.rest.exits = {cell::Command::kClear};
  EXPECT_THAT(contradictions_of(table_modes()[0], {}, outcome), Contains(HasSubstr("names no command")));
}

TEST(CommandsNamed, AreThoseOfTheTextInItsOrder) {
  EXPECT_EQ(commands_named("touchcal stop, or touchcal clear and touchcal reset; touchcal run is none"),
            (std::vector{cell::Command::kStop, cell::Command::kClear, cell::Command::kReset}));
}

}  // namespace
}  // namespace simulation
