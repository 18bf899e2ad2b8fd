// The tip's uncertainty in the document of a result.
#include "service/documents/tip_document.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "tests/service/document_shape.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

TEST(TipDocument, TheMapHasAValueOrNullForEachCellOfTheWorkspaceBox) {
  const json& map = result().at("tip_uncertainty").at("map");
  EXPECT_EQ(shape_of(map),
            (Shape{{"box", "object"}, {"counts", "array"}, {"cell_mm", "array"}, {"values_mm", "array"}}));
  std::size_t cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells *= map.at("counts")[axis].get<std::size_t>();
    const auto index = static_cast<Eigen::Index>(axis);
    EXPECT_NEAR(map.at("box").at("min_mm")[axis].get<double>(),
                calib::mm_from_metres(edf().workspace_box.min_m[index]), 1e-9);
    EXPECT_NEAR(map.at("box").at("max_mm")[axis].get<double>(),
                calib::mm_from_metres(edf().workspace_box.max_m[index]), 1e-9);
  }
  ASSERT_EQ(map.at("values_mm").size(), cells);
  const auto reached =
      std::ranges::count_if(map.at("values_mm"), [](const json& v) { return v.is_number(); });
  EXPECT_GT(reached, static_cast<std::ptrdiff_t>(cells / 2));
}

TEST(TipDocument, TheBudgetAddsUpToTheWorkspaceBoxsFigure) {
  const json& tip = result().at("tip_uncertainty");
  double squares = 0.0;
  for (const json& source : tip.at("sources"))
    squares += std::pow(source.at("workspace_box_rms_mm").get<double>(), 2);
  const double whole = tip.at("workspace_box_rms_mm").get<double>();
  EXPECT_GT(whole, 0.0);
  EXPECT_NEAR(std::sqrt(squares), whole, 1e-6 * whole);
}

TEST(TipDocument, TheExpandedUncertaintyIsTwiceTheStandardOne) {
  const json& tip = result().at("tip_uncertainty");
  for (const json& frame : {tip, tip.at("arm_frame")}) {
    const json& expanded = frame.at("expanded");
    EXPECT_EQ(expanded.at("k"), 2.0);
    const double rms = expanded.at("box_rms_mm").get<double>();
    EXPECT_NEAR(rms, 2.0 * frame.at("workspace_box_rms_mm").get<double>(), 1e-9 * rms);
    EXPECT_GE(expanded.at("box_p95_mm").get<double>(), rms);
    EXPECT_GE(expanded.at("box_max_mm"), expanded.at("box_p95_mm"));
  }
}
}  // namespace
}  // namespace cell
