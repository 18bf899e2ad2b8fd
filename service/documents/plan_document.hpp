#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/parameter_document.hpp"
#include "service/documents/tip_document.hpp"
#include "service/documents/words.hpp"

namespace cell {

/// touchcal/plan/1 (service/doc/surfaces.md, section 6): what is predicted, what limits it, and every step of
/// every touch.
struct PlanDocument {
  using Joints = std::vector<double>;  // in degrees

  struct Goal {
    std::string criterion;
    std::optional<double> tip_rms_max_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("criterion", self.criterion);
      fields("tip_rms_max_mm", self.tip_rms_max_mm);
    }
  };
  struct TouchesOfPlane {
    int plane = 0;                     // from 1
    std::optional<std::string> place;  // another one than the first
    std::optional<std::string> tip;    // likewise
    int fit = 0;
    int held_out = 0;
    std::optional<int> proof;  // of a proof or a check

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("plane", self.plane);
      fields.if_set("place", self.place);
      fields.if_set("tip", self.tip);
      fields("fit", self.fit);
      fields("held_out", self.held_out);
      fields.if_set("proof", self.proof);
    }
  };
  /// The way to the park posture, where the arm waits for the block to be brought to the next place.
  struct Leaving {
    int touches = 0;  // of the plan, made before it
    std::vector<Joints> via_joints_deg;
    std::optional<double> travel_s;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touches", self.touches);
      fields("via_joints_deg", self.via_joints_deg);
      fields("travel_s", self.travel_s);
    }
  };
  /// A cause of the predicted tip error in the workspace box.
  struct Cause {
    std::string source;
    std::optional<double> workspace_box_rms_mm;  // from this source alone
    std::optional<double> share_percent;         // of the error's square

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("source", self.source);
      fields("workspace_box_rms_mm", self.workspace_box_rms_mm);
      fields("share_percent", self.share_percent);
    }
  };
  struct Obstruction {
    std::string reason;
    int count = 0;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("reason", self.reason);
      fields("count", self.count);
    }
  };
  struct Effort {
    int plane = 0;  // from 1
    int tried = 0;  // postures
    int feasible = 0;
    std::vector<Obstruction> obstructions;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("plane", self.plane);
      fields("tried", self.tried);
      fields("feasible", self.feasible);
      fields("obstructions", self.obstructions);
    }
  };
  struct Limits {
    std::vector<std::string> words;
    std::vector<Cause> accuracy;
    std::vector<Effort> postures;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("words", self.words);
      fields("accuracy", self.accuracy);
      fields("postures", self.postures);
    }
  };
  struct SpeedsOfArm {
    std::optional<double> travel_mm_s;
    std::optional<double> approach_mm_s;
    std::optional<double> search_mm_s;
    std::optional<double> second_mm_s;
    std::optional<double> second_backoff_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("travel_mm_s", self.travel_mm_s);
      fields("approach_mm_s", self.approach_mm_s);
      fields("search_mm_s", self.search_mm_s);
      fields("second_mm_s", self.second_mm_s);
      fields("second_backoff_mm", self.second_backoff_mm);
    }
  };
  /// At `joints_deg` the nominal arm's ball touches the nominal face.
  struct Touch {
    int plane = 0;                     // from 1
    std::optional<std::string> place;  // another one than the first
    std::optional<std::string> tip;    // likewise
    calib::TouchRole role = calib::TouchRole::kFit;
    Joints joints_deg;
    std::vector<Joints> via_joints_deg;
    Joints clear_joints_deg;
    Joints approach_joints_deg;
    std::array<double, 3> search_direction{};
    double search_length_mm = 0.0;
    Joints search_end_joints_deg;
    double tilt_deg = 0.0;
    double predicted_miss_mm = 0.0;
    std::optional<double> travel_s;
    std::optional<double> touch_s;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("plane", self.plane);
      fields.if_set("place", self.place);
      fields.if_set("tip", self.tip);
      fields("role", self.role);
      fields("joints_deg", self.joints_deg);
      fields("via_joints_deg", self.via_joints_deg);
      fields("clear_joints_deg", self.clear_joints_deg);
      fields("approach_joints_deg", self.approach_joints_deg);
      fields("search_direction", self.search_direction);
      fields("search_length_mm", self.search_length_mm);
      fields("search_end_joints_deg", self.search_end_joints_deg);
      fields("tilt_deg", self.tilt_deg);
      fields("predicted_miss_mm", self.predicted_miss_mm);
      fields("travel_s", self.travel_s);
      fields("touch_s", self.touch_s);
    }
  };

  std::string schema = "touchcal/plan/1";
  std::optional<std::string> plan_id;
  std::string cell;
  std::string arm;
  std::string recipe;
  Goal goal;
  int touch_count = 0;
  std::vector<TouchesOfPlane> planes;
  int identifiable_count = 0;
  std::optional<double> condition_number;
  std::optional<double> scaled_condition_number;
  TipDocument tip_uncertainty;
  std::vector<PlannedParameter> parameters;
  std::vector<PlannedArtefactParameter> artefact_parameters;
  std::optional<double> duration_s;
  Limits limits;
  std::vector<std::string> warnings;
  SpeedsOfArm speeds;
  Joints park_joints_deg;
  std::vector<Touch> touches;
  std::vector<Joints> park_via_joints_deg;
  std::optional<double> park_s;
  std::optional<std::vector<Leaving>> leaving;  // of a recipe with several places

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("plan_id", self.plan_id);
    fields("cell", self.cell);
    fields("arm", self.arm);
    fields("recipe", self.recipe);
    fields("goal", self.goal);
    fields("touch_count", self.touch_count);
    fields("planes", self.planes);
    fields("identifiable_count", self.identifiable_count);
    fields("condition_number", self.condition_number);
    fields("scaled_condition_number", self.scaled_condition_number);
    fields("tip_uncertainty", self.tip_uncertainty);
    fields("parameters", self.parameters);
    fields("artefact_parameters", self.artefact_parameters);
    fields("duration_s", self.duration_s);
    fields("limits", self.limits);
    fields("warnings", self.warnings);
    fields("speeds", self.speeds);
    fields("park_joints_deg", self.park_joints_deg);
    fields("touches", self.touches);
    fields("park_via_joints_deg", self.park_via_joints_deg);
    fields("park_s", self.park_s);
    fields.if_set("leaving", self.leaving);
  }
};

std::string document_text(const PlanDocument& document);

/// DocumentError when the text is no plan.
PlanDocument read_plan(std::string_view text);

}  // namespace cell
