#include <array>

#include "service/documents/schemas.hpp"

namespace cell {
namespace {

constexpr std::string_view kProof = R"({
"type":"object",
"description":"Touches of the block at another place, never fitted, against a calibration",
"required":["schema","arm","of_run","touch_count","complete","verdict","rms_mm","rms_max_mm","chi_square","degrees_of_freedom","p",
  "p_min","noise_um","moved_mm","turned_deg","power","touches","conditions"],
"properties":{
  "schema":{"const":"touchcal/proof/1"},
  "arm":{"type":"string"},
  "of_run":{"type":"string","description":"the calibration"},
  "touch_count":{"type":"integer","minimum":0},
  "complete":{"type":"boolean"},
  "verdict":{"$ref":"#/components/schemas/VerificationVerdict"},
  "rms_mm":{"type":["number","null"],"description":"distance from the block at the pose that fits best"},
  "rms_max_mm":{"type":["number","null"]},
  "chi_square":{"type":["number","null"]},
  "degrees_of_freedom":{"type":["number","null"]},
  "p":{"type":["number","null"]},
  "p_min":{"type":["number","null"]},
  "noise_um":{"type":["number","null"],"description":"of a touch, as the calibration measured it"},
  "moved_mm":{"type":["array","null"],"minItems":3,"maxItems":3,"description":"the block since the calibration, in R_-1 then"},
  "turned_deg":{"type":["array","null"],"minItems":3,"maxItems":3,"description":"rotation vector"},
  "power":{"type":"array","items":{"type":"object","required":["alternative","power"],
    "description":"the probability to see something that moves the tip by 0.1 mm"}},
  "touches":{"type":"array","items":{"type":"object","required":["touch","plane","distance_mm"]}},
  "conditions":{"type":["object","null"]}}})";

constexpr std::string_view kCheck = R"({
"type":"object",
"description":"The touches of the first checks of a calibration once more, against their mean",
"required":["schema","arm","of_run","touch_count","complete","verdict","reference","chi_square","degrees_of_freedom","p","joint_p",
  "p_min","rms_mm","noise_um","cause","joint","joints","growth_ppm","std_growth_ppm","warmer_k","touches","conditions"],
"properties":{
  "schema":{"const":"touchcal/check/1"},
  "arm":{"type":"string"},
  "of_run":{"type":"string","description":"the calibration"},
  "touch_count":{"type":"integer","minimum":0},
  "complete":{"type":"boolean"},
  "verdict":{"$ref":"#/components/schemas/VerificationVerdict"},
  "reference":{"type":"object","required":["count","needed"]},
  "chi_square":{"type":["number","null"]},
  "degrees_of_freedom":{"type":["number","null"]},
  "p":{"type":["number","null"]},
  "joint_p":{"type":["number","null"],"description":"of the most striking joint"},
  "p_min":{"type":["number","null"],"description":"of each of the two"},
  "rms_mm":{"type":["number","null"]},
  "noise_um":{"type":["number","null"],"description":"of a touch, as the reference scatters"},
  "cause":{"enum":["joint","block","stylus","unknown",null],"description":"of an alarm"},
  "joint":{"type":["integer","null"],"minimum":2,"maximum":5},
  "joints":{"type":"array","items":{"type":"object","required":["joint","offset_mrad","std_offset_mrad"],
    "description":"as if it alone had changed"}},
  "growth_ppm":{"type":["number","null"],"description":"of the arm since the reference"},
  "std_growth_ppm":{"type":["number","null"]},
  "warmer_k":{"type":["number","null"]},
  "every_days":{"type":"integer","minimum":1,"description":"how often the cell's file wants a check; left out where it does not say"},
  "touches":{"type":"array","items":{"type":"object","required":["touch","plane","change_mm"]}},
  "conditions":{"type":["object","null"]}}})";

constexpr std::string_view kQualification = R"({
"type":"object",
"description":"What the probe is like: repeats of one touch, eight turns of the stylus about itself, known lengths of the block",
"required":["schema","arm","probe","of_run","no_of_run","touch_count","complete","verdict","scatter","run_out","lobes","change","lengths",
  "criteria","touches","conditions"],
"properties":{
  "schema":{"const":"touchcal/qualification/1"},
  "arm":{"type":"string"},
  "probe":{"type":"string"},
  "of_run":{"type":["string","null"],"description":"the calibration that it was held against"},
  "no_of_run":{"type":["string","null"],"description":"why there is none"},
  "touch_count":{"type":"integer","minimum":0},
  "complete":{"type":"boolean"},
  "verdict":{"$ref":"#/components/schemas/VerificationVerdict"},
  "scatter":{"type":"object","required":["std_um","degrees_of_freedom","low_um","high_um"],
    "description":"of the repeats; the true one is between low and high in 95 of 100"},
  "run_out":{"$ref":"#/components/schemas/AcrossStylus"},
  "lobes":{"$ref":"#/components/schemas/AcrossStylus"},
  "change":{"$ref":"#/components/schemas/AcrossStylus"},
  "lengths":{"type":"array","description":"certified ones, as the calibrated arm measures them",
    "items":{"type":"object","required":["planes","known_mm","error_mm","std_mm","p"],"properties":{
      "planes":{"type":"array","items":{"type":"integer"},"minItems":2,"maxItems":2}}}},
  "criteria":{"type":"array","items":{"type":"object","required":["name","unit","value","limit","expanded","passed"],"properties":{
    "name":{"type":"string","description":"scatter, run_out, lobes, turns, stylus, or length_3_5 of planes 3 and 5"},
    "unit":{"enum":["mm","p"],"description":"p: a probability, whose limit is the least"},
    "value":{"type":["number","null"]},
    "limit":{"type":["number","null"],"description":"null: none in the cell's file"},
    "expanded":{"type":["number","null"],"description":"uncertainty of the value, k = 2"},
    "passed":{"type":"boolean"}}}},
  "touches":{"type":"array","items":{"type":"object","required":["touch","plane","joint_6_deg","deviation_mm"]}},
  "conditions":{"type":["object","null"]}}})";

constexpr std::string_view kToolSchema = R"({
"type":"object",
"description":"Where the tip of a tool is on the calibrated arm, from touches of the block with that tip; positions in R_6",
"required":["schema","arm","tool","of_run","touch_count","complete","verdict","drawn_mm","position_mm","std_position_mm","off_drawing_mm",
  "arm_errors","box_rms_mm","world_box_rms_mm","box_rms_max_mm","rms_mm","chi_square","degrees_of_freedom","p","p_min","touches","conditions"],
"properties":{
  "schema":{"const":"touchcal/tool/1"},
  "arm":{"type":"string"},
  "tool":{"type":"string"},
  "of_run":{"type":"string","description":"the calibration whose arm touched"},
  "touch_count":{"type":"integer","minimum":0},
  "complete":{"type":"boolean"},
  "verdict":{"$ref":"#/components/schemas/VerificationVerdict"},
  "drawn_mm":{"type":"array","items":{"type":"number"},"minItems":3,"maxItems":3},
  "position_mm":{"type":["array","null"],"items":{"type":"number"},"minItems":3,"maxItems":3},
  "std_position_mm":{"type":["array","null"],"items":{"type":"number"},"minItems":3,"maxItems":3},
  "off_drawing_mm":{"type":["number","null"]},
  "arm_errors":{"type":"array","description":"of the arm with this tool, beside those of the calibration",
    "items":{"type":"object","required":["name","unit","error"],"properties":{"unit":{"enum":["mm","rad"]}}}},
  "box_rms_mm":{"type":["number","null"],"description":"predicted error of the touched tip over the workspace box"},
  "world_box_rms_mm":{"type":["number","null"],"description":"the same in the controller's world"},
  "box_rms_max_mm":{"type":["number","null"],"description":"null: no limit in the cell's file"},
  "rms_mm":{"type":["number","null"],"description":"of the touches from their planes"},
  "chi_square":{"type":["number","null"]},
  "degrees_of_freedom":{"type":["number","null"]},
  "p":{"type":["number","null"]},
  "p_min":{"type":["number","null"]},
  "touches":{"type":"array","items":{"type":"object","required":["touch","plane","distance_mm"]}},
  "conditions":{"type":["object","null"]}}})";

constexpr std::string_view kAcrossStylus = R"({
"type":"object",
"description":"Across the stylus, in R_7; run_out: the ball from where the cell's files have it; lobes: amplitude and direction of one of the three; change: the ball from where the calibrated arm has it",
"required":["size_mm","std_mm","direction_deg"],
"properties":{
  "size_mm":{"type":["number","null"]},
  "std_mm":{"type":["number","null"]},
  "direction_deg":{"type":["number","null"]}}})";

constexpr std::string_view kVerificationVerdict = R"({
"type":"object",
"required":["accepted","reasons"],
"properties":{
  "accepted":{"type":["boolean","null"],"description":"null: no verdict, and the reasons say why"},
  "reasons":{"type":"array","items":{"type":"string"}}}})";

constexpr std::string_view kVerificationReport = R"({
"type":"object",
"required":["schema","kind","cell","touchcal_version","run","raw_data","touched_again","refused_contacts","faults","calibration",
  "touches","conditions","result","checks"],
"properties":{
  "schema":{"const":"touchcal/verification-report/1"},
  "kind":{"enum":["proof","check","qualification","tool"]},
  "cell":{"type":"string","description":"its name"},
  "run":{"type":"object","required":["id","recipe","operator","started_at","ended_at","outcome","verdict"]},
  "raw_data":{"type":"object","required":["sha256","of"]},
  "refused_contacts":{"type":"array","description":"what the controller measured and the daemon refused",
    "items":{"type":"object","required":["sequence","joints_deg","reason","at"]}},
  "calibration":{"type":"object","required":["id","recipe","started_at","ended_at","verdict","raw_data_sha256"],
    "description":"that the run is of; all but id null where it is no longer stored, id too of a qualification that was held against none"},
  "touches":{"type":"array","items":{"type":"object","required":["touch","plane","role","joints_deg","deviation_mm"],
    "description":"deviation_mm: distance_mm of a proof's result, change_mm of a check's, deviation_mm of a qualification's"}},
  "conditions":{"type":["object","null"]},
  "result":{"type":["object","null"],"description":"touchcal/proof/1, touchcal/check/1 or touchcal/qualification/1 as stored"},
  "checks":{"type":["object","null"],"description":"of a check: touchcal/checks/1 of its calibration up to this one"}}})";

constexpr std::string_view kChecks = R"({
"type":"object",
"description":"The checks of a calibration, each figure from check to check, with the limits of chance",
"required":["schema","of_run","count","reference","base","every_days","due_at","overdue","warnings","checks","charts"],
"properties":{
  "schema":{"const":"touchcal/checks/1"},
  "of_run":{"type":"string"},
  "count":{"type":"integer","minimum":0,"description":"of all its checks; below are the newest of them"},
  "reference":{"type":"object","required":["count","needed"],"properties":{"count":{"type":"integer"},"needed":{"type":"integer"}}},
  "base":{"type":"object","required":["count","needed"],"properties":{"count":{"type":"integer"},"needed":{"type":"integer"}},
    "description":"checks without an alarm that the limits are from"},
  "every_days":{"type":["integer","null"],"description":"of the cell's file; null: no such rule, or the calibration was replaced"},
  "due_at":{"type":["string","null"],"description":"null with every_days: not known, the clock being behind the newest check"},
  "overdue":{"type":["boolean","null"]},
  "warnings":{"type":"array","items":{"type":"string"}},
  "checks":{"type":"array","items":{
    "type":"object",
    "required":["run","ended_at","operator","reference","accepted","cause","joint"],
    "properties":{
      "run":{"type":"string"},
      "ended_at":{"type":"string"},
      "operator":{"type":["string","null"]},
      "reference":{"type":"boolean"},
      "accepted":{"type":["boolean","null"],"description":"null: no verdict"},
      "cause":{"enum":["joint","block","stylus","unknown",null]},
      "joint":{"type":["integer","null"]}}}},
  "charts":{"type":"array","items":{
    "type":"object",
    "required":["quantity","unit","centre","points"],
    "properties":{
      "quantity":{"enum":["joint_2","joint_3","joint_4","joint_5","growth","residual"]},
      "unit":{"enum":["mrad","ppm","mm"]},
      "centre":{"type":["number","null"],"description":"null until the base is whole"},
      "points":{"type":"array","items":{
        "type":"object",
        "required":["run","value","weighted_mean","shewhart_limit","ewma_limit","beyond_shewhart","beyond_ewma"],
        "properties":{
          "run":{"type":"string"},
          "value":{"type":["number","null"]},
          "shewhart_limit":{"type":["number","null"],"minimum":0},
          "weighted_mean":{"type":["number","null"],"description":"null too of a check that alarms"},
          "ewma_limit":{"type":["number","null"],"minimum":0},
          "beyond_shewhart":{"type":"boolean"},
          "beyond_ewma":{"type":"boolean"}}}}}}}}})";

constexpr std::string_view kComparison = R"({
"type":"object",
"description":"Two calibrations of one arm, by the independent combinations of errors that both identified",
"required":["schema","earlier","later","verdict","p_min","growth_ppm","std_growth_ppm","tip_difference_mm","std_tip_difference_mm","arm","tool"],
"properties":{
  "schema":{"const":"touchcal/comparison/1"},
  "earlier":{"type":"string"},
  "later":{"type":"string"},
  "verdict":{"$ref":"#/components/schemas/VerificationVerdict"},
  "p_min":{"type":"number","description":"of each part: what is less likely is no chance"},
  "growth_ppm":{"type":["number","null"]},
  "std_growth_ppm":{"type":["number","null"]},
  "tip_difference_mm":{"type":["number","null"],"description":"rms over the workspace box, the block's place apart"},
  "std_tip_difference_mm":{"type":["number","null"],"description":"what chance alone makes of it"},
  "arm":{"$ref":"#/components/schemas/ComparedPart"},
  "tool":{"$ref":"#/components/schemas/ComparedPart"}}})";

constexpr std::string_view kComparedPart = R"({
"type":"object",
"required":["changed","p","chi_square","degrees_of_freedom","combinations"],
"properties":{
  "changed":{"type":["boolean","null"],"description":"null: nothing of it was identified by both"},
  "p":{"type":["number","null"]},
  "chi_square":{"type":["number","null"]},
  "degrees_of_freedom":{"type":["number","null"]},
  "combinations":{"type":"array","description":"the most striking first","items":{
    "type":"object",
    "required":["e_n","shares"],
    "properties":{
      "e_n":{"type":["number","null"],"description":"the difference by its expanded uncertainty, k = 2"},
      "shares":{"type":"array","items":{"type":"object","required":["parameter","share"],"properties":{
        "parameter":{"type":"string"},
        "share":{"type":["number","null"],"minimum":-1,"maximum":1}}}}}}}}})";

constexpr std::array kVerificationSchemas{DocumentSchema{"Proof", kProof},
                                          DocumentSchema{"Check", kCheck},
                                          DocumentSchema{"Qualification", kQualification},
                                          DocumentSchema{"Tool", kToolSchema},
                                          DocumentSchema{"AcrossStylus", kAcrossStylus},
                                          DocumentSchema{"VerificationVerdict", kVerificationVerdict},
                                          DocumentSchema{"VerificationReport", kVerificationReport},
                                          DocumentSchema{"Checks", kChecks},
                                          DocumentSchema{"Comparison", kComparison},
                                          DocumentSchema{"ComparedPart", kComparedPart}};

}  // namespace

std::span<const DocumentSchema> verification_schemas() { return kVerificationSchemas; }

}  // namespace cell
