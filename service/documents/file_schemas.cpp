#include <array>

#include "service/documents/schemas.hpp"

namespace cell {
namespace {

constexpr std::string_view kTouches = R"({
"type":"object",
"required":["schema","arm","touches"],
"properties":{
  "schema":{"enum":["touchcal/touches/1","touchcal/touches/2","touchcal/touches/3","touchcal/touches/4"]},
  "arm":{"type":"string"},
  "touches":{"type":"array","items":{"type":"object","required":["plane","joints_deg"],"properties":{
    "plane":{"type":"integer","minimum":1},
    "role":{"enum":["fit","held_out","proof"]},
    "joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"}},
    "noise_um":{"type":"number","minimum":0.001,"maximum":5000,
      "description":"one standard deviation of this touch along the normal, where it is not the cell's touch_noise_mm; from version 2 on"},
    "at_s":{"type":"number","minimum":0,"description":"seconds since the first touch; from version 3 on"},
    "first_joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"},
      "description":"the first contact of a two-speed touch; from version 3 on"},
    "again_joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"},
      "description":"the contact of a repetition that agreed with this touch; from version 3 on"}}}},
  "reference_touches":{"type":"array","items":{"type":"object","required":["plane","joints_deg"],"properties":{
    "plane":{"type":"integer","minimum":1},
    "at_s":{"type":"number","minimum":0,"description":"seconds since the first touch, not decreasing; from version 3 on"},
    "joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"}}}}},
  "qualification":{"type":"object","required":["scatter_um","degrees_of_freedom"],"description":"of the qualification that counts; from version 4 on",
    "properties":{"scatter_um":{"type":"number"},"degrees_of_freedom":{"type":"number","minimum":1}}}}})";

constexpr std::string_view kResult = R"({
"type":"object",
"required":["schema","arm","touch_count","complete","warnings","rejected_touches","converged","iterations",
  "identifiable_count","condition_number","scaled_condition_number","singular_values","parameters",
  "artefact_parameters","model","model_reason","nongeometric_parameters","planes","planes_held_out","planes_proof","scale","touches","validation","tip_uncertainty","monte_carlo","fit","verdict","conditions"],
"properties":{
  "schema":{"const":"touchcal/result/1"},
  "arm":{"type":"string"},
  "touch_count":{"type":"integer","minimum":0},
  "complete":{"type":"boolean"},
  "warnings":{"type":"array","items":{"type":"string"}},
  "rejected_touches":{"type":"array","items":{"type":"object","required":["touch","residual_mm","reason"],
    "properties":{
      "touch":{"type":"integer","minimum":1},
      "residual_mm":{"type":["number","null"]},
      "reason":{"enum":["outlier","wrong_plane"]}}}},
  "converged":{"type":"boolean"},
  "iterations":{"type":"array","items":{"type":"object",
    "required":["condition_number","scaled_condition_number","residual_rms_mm","step_norm"]}},
  "identifiable_count":{"type":"integer","minimum":0},
  "condition_number":{"type":["number","null"]},
  "scaled_condition_number":{"type":["number","null"]},
  "singular_values":{"type":"array","items":{"type":"number"}},
  "rank":{"type":"object","required":["singular_values","singular_value_gap"],"properties":{
    "singular_values":{"type":"array","items":{"type":["number","null"]},
      "description":"of W of the touches that the choice of columns was made with, each moved onto its nominal plane; descending"},
    "singular_value_gap":{"type":["number","null"],"description":"that of the last identified parameter over the next"}}},
  "parameters":{"type":"array","minItems":37,"items":{"type":"object",
    "required":["name","frame","kind","group","unit","nominal","status","error","std_uncertainty","grouped_with"],
    "properties":{
      "name":{"type":"string"},
      "frame":{"type":"integer","minimum":0,"maximum":7},
      "group":{"enum":["place","arm","tool"]},
      "unit":{"enum":["mm","rad"]},
      "nominal":{"type":"number"},
      "status":{"enum":["identified","grouped","no_effect","excluded","weak"]},
      "error":{"type":["number","null"]},
      "std_uncertainty":{"type":["number","null"]},
      "grouped_with":{"type":"array"}}}},
  "artefact_parameters":{"type":"array","items":{"type":"object","required":["name","unit","value","status"]}},
  "model":{"type":"array","items":{"type":"string"}},
  "model_reason":{"type":["string","null"]},
  "nongeometric_parameters":{"type":"array","items":{"type":"object",
    "required":["name","unit","value","std_uncertainty","status"],"properties":{
      "name":{"type":"string"},
      "unit":{"enum":["rad/Nm","rad","1"]},
      "value":{"type":["number","null"]},
      "std_uncertainty":{"type":["number","null"]},
      "status":{"enum":["identified","prior"]}}}},
  "planes":{"$ref":"#/components/schemas/Distances"},
  "planes_held_out":{"$ref":"#/components/schemas/Distances"},
  "planes_proof":{"$ref":"#/components/schemas/Distances"},
  "touches":{"type":"array","items":{"type":"object",
    "required":["touch","plane","role","use","nominal_mm","calibrated_mm"],
    "properties":{
      "touch":{"type":"integer","minimum":1},
      "plane":{"type":"integer","minimum":1},
      "role":{"enum":["fit","held_out","proof"]},
      "use":{"enum":["used","rejected"]},
      "nominal_mm":{"type":["number","null"]},
      "calibrated_mm":{"type":["number","null"]}}}},
  "validation":{"type":["object","null"],"required":["same_touches","other_touches"]},
  "scale":{"type":"object","required":["source","std_uncertainty_ppm","warning"],"properties":{
    "source":{"enum":["block","two_lengths","prior",null]},
    "std_uncertainty_ppm":{"type":["number","null"]},
    "warning":{"type":["string","null"]}}},
  "tip_uncertainty":{"$ref":"#/components/schemas/TipUncertainty"},
  "monte_carlo":{"type":["object","null"],
    "required":["count","converged","box_rms_mm","box_p95_mm","joint_ranges_rms_mm","linear_over_monte_carlo"],
    "properties":{
      "count":{"type":"integer","minimum":100,"maximum":1000000},
      "converged":{"type":"integer","minimum":0},
      "box_rms_mm":{"type":["number","null"],"minimum":0},
      "box_p95_mm":{"type":["number","null"],"minimum":0},
      "joint_ranges_rms_mm":{"type":["number","null"],"minimum":0},
      "linear_over_monte_carlo":{"type":["number","null"],"minimum":0}}},
  "fit":{"type":"object","required":["noise_declared_um","noise_estimated_um","lack_of_fit_p"],"properties":{
      "noise_declared_um":{"type":["number","null"],"minimum":0},
      "noise_estimated_um":{"type":["number","null"],"minimum":0},
      "noise_used_um":{"type":["number","null"],"minimum":0},
      "noise_repeats_um":{"type":["number","null"],"minimum":0},
      "repeats_degrees_of_freedom":{"type":["number","null"],"minimum":0},
      "repeats_sources":{"type":"array","description":"what noise_repeats_um is made of",
        "items":{"type":"object","required":["source","noise_um","degrees_of_freedom","used"],"properties":{
          "source":{"enum":["reference_touches","two_speed","touched_again","qualification"]},
          "noise_um":{"type":["number","null"],"minimum":0},
          "degrees_of_freedom":{"type":["number","null"],"minimum":0},
          "used":{"type":"boolean"}}}},
      "gear_share":{"type":["number","null"],"minimum":0},
      "lack_of_fit_noise_um":{"type":["number","null"],"minimum":0},
      "lack_of_fit_repeats_um":{"type":["number","null"],"minimum":0},
      "lack_of_fit_gears_um":{"type":["number","null"],"minimum":0},
      "lack_of_fit_p":{"type":["number","null"],"minimum":0,"maximum":1},
      "droop_p":{"type":["number","null"],"minimum":0,"maximum":1},
      "droop_power":{"type":["number","null"],"minimum":0,"maximum":1},
      "degrees_of_freedom":{"type":["number","null"],"minimum":0},
      "lack_of_fit_test":{"enum":["F","chi_square",null]},
      "planes":{"type":"array","items":{"type":"object","required":["plane","p"]}}}},
  "verdict":{"type":"object","required":["accepted","reasons"],"properties":{
    "accepted":{"type":"boolean"},
    "reasons":{"type":"array","items":{"type":"string"}},
    "decision_rule":{"type":"object","required":["standard","rule","text","coverage_factor","criteria"],"properties":{
      "standard":{"type":"string"},
      "rule":{"enum":["simple","guarded"]},
      "criteria":{"type":"array","items":{"type":"object",
        "required":["name","plane","tool","unit","value","side","limit","expanded_uncertainty","within_limit","proved"]}}}}}},
  "conditions":{"type":"object",
    "required":["operator","config_digest","block_temperature_c","block","probe","versions","controller_session"],
    "properties":{
      "arm_serial":{"type":["string","null"],"description":"of the robot, from the cell's file"},
      "controller_serial":{"type":["string","null"]},
      "block_temperature_c":{"type":["number","null"]},
      "std_temperature_k":{"type":["number","null"]},
      "thermal_expansion_per_k":{"type":["number","null"]},
      "block_temperature_source":{"enum":["file","run",null],"description":"run: given with its start"},
      "block_temperature_at":{"type":["string","null"],"description":"when it was measured"},
      "arm_moving_min":{"type":["number","null"],"minimum":0,"description":"how long the arm had moved before the run"}}}}})";

constexpr std::string_view kDistances = R"({
"type":"array",
"items":{"type":"object",
  "required":["plane","reference_mm","estimated_offset_mm","nominal_mean_mm","calibrated_mean_mm","error_removed_percent",
    "nominal_agreement_percent","nominal_rms_mm","calibrated_rms_mm"],
  "properties":{"plane":{"type":"integer","minimum":1},"reference_mm":{"type":["number","null"]},
    "estimated_offset_mm":{"type":["number","null"],"description":"where a face was found that is estimated in place"}}}})";

constexpr std::string_view kTipUncertainty = R"({
"type":"object",
"required":["at_block_rms_mm","workspace_box_rms_mm","joint_ranges_rms_mm","expanded","arm_frame","warmer"],
"properties":{
  "warmer":{"type":["object","null"],"required":["rise_k","workspace_box_rms_mm","joint_ranges_rms_mm"],"properties":{
    "rise_k":{"type":"number","minimum":0},
    "workspace_box_rms_mm":{"type":["number","null"]},
    "joint_ranges_rms_mm":{"type":["number","null"]}}},
  "at_block_rms_mm":{"type":["number","null"]},
  "workspace_box_rms_mm":{"type":["number","null"]},
  "joint_ranges_rms_mm":{"type":["number","null"]},
  "expanded":{"$ref":"#/components/schemas/ExpandedTipUncertainty"},
  "arm_frame":{"type":"object",
    "required":["at_block_rms_mm","workspace_box_rms_mm","joint_ranges_rms_mm","expanded"],"properties":{
      "at_block_rms_mm":{"type":["number","null"]},
      "workspace_box_rms_mm":{"type":["number","null"]},
      "joint_ranges_rms_mm":{"type":["number","null"]},
      "expanded":{"$ref":"#/components/schemas/ExpandedTipUncertainty"}}}}})";

constexpr std::string_view kExpandedTipUncertainty = R"({
"type":"object",
"required":["k","box_rms_mm","box_p95_mm","box_max_mm"],
"properties":{
  "k":{"const":2},
  "box_rms_mm":{"type":["number","null"],"minimum":0},
  "box_p95_mm":{"type":["number","null"],"minimum":0},
  "box_max_mm":{"type":["number","null"],"minimum":0}}})";

constexpr std::string_view kPlan = R"({
"type":"object",
"required":["schema","plan_id","recipe","condition_number","scaled_condition_number","tip_uncertainty","duration_s",
  "touches"],
"properties":{
  "schema":{"const":"touchcal/plan/1"},
  "plan_id":{"type":["string","null"]},
  "recipe":{"type":"string"},
  "condition_number":{"type":["number","null"]},
  "scaled_condition_number":{"type":["number","null"]},
  "tip_uncertainty":{"$ref":"#/components/schemas/TipUncertainty"},
  "duration_s":{"type":["number","null"]},
  "touches":{"type":"array","items":{"type":"object",
    "required":["plane","role","joints_deg","approach_joints_deg","search_direction","search_length_mm"],
    "properties":{
      "plane":{"type":"integer","minimum":1},
      "role":{"enum":["fit","held_out","proof"]},
      "joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"}},
      "approach_joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"}},
      "search_direction":{"type":"array","minItems":3,"maxItems":3,"items":{"type":"number"}},
      "search_length_mm":{"type":"number"}}}}}})";

constexpr std::string_view kArm = R"({
"type":"object",
"description":"An arm's file, with what was identified",
"required":["schema","name","frames"],
"properties":{
  "schema":{"enum":["touchcal/arm/5","touchcal/arm/4","touchcal/arm/3"],
    "description":"4: where the cell's file names no robot; 3: of an earlier daemon"},
  "name":{"type":"string"},
  "serial":{"type":"string","description":"of the robot that was calibrated; from version 5 on"},
  "frames":{"type":"array","minItems":8,"maxItems":8,"items":{"type":"object"}},
  "uncertainty":{"type":"object","required":["errors","covariance_si"],
    "description":"of the errors that are left, in the arm's own frame; absent where one of any size is possible",
    "properties":{
      "errors":{"type":"array","items":{"type":"string"}},
      "covariance_si":{"type":"array","description":"lower triangle",
        "items":{"type":"array","items":{"type":"number"}}}}}}})";

constexpr std::string_view kReport = R"({
"type":"object",
"required":["schema","touchcal_version","run","raw_data","touches","touched_again","reference_touches","faults","result","proofs"],
"properties":{
  "schema":{"const":"touchcal/report/1"},
  "run":{"type":"object","required":["id","recipe","operator","started_at","ended_at","outcome","verdict"]},
  "raw_data":{"type":"object","required":["sha256","of"]},
  "touches":{"type":"array","items":{"type":"object","required":["touch","plane","role","joints_deg","use"]}},
  "refused_contacts":{"type":"array","description":"what the controller measured and the daemon refused",
    "items":{"type":"object","required":["sequence","joints_deg","reason","at"]}},
  "proofs":{"type":"array","description":"of this calibration, the oldest first",
    "items":{"type":"object","required":["run","ended_at","verdict"]}},
  "result":{"type":["object","null"]}}})";

constexpr std::string_view kTargets = R"({
"type":"object",
"required":["schema","tool","targets"],
"properties":{
  "schema":{"enum":["touchcal/targets/1","touchcal/targets/2"]},
  "line_max_mm":{"type":"number","minimum":0.001,"maximum":10,
    "description":"how far the tool may be off a straight line; default 0.02; from version 2 on"},
  "tool":{"type":"string","description":"stylus, or a tool of the cell"},
  "targets":{"type":"array","minItems":1,"maxItems":100000,"items":{"type":"object","required":["name"],
    "description":"joints_deg, or position_mm, rotation_deg and near_joints_deg",
    "properties":{
      "name":{"type":"string","description":"at most 64 bytes, without commas and quotes; each once"},
      "joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"},
        "description":"the pose that the nominal arm has there"},
      "position_mm":{"type":"array","minItems":3,"maxItems":3,"items":{"type":"number"}},
      "rotation_deg":{"type":"array","minItems":3,"maxItems":3,"items":{"type":"number"},
        "description":"about x, then the new y, then the new z"},
      "near_joints_deg":{"type":"array","minItems":6,"maxItems":6,"items":{"type":"number"}},
      "frame":{"type":"string","description":"world, the default, or one of the target_frames of the cell's file"},
      "move":{"enum":["joint","line"],
        "description":"line: from the target before it on a straight line of the tool's centre; from version 2 on"}}}}}})";

constexpr std::string_view kCompensated = R"({
"type":"object",
"required":["schema","model","warmth","targets"],
"properties":{
  "schema":{"enum":["touchcal/compensated/1","touchcal/compensated/2"],"description":"2: for targets of version 2"},
  "model":{"type":"string","description":"SHA-256 of the calibrated arm"},
  "touched":{"type":"object","required":["from","position_mm"],
    "description":"where the tool's tip was touched, in R_6, in place of its drawing; not there: as drawn"},
  "warmth":{"type":["object","null"],"required":["check_run_id","at","growth_ppm"],
    "description":"the growth that a check found, where it was applied too"},
  "targets":{"type":"array","items":{"type":"object",
    "required":["name","status","joints_deg","moved_mm","residual_um","tip_uncertainty_mm","reason"],
    "properties":{
      "name":{"type":"string"},
      "status":{"enum":["ok","warned","refused"]},
      "joints_deg":{"type":["array","null"],"minItems":6,"maxItems":6,"items":{"type":"number"}},
      "moved_mm":{"type":["number","null"],"minimum":0},
      "residual_um":{"type":["number","null"],"minimum":0},
      "tip_uncertainty_mm":{"type":["number","null"],"minimum":0},
      "reason":{"type":["string","null"]},
      "inserted":{"type":"boolean","description":"a point that a straight line needs; from version 2 on"},
      "line_deviation_mm":{"type":["number","null"],"minimum":0,
        "description":"at the end of a straight line how far the tool is off it at most; from version 2 on"}}}}}})";

constexpr std::string_view kModel = R"({
"type":"object",
"description":"The model of a run as a person approved it; it never changes.",
"required":["schema","hash","run_id","approved_by","approved_at","valid_until","proof_run_id","arm","arm_serial",
  "controller_serial","config_digest","arm_moving_min","block_temperature_c","tip_uncertainty","parameters",
  "nongeometric_parameters"],
"properties":{
  "schema":{"const":"touchcal/model/1"},
  "hash":{"type":"string","description":"SHA-256 over the touches of the run as stored, the digest of the cell's files, the stored arm and the run's id"},
  "run_id":{"type":"string"},
  "approved_by":{"type":["string","null"],"description":"the operator who was named"},
  "approved_at":{"type":"string"},
  "valid_until":{"type":["string","null"],"description":"null: no end was set"},
  "proof_run_id":{"type":["string","null"],"description":"null: the model is not proved"},
  "arm":{"type":"string"},
  "arm_serial":{"type":["string","null"]},
  "controller_serial":{"type":["string","null"]},
  "config_digest":{"type":["string","null"]},
  "arm_moving_min":{"type":["number","null"],"description":"minutes that the arm had moved before the run: how warm it was"},
  "block_temperature_c":{"type":["number","null"]},
  "tip_uncertainty":{"type":["object","null"],"description":"as in the run's result"},
  "parameters":{"type":["array","null"],"description":"likewise"},
  "nongeometric_parameters":{"type":["array","null"],"description":"likewise"}}})";

constexpr std::string_view kRunFile = R"({
"type":"object",
"description":"A run that is over with all that is stored of it; joints in 10^-6 degrees, documents as texts",
"required":["schema","touchcal_version","cell","exported_at","run","touches","superseded_touches","reference_touches",
  "plan_changes","refused_contacts","plan","result","arm","model","sha256"],
"properties":{
  "schema":{"const":"touchcal/run-file/1"},
  "cell":{"type":"string"},
  "run":{"type":"object"},
  "touches":{"type":"array","items":{"type":"object"}},
  "plan":{"type":["string","null"],"description":"touchcal/plan/1"},
  "result":{"type":["string","null"]},
  "arm":{"type":["string","null"],"description":"the calibrated arm as an arm file"},
  "model":{"type":["string","null"],"description":"touchcal/model/1, as it was approved last"},
  "sha256":{"type":"string","description":"of this document without white space and with an empty text here"}}})";

constexpr std::string_view kRunResult = R"({
"description":"by the kind of the run",
"oneOf":[{"$ref":"#/components/schemas/Result"},{"$ref":"#/components/schemas/Proof"},{"$ref":"#/components/schemas/Check"}]})";

constexpr std::string_view kRunReport = R"({
"description":"by the kind of the run",
"oneOf":[{"$ref":"#/components/schemas/Report"},{"$ref":"#/components/schemas/VerificationReport"}]})";

constexpr std::array kFileSchemas{DocumentSchema{"Touches", kTouches},
                                  DocumentSchema{"RunFile", kRunFile},
                                  DocumentSchema{"RunResult", kRunResult},
                                  DocumentSchema{"RunReport", kRunReport},
                                  DocumentSchema{"Result", kResult},
                                  DocumentSchema{"Distances", kDistances},
                                  DocumentSchema{"TipUncertainty", kTipUncertainty},
                                  DocumentSchema{"ExpandedTipUncertainty", kExpandedTipUncertainty},
                                  DocumentSchema{"Plan", kPlan},
                                  DocumentSchema{"Arm", kArm},
                                  DocumentSchema{"Model", kModel},
                                  DocumentSchema{"Report", kReport},
                                  DocumentSchema{"Targets", kTargets},
                                  DocumentSchema{"Compensated", kCompensated}};

}  // namespace

std::span<const DocumentSchema> file_schemas() { return kFileSchemas; }

}  // namespace cell
