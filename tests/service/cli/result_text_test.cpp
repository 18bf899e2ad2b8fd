#include "service/cli/result_text.hpp"

#include <gmock/gmock.h>

#include "service/run/fault_table.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

StatusDocument held_by(FaultCode code) {
  const FaultEntry& entry = describe(code);
  StatusDocument status;
  status.state = State::kHeld;
  status.run_id = "7";
  status.block_place = "stand";
  status.fault_code = entry.name;
  status.fault_message = std::string(entry.cause) + ": to \"stand\", into its dowels";
  status.fault_robot_action = entry.robot_action;
  status.fault_next_step = entry.next_step;
  return status;
}

TEST(StatusText, ABlockThatIsToBeMovedIsSomethingToDoAndNoFault) {
  const StatusDocument status = held_by(FaultCode::kBlockToMove);
  EXPECT_TRUE(is_block_to_move(status));
  EXPECT_THAT(
      status_text(status),
      AllOf(HasSubstr("to do       the block is to be brought to another place: to \"stand\", into"),
            HasSubstr("touchcal resume"), Not(HasSubstr("fault ")), Not(HasSubstr("block       at"))));
}

TEST(StatusText, AFaultOfARunAtTwoPlacesSaysWhereTheBlockStands) {
  const StatusDocument status = held_by(FaultCode::kNoContact);
  EXPECT_FALSE(is_block_to_move(status));
  EXPECT_THAT(status_text(status),
              AllOf(HasSubstr("block       at stand\n"), HasSubstr("fault       no_contact: ")));
}

TEST(ResultText, APlaneAtAFurtherPlaceIsNamedWithIt) {
  ResultDocument result;
  result.planes = {{.plane = 2, .touch_count = 25}, {.plane = 8, .place = "stand", .touch_count = 25}};
  result.fit.lack_of_fit_p = 0.5;
  result.fit.planes = {{.plane = 2, .p = 0.25}, {.plane = 8, .p = 0.75}};
  ArtefactParameter& turn = result.artefact_parameters.emplace_back();
  turn.name = "place_stand_turn_x";
  turn.unit = "rad";
  turn.value = 1e-5;
  turn.std_uncertainty = 2e-5;
  EXPECT_THAT(result_text(result),
              AllOf(HasSubstr("%  at stand\n"), HasSubstr("; plane 2 0.25, 8 (stand) 0.75"),
                    HasSubstr("place_stand_turn_x     0.000010    0.000020  rad")));
}

TEST(ResultText, APlaneThatAFurtherTipTouchesIsNamedWithIt) {
  ResultDocument result;
  result.planes = {{.plane = 8, .tip = "left"},
                   {.plane = 20, .place = "stand", .tip = "left", .estimated_offset_mm = 75.0}};
  result.fit.lack_of_fit_p = 0.5;
  result.fit.planes = {{.plane = 20, .p = 0.75}};
  result.tip_uncertainty.sources = {{.name = "stylus_tips", .workspace_box_rms_mm = 0.004}};
  ArtefactParameter& center = result.artefact_parameters.emplace_back();
  center.name = "tip_left_x";
  center.unit = "mm";
  center.value = 40.1;
  center.std_uncertainty = 0.01;
  EXPECT_THAT(result_text(result),
              AllOf(HasSubstr("%  tip left\n"), HasSubstr("%  at stand, tip left  found at 75.000 mm\n"),
                    HasSubstr("; plane 20 (stand, tip left) 0.75"),
                    HasSubstr("tip_left_x           40.1000      0.0100  mm"),
                    HasSubstr("from stylus_tips                     0.004 mm")));
}

}  // namespace
}  // namespace cell
