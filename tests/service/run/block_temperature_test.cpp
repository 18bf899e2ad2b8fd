#include "service/run/block_temperature.hpp"

#include <gmock/gmock.h>

#include "config/block_file.hpp"
#include "config/utc_text.hpp"
#include "tests/config/copied_config.hpp"

namespace cell {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::chrono::system_clock::time_point kNow = time_from_utc("2026-02-01T08:00:00Z").value();

class BlockTemperatureTest : public CopiedConfig {
 protected:
  /// Without its temperature; the expansion stays.
  void forget_temperature() const {
    edit(kBlock, [](json& block) {
      block["schema"] = kBlockSchema;
      block.erase("temperature_c");
      block.erase("std_temperature_k");
    });
  }
  void measured_in_file(const char* at) const {
    edit(kBlock, [&](json& block) {
      block["schema"] = kBlockSchema;
      block["temperature_at"] = at;
    });
  }
  [[nodiscard]] std::string code(const std::optional<BlockTemperature>& given = {}) const {
    const auto refusal = refuse_temperature(read(), given, kNow);
    return refusal ? refusal->code : "";
  }
};

BlockTemperature measured(std::chrono::system_clock::duration before) {
  return {.celsius = 25.0, .std_k = 0.5, .measured_at = kNow - before};
}

TEST_F(BlockTemperatureTest, TheShippedCellsKnowHowWarmTheirBlocksAreAtAnyTime) {
  for (const char* name : {"edf", "demo"}) {
    const Cell cell = read_cell(path(std::string("cells/") + name + "/cell.json"));
    EXPECT_FALSE(refuse_temperature(cell, {}, kNow)) << name;
  }
}

TEST_F(BlockTemperatureTest, AnUnknownOneIsToldWithFilePointerAndRemedyAndOneOfTheRunIsEnough) {
  forget_temperature();
  const auto refusal = refuse_temperature(read(), {}, kNow).value();
  EXPECT_EQ(refusal.code, "temperature_missing");
  EXPECT_THAT(refusal.words,
              AllOf(HasSubstr("block.json"), HasSubstr("temperature_c"), HasSubstr("--block-temperature")));
  EXPECT_EQ(code(measured(0s)), "");
}

TEST_F(BlockTemperatureTest, AnExpansionWithoutATemperatureIsAWarning) {
  EXPECT_FALSE(temperature_warning(read(), kNow));
  forget_temperature();
  EXPECT_THAT(temperature_warning(read(), kNow).value(),
              AllOf(HasSubstr("block.json: /temperature_c is missing"), HasSubstr("23.6 ppm per kelvin"),
                    HasSubstr("--block-temperature")));
  EXPECT_FALSE(temperature_warning(with_block_temperature(read(), measured(0s)), kNow));
  edit(kBlock, [](json& block) { block.erase("thermal_expansion_per_k"); });
  EXPECT_FALSE(temperature_warning(read(), kNow));
}

TEST_F(BlockTemperatureTest, WithoutAnExpansionItSaysNothing) {
  forget_temperature();
  edit(kBlock, [](json& block) { block.erase("thermal_expansion_per_k"); });
  const auto refusal = refuse_temperature(read(), measured(0s), kNow).value();
  EXPECT_EQ(refusal.code, "expansion_missing");
  EXPECT_THAT(refusal.words, HasSubstr("block.json: /thermal_expansion_per_k"));
}

TEST_F(BlockTemperatureTest, OneOfYesterdayIsRefused) {
  measured_in_file("2026-02-01T00:00:00Z");
  EXPECT_EQ(code(), "") << "eight hours old, which it may be";
  measured_in_file("2026-01-31T08:00:00Z");
  const auto refusal = refuse_temperature(read(), {}, kNow).value();
  EXPECT_EQ(refusal.code, "temperature_old");
  EXPECT_THAT(refusal.words, AllOf(HasSubstr("block.json: /temperature_at: "), HasSubstr("24.0 h old"),
                                   HasSubstr("8.0 h"), HasSubstr("measure")));
  EXPECT_EQ(code(measured(1h)), "") << "what is measured for the run outranks the file";
}

TEST_F(BlockTemperatureTest, TouchesWithoutADateAreWarnedOfItInTheWordsOfTheRefusal) {
  for (const char* at : {"2026-01-31T08:00:00Z", "2027-02-01T08:00:00Z"}) {
    measured_in_file(at);
    const std::string refused = refuse_temperature(read(), {}, kNow).value().words;
    const std::string what = refused.substr(0, refused.find("; ") + 2);
    EXPECT_THAT(temperature_warning(read(), kNow).value(), ::testing::StartsWith(what));
    const BlockTemperature of_command{.celsius = 25.0, .std_k = 0.5, .measured_at = std::nullopt};
    EXPECT_FALSE(temperature_warning(with_block_temperature(read(), of_command), kNow));
  }
  measured_in_file("2026-02-01T00:00:00Z");
  EXPECT_FALSE(temperature_warning(read(), kNow)) << "young enough";
}

TEST_F(BlockTemperatureTest, OneThatComesWithTheRunAgesTooAndByTheCellsOwnLimit) {
  EXPECT_EQ(code(measured(8h)), "");
  const auto refusal = refuse_temperature(read(), measured(8h + 1s), kNow).value();
  EXPECT_EQ(refusal.code, "temperature_old");
  EXPECT_THAT(refusal.words, AllOf(HasSubstr("the request: /block_temperature_at"), HasSubstr("8.0 h old")));
  edit(kCell, [](json& cell) { cell["block_temperature_age_max_h"] = 24; });
  EXPECT_EQ(code(measured(24h)), "");
  EXPECT_EQ(code(measured(24h + 1s)), "temperature_old");
}

TEST_F(BlockTemperatureTest, OneOfTheFutureIsRefused) {
  EXPECT_EQ(code(measured(-kClockDifferenceMax)), "") << "clocks differ by seconds";
  EXPECT_EQ(code(measured(-kClockDifferenceMax - 1s)), "temperature_in_future");
  measured_in_file("2027-02-01T08:00:00Z");
  EXPECT_EQ(code(), "temperature_in_future");
}

TEST_F(BlockTemperatureTest, AStoredRunTellsItAgain) {
  const Cell cell = read();
  StoredRun run;
  EXPECT_FALSE(temperature_of(run, cell));
  run.block_temperature = temperature_to_store(cell, measured(1h));
  EXPECT_EQ(run.block_temperature->measured_at, "2026-02-01T07:00:00.000Z");
  EXPECT_EQ(temperature_of(run, cell), measured(1h));
  EXPECT_EQ(temperature_given_to(run, cell), measured(1h));
  run.block_temperature = temperature_to_store(cell, {});
  EXPECT_EQ(run.block_temperature->source, "file");
  EXPECT_EQ(temperature_of(run, cell), (BlockTemperature{20.0, 1.0, {}}));
  EXPECT_FALSE(temperature_given_to(run, cell)) << "the cell's file has it";
  run.block_temperature = StoredTemperature{.celsius = 22.0};  // as an older daemon kept it
  EXPECT_EQ(temperature_of(run, cell), (BlockTemperature{22.0, cell.block.std_temperature_k, {}}));
  EXPECT_FALSE(temperature_given_to(run, cell));
}

}  // namespace
}  // namespace cell
