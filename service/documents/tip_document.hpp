#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/uncertainty/tip_uncertainty.hpp"

namespace cell {

/// `tip_uncertainty` of a result and of a plan: the predicted uncertainty of the tip, root mean square and
/// standard uncertainty but for `expanded`.
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

  /// k times the standard uncertainty over the workspace box.
  struct Expanded {
    double k = calib::kTipCoverageFactor;
    std::optional<double> box_rms_mm;
    std::optional<double> box_p95_mm;  // not exceeded in 95 % of the postures
    std::optional<double> box_max_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("k", self.k);
      fields("box_rms_mm", self.box_rms_mm);
      fields("box_p95_mm", self.box_p95_mm);
      fields("box_max_mm", self.box_max_mm);
    }
  };
  /// The same with the block's place nominal.
  struct ArmFrame {
    std::optional<double> at_block_rms_mm;
    std::optional<double> workspace_box_rms_mm;
    std::optional<double> joint_ranges_rms_mm;
    Expanded expanded;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("at_block_rms_mm", self.at_block_rms_mm);
      fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
      fields("joint_ranges_rms_mm", self.joint_ranges_rms_mm);
      fields("expanded", self.expanded);
    }
  };

  /// Standard uncertainty of the tip of an arm that is warmer than at the touches.
  struct Warmer {
    double rise_k = 0.0;
    std::optional<double> workspace_box_rms_mm;
    std::optional<double> joint_ranges_rms_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("rise_k", self.rise_k);
      fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
      fields("joint_ranges_rms_mm", self.joint_ranges_rms_mm);
    }
  };

  std::optional<double> at_block_rms_mm;
  std::optional<double> workspace_box_rms_mm;
  std::optional<double> joint_ranges_rms_mm;
  Expanded expanded;
  ArmFrame arm_frame;
  std::optional<Warmer> warmer;  // nothing where the arm's file does not say how it warms up
  std::vector<Source> sources;
  std::vector<Tool> tools;
  std::optional<Map> map;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("at_block_rms_mm", self.at_block_rms_mm);
    fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
    fields("joint_ranges_rms_mm", self.joint_ranges_rms_mm);
    fields("expanded", self.expanded);
    fields("arm_frame", self.arm_frame);
    fields("warmer", self.warmer);
    fields("sources", self.sources);
    fields("tools", self.tools);
    fields("map", self.map);
  }
};

}  // namespace cell
