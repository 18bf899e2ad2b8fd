#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/documents/parameter_document.hpp"
#include "service/documents/tip_document.hpp"
#include "service/documents/validation_document.hpp"
#include "service/documents/words.hpp"

namespace cell {

/// `decision_rule` of a verdict.
struct DecisionRuleDocument {
  struct CriterionFigures {
    std::string name;
    std::optional<int> plane;  // from 1
    std::optional<std::string> tool;
    std::string unit;
    std::optional<double> value;
    std::string side = "upper";  // of the limit: upper, lower
    std::optional<double> limit;
    std::optional<double> expanded_uncertainty;
    std::optional<bool> within_limit;
    std::optional<bool> proved;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("plane", self.plane);
      fields("tool", self.tool);
      fields("unit", self.unit);
      fields("value", self.value);
      fields("side", self.side);
      fields("limit", self.limit);
      fields("expanded_uncertainty", self.expanded_uncertainty);
      fields("within_limit", self.within_limit);
      fields("proved", self.proved);
    }
  };

  std::string standard;
  std::string rule;  // guarded, simple
  std::string text;
  std::optional<double> coverage_factor;
  std::vector<CriterionFigures> criteria;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("standard", self.standard);
    fields("rule", self.rule);
    fields("text", self.text);
    fields("coverage_factor", self.coverage_factor);
    fields("criteria", self.criteria);
  }
};

struct VerdictDocument {
  bool accepted = false;
  std::vector<std::string> reasons;
  std::optional<DecisionRuleDocument> decision_rule;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("accepted", self.accepted);
    fields("reasons", self.reasons);
    fields("decision_rule", self.decision_rule);
  }
};

/// touchcal/result/1 (service/doc/surfaces.md, section 5). One that an older daemon stored may lack fields:
/// they keep their defaults, and what has no value is unknown.
struct ResultDocument {
  struct RejectedTouch {
    int touch = 0;  // from 1
    std::optional<double> residual_mm;
    calib::RejectionReason reason = calib::RejectionReason::kOutlier;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touch", self.touch);
      fields("residual_mm", self.residual_mm);
      fields("reason", self.reason);
    }
  };
  struct Iteration {
    std::optional<double> condition_number;
    std::optional<double> scaled_condition_number;
    std::optional<double> residual_rms_mm;
    std::optional<double> step_norm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("condition_number", self.condition_number);
      fields("scaled_condition_number", self.scaled_condition_number);
      fields("residual_rms_mm", self.residual_rms_mm);
      fields("step_norm", self.step_norm);
    }
  };
  struct Rank {
    std::optional<int> attainable;
    std::optional<int> off_axis;
    std::string explanation;
    std::optional<double> smallest_kept;
    std::optional<double> largest_dropped;
    std::vector<double> singular_values;       // of the touches that the choice was made with, descending
    std::optional<double> singular_value_gap;  // of the last identified one over the next

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("attainable", self.attainable);
      fields("off_axis", self.off_axis);
      fields("explanation", self.explanation);
      fields("smallest_kept", self.smallest_kept);
      fields("largest_dropped", self.largest_dropped);
      fields("singular_values", self.singular_values);
      fields("singular_value_gap", self.singular_value_gap);
    }
  };
  /// Distances run along the outward normal from the origin, as those of the planes.
  struct TouchDistances {
    int touch = 0;  // from 1
    int plane = 0;  // from 1
    calib::TouchRole role = calib::TouchRole::kFit;
    std::optional<TouchUse> use;
    std::optional<double> nominal_mm;
    std::optional<double> calibrated_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touch", self.touch);
      fields("plane", self.plane);
      fields("role", self.role);
      fields("use", self.use);
      fields("nominal_mm", self.nominal_mm);
      fields("calibrated_mm", self.calibrated_mm);
    }
  };
  struct Scale {
    std::optional<std::string> source;  // block, two_lengths, prior
    std::optional<double> std_uncertainty_ppm;
    std::optional<double> stretch_ppm;
    std::optional<double> significance;
    std::optional<std::string> warning;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("source", self.source);
      fields("std_uncertainty_ppm", self.std_uncertainty_ppm);
      fields("stretch_ppm", self.stretch_ppm);
      fields("significance", self.significance);
      fields("warning", self.warning);
    }
  };
  /// Simulated calibrations; standard uncertainties as in `tip_uncertainty`.
  struct MonteCarlo {
    int count = 0;
    int converged = 0;
    std::optional<double> box_rms_mm;
    std::optional<double> box_p95_mm;  // of the tip errors
    std::optional<double> joint_ranges_rms_mm;
    std::optional<double> linear_over_monte_carlo;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("count", self.count);
      fields("converged", self.converged);
      fields("box_rms_mm", self.box_rms_mm);
      fields("box_p95_mm", self.box_p95_mm);
      fields("joint_ranges_rms_mm", self.joint_ranges_rms_mm);
      fields("linear_over_monte_carlo", self.linear_over_monte_carlo);
    }
  };
  struct PlaneFit {
    int plane = 0;  // from 1
    std::optional<double> p;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("plane", self.plane);
      fields("p", self.p);
    }
  };
  /// What was touched more than once, by how; no figures where a run has none of it.
  struct RepeatsSource {
    std::string source;  // reference_touches, two_speed, touched_again
    std::optional<double> noise_um;
    std::optional<double> degrees_of_freedom;
    bool used = false;  // in noise_repeats_um

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("source", self.source);
      fields("noise_um", self.noise_um);
      fields("degrees_of_freedom", self.degrees_of_freedom);
      fields("used", self.used);
    }
  };
  struct Fit {
    std::optional<double> noise_declared_um;
    std::optional<double> noise_estimated_um;
    std::optional<double> noise_used_um;
    std::optional<double> noise_repeats_um;  // nothing where no place was touched often enough
    std::optional<double> repeats_degrees_of_freedom;
    std::vector<RepeatsSource> repeats_sources;    // none in a result of an older daemon
    std::optional<double> gear_share;              // of the maker's variance of the gears
    std::optional<std::string> lack_of_fit_test;   // against the repeats: F, against the declared: chi-square
    std::optional<double> lack_of_fit_noise_um;    // what the residuals are tested against
    std::optional<double> lack_of_fit_repeats_um;  // of that, what repeats say
    std::optional<double> lack_of_fit_gears_um;    // of that, the maker's figures of the gears
    std::optional<double> droop_p;                 // of the test for a droop that is not in the model
    std::optional<double> droop_power;  // how often that test tells of a droop of one standard deviation
    std::optional<double> lack_of_fit_p;
    std::optional<double> degrees_of_freedom;
    std::vector<PlaneFit> planes;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("noise_declared_um", self.noise_declared_um);
      fields("noise_estimated_um", self.noise_estimated_um);
      fields("noise_used_um", self.noise_used_um);
      fields("noise_repeats_um", self.noise_repeats_um);
      fields("repeats_degrees_of_freedom", self.repeats_degrees_of_freedom);
      fields("repeats_sources", self.repeats_sources);
      fields("gear_share", self.gear_share);
      fields("lack_of_fit_test", self.lack_of_fit_test);
      fields("lack_of_fit_noise_um", self.lack_of_fit_noise_um);
      fields("lack_of_fit_repeats_um", self.lack_of_fit_repeats_um);
      fields("lack_of_fit_gears_um", self.lack_of_fit_gears_um);
      fields("droop_p", self.droop_p);
      fields("droop_power", self.droop_power);
      fields("lack_of_fit_p", self.lack_of_fit_p);
      fields("degrees_of_freedom", self.degrees_of_freedom);
      fields("planes", self.planes);
    }
  };

  static constexpr const char* kVerdictKey = "verdict";

  std::string schema = "touchcal/result/1";
  std::string arm;
  std::string recipe;
  std::optional<int> touch_count;
  bool complete = false;
  std::vector<int> cell_frames;
  std::vector<std::string> warnings;
  std::vector<RejectedTouch> rejected_touches;
  bool converged = false;
  std::vector<Iteration> iterations;
  std::optional<int> identifiable_count;
  std::optional<double> condition_number;
  std::optional<double> scaled_condition_number;
  std::vector<double> singular_values;
  Rank rank;
  std::vector<Parameter> parameters;
  std::vector<CorrelationOfErrors> correlations;
  std::vector<ArtefactParameter> artefact_parameters;
  std::vector<std::string> model;           // names of what was estimated beside the candidates
  std::optional<std::string> model_reason;  // why these; nothing where there was no choice
  std::vector<NongeometricParameter> nongeometric_parameters;
  std::vector<JointCompliance> stiffness;
  std::vector<PlaneDistances> planes;
  std::vector<PlaneDistances> planes_held_out;
  std::vector<PlaneDistances> planes_proof;
  std::vector<TouchDistances> touches;
  std::optional<RepetitionsDocument> validation;
  Scale scale;
  TipDocument tip_uncertainty;
  std::optional<MonteCarlo> monte_carlo;  // nothing where none was asked for
  Fit fit;
  VerdictDocument verdict;
  Carried<ConditionsDocument> conditions;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("arm", self.arm);
    fields("recipe", self.recipe);
    fields("touch_count", self.touch_count);
    fields("complete", self.complete);
    fields("cell_frames", self.cell_frames);
    fields("warnings", self.warnings);
    fields("rejected_touches", self.rejected_touches);
    fields("converged", self.converged);
    fields("iterations", self.iterations);
    fields("identifiable_count", self.identifiable_count);
    fields("condition_number", self.condition_number);
    fields("scaled_condition_number", self.scaled_condition_number);
    fields("singular_values", self.singular_values);
    fields("rank", self.rank);
    fields("parameters", self.parameters);
    fields("correlations", self.correlations);
    fields("artefact_parameters", self.artefact_parameters);
    fields("model", self.model);
    fields("model_reason", self.model_reason);
    fields("nongeometric_parameters", self.nongeometric_parameters);
    fields("stiffness", self.stiffness);
    fields("planes", self.planes);
    fields("planes_held_out", self.planes_held_out);
    fields("planes_proof", self.planes_proof);
    fields("touches", self.touches);
    fields("validation", self.validation);
    fields("scale", self.scale);
    fields("tip_uncertainty", self.tip_uncertainty);
    fields("monte_carlo", self.monte_carlo);
    fields("fit", self.fit);
    fields(kVerdictKey, self.verdict);
    fields("conditions", self.conditions);
  }
};

std::string document_text(const ResultDocument& document);

/// Takes what any version of the daemon stored; DocumentError when the text is no such document.
ResultDocument read_result(std::string_view text);

/// `verdict` of a result document as it stands there, its keys in alphabetical order.
std::string verdict_text(std::string_view result);

}  // namespace cell
