#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace cell {

/// `tip_uncertainty` of a result and of a plan: the predicted uncertainty of the tip, root mean square.
struct TipDocument {
  struct Source {
    std::string name;
    std::optional<double> workspace_box_rms_mm;  // from this source alone

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
    }
  };
  struct Tool {
    std::string name;
    std::optional<double> workspace_box_rms_mm;
    std::optional<double> joint_ranges_rms_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
      fields("joint_ranges_rms_mm", self.joint_ranges_rms_mm);
    }
  };
  struct Box {
    std::string name;
    std::array<double, 3> min_mm{};
    std::array<double, 3> max_mm{};

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("min_mm", self.min_mm);
      fields("max_mm", self.max_mm);
    }
  };
  /// Order of cells: x fastest, then y, then z; no value where the arm cannot reach.
  struct Map {
    Box box;
    std::array<int, 3> counts{};
    std::array<double, 3> cell_mm{};
    std::vector<std::optional<double>> values_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("box", self.box);
      fields("counts", self.counts);
      fields("cell_mm", self.cell_mm);
      fields("values_mm", self.values_mm);
    }
  };

  std::optional<double> at_block_rms_mm;
  std::optional<double> workspace_box_rms_mm;
  std::optional<double> joint_ranges_rms_mm;
  std::vector<Source> sources;
  std::vector<Tool> tools;
  std::optional<Map> map;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("at_block_rms_mm", self.at_block_rms_mm);
    fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
    fields("joint_ranges_rms_mm", self.joint_ranges_rms_mm);
    fields("sources", self.sources);
    fields("tools", self.tools);
    fields("map", self.map);
  }
};

}  // namespace cell
