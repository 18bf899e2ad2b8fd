#include "service/setup/scene_drawing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "tests/service/setup/made_cell.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(SceneDrawing, HasEachBodyBoxAndFaceInThreeViews) {
  const Cell scene = setup_scene({}, arm_to_set_up("tx90"));
  pugi::xml_document drawn;
  ASSERT_TRUE(drawn.load_string(scene_svg(scene).c_str()));
  EXPECT_EQ(drawn.select_nodes("//g").size(), 3U);
  EXPECT_EQ(drawn.select_nodes("//polygon").size(), 3 * scene.block.faces.size());
  EXPECT_EQ(drawn.select_nodes("//path").size(), 3 * (scene.arm.bodies.size() + scene.probe.bodies.size()));
  EXPECT_EQ(drawn.select_nodes("//rect").size(),
            3 * (scene.block.solids.size() + scene.keep_out_boxes.size() + 1));
}

TEST(SceneDrawing, DrawsWhatItShowsInMillimetres) {
  SetupAnswers answers;
  answers.keep_out_boxes = {{"press", {100.0, -700.0, -50.0}, {300.0, -100.0, 250.0}}};
  pugi::xml_document drawn;
  ASSERT_TRUE(drawn.load_string(scene_svg(setup_scene(answers, arm_to_set_up("tx90"))).c_str()));
  const auto rects = drawn.select_nodes("//rect[title='press']");
  ASSERT_EQ(rects.size(), 3U);
  const pugi::xml_node above = rects[1].node();
  EXPECT_EQ(above.attribute("x").as_double(), 100.0);
  EXPECT_EQ(above.attribute("y").as_double(), -250.0) << "z goes up the page";
  EXPECT_EQ(above.attribute("width").as_double(), 200.0);
  EXPECT_EQ(above.attribute("height").as_double(), 300.0);
}

TEST(SceneDrawing, PageShowsItselfAnewWithRemarksAndTakesAnyName) {
  Cell scene = setup_scene({}, arm_to_set_up("tx90"));
  scene.name = "<script>\"&";
  const std::string page = scene_html(scene, {"a < b"});
  EXPECT_THAT(page, HasSubstr("http-equiv=\"refresh\""));
  EXPECT_THAT(page, HasSubstr("<li>a &lt; b</li>"));
  EXPECT_THAT(page, Not(HasSubstr("<script>")));
}

}  // namespace
}  // namespace cell
