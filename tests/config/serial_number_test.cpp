#include "config/serial_number.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/block_file.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::optional<std::string> serial_of(const json& document) {
  return serial_number(JsonValue("file", document).object({"serial"}).find("serial"));
}

ConfigError refusal_of(const json& document) {
  return error_of([&] { static_cast<void>(serial_of(document)); });
}

TEST(SerialNumber, IsTheTextAsItStandsOrUnknown) {
  EXPECT_EQ(serial_of({{"serial", "F09_9EF3A1_A_01"}}), "F09_9EF3A1_A_01");
  EXPECT_EQ(serial_of({{"serial", "12 345/b"}}), "12 345/b");
  EXPECT_EQ(serial_of(json::object()), std::nullopt);
  const std::string longest(kSerialNumberSizeMax, '7');
  EXPECT_EQ(serial_of({{"serial", longest}}), longest);
}

TEST(SerialNumber, ThatIsNoneIsRefusedWithWhatToDo) {
  EXPECT_THAT(refusal_of({{"serial", std::string(kSerialNumberSizeMax + 1, '7')}}).message(),
              HasSubstr("has 65 bytes; give a serial number of at most 64"));
  for (const char* spaced : {" 7", "7 ", " "})
    EXPECT_THAT(refusal_of({{"serial", spaced}}).message(), HasSubstr("a space; remove it")) << spaced;
  for (const json& wrong : {json(7), json(""), json("7\n"), json(nullptr), json::array()})
    EXPECT_EQ(refusal_of({{"serial", wrong}}).pointer(), "/serial") << wrong;
}

class SerialNumbers : public CopiedConfig {};

TEST_F(SerialNumbers, OfTheShippedCellSayThatTheyAreSimulated) {
  const Cell cell = read();
  for (const auto& serial : {cell.arm_serial, cell.controller_serial, cell.block.serial, cell.probe.serial})
    EXPECT_THAT(serial.value_or(""), testing::StartsWith("SIMULATED-"));
}

TEST_F(SerialNumbers, AreUnknownWhereTheFilesHaveNone) {
  edit(kCell, [](json& cell) { lower_schema(cell, kThirdCellSchema); });
  edit(kBlock, [](json& block) { lower_schema(block, kSecondBlockSchema); });
  edit(kProbe, [](json& probe) { probe.erase("serial"); });
  const Cell cell = read();
  for (const auto& serial : {cell.arm_serial, cell.controller_serial, cell.block.serial, cell.probe.serial})
    EXPECT_EQ(serial, std::nullopt);
}

TEST_F(SerialNumbers, OfAnEarlierSchemaAreRefusedWithTheOneThatHasThem) {
  edit(kBlock, [](json& block) { block["schema"] = kSecondBlockSchema; });
  const ConfigError of_block = error_of([&] { static_cast<void>(read()); });
  EXPECT_EQ(of_block.pointer(), "/serial");
  EXPECT_THAT(of_block.message(), HasSubstr("in a block of version 2; raise \"schema\" to 3"));
  for (const char* key : {"arm_serial", "controller_serial"}) {
    edit(kCell, [&](json& cell) {
      lower_schema(cell, kThirdCellSchema);
      cell[key] = "7";
    });
    const ConfigError of_cell = error_of([&] { static_cast<void>(read()); });
    EXPECT_EQ(of_cell.pointer(), std::string("/") + key);
    EXPECT_THAT(of_cell.message(), HasSubstr("in a cell of version 3; raise \"schema\" to 4"));
  }
}

}  // namespace
}  // namespace cell
