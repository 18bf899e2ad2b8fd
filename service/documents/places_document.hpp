#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "service/documents/tip_document.hpp"

namespace cell {

/// touchcal/places/1: the places tried, best first, each with what is predicted there, or why there is no
/// plan.
struct PlacesDocument {
  /// The changed values of a frame, as in the arm's file; frame 1 has more of them than frame 0.
  struct Frame {
    int j = 0;
    std::optional<double> alpha_rad;
    std::optional<double> d_mm;
    std::optional<double> theta_offset_rad;
    std::optional<double> theta_rad;
    double r_mm = 0.0;
    std::optional<double> beta_rad;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("j", self.j);
      fields.if_set("alpha_rad", self.alpha_rad);
      fields.if_set("d_mm", self.d_mm);
      fields.if_set("theta_offset_rad", self.theta_offset_rad);
      fields.if_set("theta_rad", self.theta_rad);
      fields("r_mm", self.r_mm);
      fields.if_set("beta_rad", self.beta_rad);
    }
  };
  struct Place {
    std::array<double, 3> shift_mm{};
    double yaw_deg = 0.0;
    bool present = false;  // where the block is now
    bool feasible = false;
    bool fully_planned = false;
    std::optional<std::string> reason;
    std::optional<double> workspace_box_rms_mm;
    std::optional<double> joint_ranges_rms_mm;
    std::optional<double> condition_number;
    std::optional<double> duration_s;
    std::optional<int> touch_count;
    std::array<Frame, 2> frames;
    std::vector<TipDocument::Box> keep_out_boxes;
    TipDocument::Box workspace_box;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("shift_mm", self.shift_mm);
      fields("yaw_deg", self.yaw_deg);
      fields("present", self.present);
      fields("feasible", self.feasible);
      fields("fully_planned", self.fully_planned);
      fields("reason", self.reason);
      fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
      fields("joint_ranges_rms_mm", self.joint_ranges_rms_mm);
      fields("condition_number", self.condition_number);
      fields("duration_s", self.duration_s);
      fields("touch_count", self.touch_count);
      fields("frames", self.frames);
      fields("keep_out_boxes", self.keep_out_boxes);
      fields("workspace_box", self.workspace_box);
    }
  };

  std::string schema = "touchcal/places/1";
  std::string cell;
  std::string recipe;
  std::vector<Place> places;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("cell", self.cell);
    fields("recipe", self.recipe);
    fields("places", self.places);
  }
};

std::string document_text(const PlacesDocument& document);

}  // namespace cell
