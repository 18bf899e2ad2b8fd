// Digital and analogue signals of the cell under a VAL3 application.
#include "sim_controller/val3_signals.hpp"

#include <gtest/gtest.h>

#include <array>

#include "sim_controller/operator.hpp"
#include "val3_cell.hpp"

namespace sim {
namespace {

using namespace testing;

TEST_F(Val3Cell, LinksOfTheCellReadTheCabinet) {
  const int contact = system.find_digital("FastIO\\fIn0").value();
  const int loop = system.find_digital("BasicIO-1\\%I0").value();
  const int closed = system.find_digital("BasicIO-1\\%I1").value();
  const int confirm = system.find_digital("BasicIO-1\\%I2").value();
  EXPECT_EQ(system.find_digital("fIn0"), contact) << "the name of s5 and s6";
  EXPECT_EQ(system.find_digital("bIn0"), loop);
  const auto levels = [&] {
    return std::array{system.digital(contact), system.digital(loop), system.digital(closed),
                      system.digital(confirm)};
  };
  EXPECT_EQ(levels(), (std::array{false, true, true, false}));
  for (const Act act : {Act::kTouchStylus, Act::kOpenCell, Act::kPressConfirm})
    perform(plant(), cabinet, act);
  ticks(1);
  EXPECT_EQ(levels(), (std::array{true, false, false, true}));
  EXPECT_EQ(system.set_digital(contact, true), val3::kErrorWriteToInput);
  EXPECT_FALSE(system.signals().set("BasicIO-1\\%I1", true)) << "the cell has it";
}

TEST_F(Val3Cell, OtherLinksAreInputsAndOutputsByTheirNames) {
  const int output = system.find_digital("BasicIO-1\\%Q3").value();
  EXPECT_EQ(system.set_digital(output, true), val3::kErrorNone);
  EXPECT_TRUE(system.digital(output));
  const int input = system.find_digital("UserIO\\usrIn0").value();
  EXPECT_EQ(system.set_digital(input, true), val3::kErrorWriteToInput);
  EXPECT_FALSE(system.digital(input));
  EXPECT_TRUE(system.signals().set("UserIO\\usrIn0", true));
  EXPECT_TRUE(system.digital(input));
  const int level = system.find_analogue("ModbusSrv-0\\Analogs\\level").value();
  EXPECT_EQ(system.set_analogue(level, 2.5), val3::kErrorNone);
  EXPECT_EQ(system.analogue(level), 2.5);
  EXPECT_EQ(system.find_digital(""), std::nullopt);
}

TEST_F(Val3Cell, ASignalOfACardThatIsNotThereIsNotLinked) {
  EXPECT_EQ(system.find_digital("NoCard\\nothing"), std::nullopt);
  EXPECT_EQ(system.find_digital("BasicIO\\%I0"), std::nullopt) << "boards are counted";
  EXPECT_EQ(system.find_analogue("NoCard\\level"), std::nullopt);
  EXPECT_TRUE(system.find_digital("valve1")) << "a system signal stands without its card";
  EXPECT_TRUE(Val3Signals({}, {"NoCard"}).find_digital("NoCard\\nothing"));
}

TEST_F(Val3Cell, AScriptSetsNoSignalThatNobodyAskedFor) {
  EXPECT_FALSE(system.signals().set("BasicIO-1\\%I9", true));
  EXPECT_FALSE(system.signals().set("BasicIO-1\\%IW9", 1.0));
  EXPECT_EQ(system.signals().known_digital("BasicIO-1\\%I9"), std::nullopt);
}

}  // namespace
}  // namespace sim
