#include "service/documents/schemas.hpp"

#include <array>

namespace cell {
namespace {

constexpr std::string_view kStatus = R"({
"type":"object",
"description":"What a supervisor polls. No field comes or goes; what is not known is null.",
"required":["state","waiting_for","run_id","recipe","touches_done","touches_total","plane","block_place","identifiable_count",
  "condition_number","predicted_tip_rms_mm","more_would_bring","eta_s","verdict","controller_connected",
  "controller_powered","controller_mode","controller_estop","controller_cell_closed","controller_touch_tested",
  "controller_permit","probe","retract_due","by_hand","by_hand_step","by_hand_plane","by_hand_index","by_hand_total",
  "by_hand_words","by_hand_problem","by_hand_joints_deg","fault_code","fault_message","fault_robot_action","fault_next_step",
  "warning_code","warning_message","reference_drift_mm","last_accepted_run_id","last_accepted_at","data_age_ms","mqtt_behind","mqtt_trouble","archive_behind",
  "archive_trouble","sequence","instance_id","since"],
"properties":{
  "state":{"enum":["STOPPED","RESETTING","IDLE","STARTING","EXECUTE","COMPLETING","COMPLETE","HOLDING","HELD",
    "UNHOLDING","SUSPENDING","SUSPENDED","UNSUSPENDING","STOPPING","ABORTING","ABORTED","CLEARING"]},
  "waiting_for":{"type":["string","null"]},
  "run_id":{"type":["string","null"]},
  "recipe":{"type":["string","null"]},
  "touches_done":{"type":"integer","minimum":0},
  "touches_total":{"type":["integer","null"],"minimum":1},
  "plane":{"type":["integer","null"],"minimum":1},
  "block_place":{"type":["string","null"],"description":"of a run at several places: where the block stands, or, in HELD by block_to_move, where it is to be brought"},
  "identifiable_count":{"type":["integer","null"],"minimum":0},
  "condition_number":{"type":["number","null"],"minimum":1},
  "predicted_tip_rms_mm":{"type":["number","null"],"minimum":0},
  "more_would_bring":{"type":["string","null"]},
  "eta_s":{"type":["number","null"],"minimum":0},
  "verdict":{"enum":["none","accepted","rejected","incomplete"]},
  "controller_connected":{"type":"boolean"},
  "controller_powered":{"type":["boolean","null"]},
  "controller_mode":{"type":["string","null"]},
  "controller_estop":{"type":["boolean","null"]},
  "controller_cell_closed":{"type":["boolean","null"]},
  "controller_touch_tested":{"type":["boolean","null"]},
  "controller_permit":{"type":["string","null"]},
  "probe":{"enum":["free","touched","fault",null]},
  "retract_due":{"type":["boolean","null"],
    "description":"the arm stands at a face after a touch that was broken off; it is taken back before anything else, after resume where a run is on hold, else after reset"},
  "by_hand":{"enum":["locate","guided","tool",null],
    "description":"what a person with the pendant does: finds the block, or makes a run's touches"},
  "by_hand_step":{"enum":["touch","undo","pass","passing",null],
    "description":"undo: the touches give no place; pass: one is found, locate once more goes around it"},
  "by_hand_plane":{"type":["integer","null"],"minimum":1,"description":"to touch next"},
  "by_hand_index":{"type":["integer","null"],"minimum":1,"description":"of the touch, from 1"},
  "by_hand_total":{"type":["integer","null"],"minimum":1},
  "by_hand_words":{"type":["string","null"],"description":"what to do, a sentence"},
  "by_hand_problem":{"type":["string","null"],"description":"why the last touch did not count, a sentence"},
  "by_hand_joints_deg":{"type":["array","null"],"items":{"type":"number"},"minItems":6,"maxItems":6,
    "description":"joint 1 first: roughly the posture that is asked for; guided touches only"},
  "reference_drift_mm":{"type":["number","null"]},
  "fault_code":{"type":["string","null"]},
  "fault_message":{"type":["string","null"]},
  "fault_robot_action":{"type":["string","null"]},
  "fault_next_step":{"type":["string","null"]},
  "warning_code":{"type":["string","null"]},
  "warning_message":{"type":["string","null"]},
  "last_accepted_run_id":{"type":["string","null"]},
  "last_accepted_at":{"type":["string","null"]},
  "data_age_ms":{"type":["integer","null"],"minimum":0},
  "mqtt_behind":{"type":["integer","null"],"minimum":0,
    "description":"facts that the broker has not confirmed; null without one. As the next three and the age of the data, no change of the status"},
  "mqtt_trouble":{"type":["string","null"],"description":"why the broker does not confirm them"},
  "archive_behind":{"type":["integer","null"],"minimum":0,"description":"the same of the archive"},
  "archive_trouble":{"type":["string","null"]},
  "sequence":{"type":"integer","minimum":0},
  "instance_id":{"type":"string"},
  "since":{"type":"string"}}})";

constexpr std::string_view kRun = R"({
"type":"object",
"required":["id","kind","of_run","recipe","touching","outcome","verdict","touches_done","touches_total","started_at","ended_at","fault_code",
  "fault_message"],
"properties":{
  "id":{"type":"string"},
  "kind":{"enum":["calibration","proof","check","qualification","tool"]},
  "of_run":{"type":["string","null"],"description":"the calibration that is proved or checked"},
  "recipe":{"type":"string"},
  "arm_moving_min":{"type":"number","minimum":0,"maximum":1440,
    "description":"minutes that the arm has moved at working speed before the run: kept with the result"},
  "touching":{"enum":["automatic","guided"],"description":"guided: a person made the touches"},
  "outcome":{"enum":["running","complete","stopped","aborted","interrupted"]},
  "verdict":{"enum":["none","accepted","rejected","incomplete"]},
  "touches_done":{"type":"integer","minimum":0},
  "touches_total":{"type":["integer","null"],"minimum":1},
  "started_at":{"type":"string"},
  "ended_at":{"type":["string","null"]},
  "fault_code":{"type":["string","null"]},
  "fault_message":{"type":["string","null"]},
  "conditions":{"type":["object","null"],"description":"What it was made under; in the document of one run"},
  "imported_from":{"type":["object","null"],"required":["cell","run_id","exported_at","imported_at","sha256"],
    "description":"of a run that another daemon made; in the document of one run"}}})";

constexpr std::string_view kRuns = R"({
"type":"object",
"required":["runs","damaged","next_before"],
"properties":{
  "runs":{"type":"array","items":{"$ref":"#/components/schemas/Run"}},
  "damaged":{"type":"array","description":"runs of this page whose rows in the database are damaged, so that nothing else is told of them",
    "items":{"type":"object","required":["id","detail"],"properties":{
      "id":{"type":"string"},
      "detail":{"type":"string","description":"file, table, run and remedy"}}}},
  "next_before":{"type":["string","null"],"description":"ask for the next page with before; null on the last"}}})";

constexpr std::string_view kStartRequest = R"({
"type":"object",
"description":"A recipe, or a plan of one that POST plan has made; or a proof or a check of an earlier calibration, whose recipe and choices it has; or a qualification of the probe, which has no recipe; or the touches of a tool, which a person makes.",
"additionalProperties":false,
"properties":{
  "recipe":{"type":"string"},
  "plan_id":{"type":"string"},
  "kind":{"enum":["calibration","proof","check","qualification","tool"],"description":"calibration if absent"},
  "of_run":{"type":"string","description":"of all but a calibration: the calibration that it is held against. If absent the newest accepted one, but for a proof the approved one where there is one"},
  "tool":{"type":"string","description":"of the kind tool: one of the cell's tools that have a tip"},
  "operator":{"type":"string","minLength":1,"maxLength":100},
  "block_temperature_c":{"type":"number","minimum":-50,"maximum":100,
    "description":"outranks that of the block's file; with its deviation, and with a recipe only"},
  "std_block_temperature_k":{"type":"number","exclusiveMinimum":0,"maximum":100},
  "block_temperature_at":{"type":"string","description":"when it was measured, RFC 3339 in UTC; now if absent"},
  "stiffness":{"enum":["on","off","auto"],
    "description":"whether the compliance of the joints is estimated, in place of the recipe's choice; with a recipe only"},
  "touching":{"enum":["automatic","guided"],"description":"guided: a person makes the touches; automatic if absent"}},
"dependentRequired":{"block_temperature_c":["std_block_temperature_k"],
  "std_block_temperature_k":["block_temperature_c"],"block_temperature_at":["block_temperature_c"]},
"anyOf":[{"required":["recipe"]},{"required":["plan_id"]},{"required":["kind"]}]})";

constexpr std::string_view kPlanRequest = R"({
"type":"object",
"additionalProperties":false,
"required":["recipe"],
"properties":{"recipe":{"type":"string"}}})";

constexpr std::string_view kProblem = R"({
"type":"object",
"description":"RFC 9457",
"required":["type","title","status","detail"],
"properties":{
  "type":{"type":"string","pattern":"^urn:touchcal:problem:"},
  "title":{"type":"string"},
  "status":{"type":"integer","minimum":400,"maximum":599},
  "detail":{"type":"string"},
  "pointer":{"type":"string","description":"the place in the body that is at fault"},
  "parameter":{"type":"string","description":"the query parameter that is at fault"},
  "errors":{"type":"array","items":{"type":"object","required":["code","detail"],
    "properties":{"code":{"type":"string"},"detail":{"type":"string"}}}},
  "exits":{"type":"array","items":{"type":"string"},"description":"commands that the state allows"}}})";

constexpr std::string_view kRecipes = R"({
"type":"object",
"required":["recipes","default"],
"properties":{
  "default":{"type":"string"},
  "recipes":{"type":"array","items":{"type":"object",
    "required":["name","description","planes","places","tips","fit_max","held_out","tip_rms_max_mm"],
    "properties":{
      "name":{"type":"string"},
      "description":{"type":"string"},
      "planes":{"type":"array","items":{"type":"integer","minimum":1}},
      "places":{"type":"array","items":{"type":"string"},"description":"to which the block is brought after the first one; its planes are numbered on there"},
      "tips":{"type":"array","items":{"type":"string"},"description":"of a star stylus, that touch beside the first one at each place; the planes are numbered on for each"},
      "fit_max":{"type":"integer","minimum":0},
      "held_out":{"type":"integer","minimum":0},
      "tip_rms_max_mm":{"type":["number","null"]}}}}}})";

constexpr std::string_view kCell = R"({
"type":"object",
"required":["name","arm","block","place","probe","tool_tips","default_recipe","workspace_box","keep_out_boxes","nominal_miss_mm",
  "touch_noise_mm","acceptance","scene","controller","confirm_s"],
"properties":{
  "name":{"type":"string"},
  "tool_tips":{"type":"array","items":{"type":"string"},"description":"tools that can touch the block themselves: what a run of the kind tool takes"},
  "arm":{"type":"string"},
  "block":{"type":"object","required":["name","temperature_c","std_temperature_k","temperature_at","faces","places"],"properties":{
    "name":{"type":"string"},
    "temperature_c":{"type":["number","null"],"description":"as the block's file has it"},
    "std_temperature_k":{"type":["number","null"]},
    "temperature_at":{"type":["string","null"],"description":"when it was measured; null: it always holds"},
    "places":{"type":"array","description":"where else it can stand: R_-1 there in R_-1 of the first place","items":{"type":"object",
      "required":["name","is_known","shift_mm","turn_deg"],"properties":{
      "name":{"type":"string"},"is_known":{"type":"boolean","description":"false: the touches find it"},
      "shift_mm":{"type":"array","items":{"type":"number"}},"turn_deg":{"type":"array","items":{"type":"number"},"description":"rotation vector"}}}},
    "faces":{"type":"array","items":{"type":"object","required":["plane","shape","outward","offset_mm","center_mm",
      "edge_u","half_extent_mm"],"properties":{
      "shape":{"enum":["plane","sphere","bore"]},
      "bore":{"type":"object","description":"of a bore; the plane beside it touches the middle of the wall that may be touched; depths are below the mouth, which axis points out of",
        "required":["mouth_mm","axis","radius_mm","depth_mm","wall_half_angle_deg"]},
      "sphere":{"type":"object","description":"of a sphere; the plane beside it touches the pole of what may be touched",
        "required":["center_mm","radius_mm","cap_half_angle_deg"]}}}}}},
  "place":{"type":["object","null"],
    "description":"where the block was located, against the cell's file; null: where the file has it",
    "properties":{
      "located_at":{"type":"string"},
      "shift_mm":{"type":"array","items":{"type":"number"}},
      "std_shift_mm":{"type":"array","items":{"type":"number"}},
      "turn_deg":{"type":"array","items":{"type":"number"},"description":"rotation vector"},
      "std_turn_deg":{"type":"array","items":{"type":"number"}},
      "touch_count":{"type":"integer","minimum":0}}},
  "probe":{"type":"object","required":["name","tip_is_contact_point","stylus_radius_mm","pretravel_mm","tips"],"properties":{
    "pretravel_tilt_mm":{"type":["number","null"],"description":"what a push from the side adds to the pre-travel; null: nobody says"},
    "std_pretravel_tilt_mm":{"type":["number","null"]},
    "lobes_mm":{"type":["number","null"],"description":"three lobes about the stylus; null: nobody says"},
    "std_lobes_mm":{"type":["number","null"]},
    "lobe_direction_deg":{"type":["number","null"],"description":"of one of the lobes; null without any"},
    "tips":{"type":"array","description":"of a star stylus, beside the first one: the balls by the drawing","items":{"type":"object",
      "required":["name","center_mm","radius_mm"],"properties":{
      "name":{"type":"string"},
      "center_mm":{"type":"array","items":{"type":"number"},"description":"in R_7"},
      "radius_mm":{"type":"number"}}}}}},
  "default_recipe":{"type":"string"},
  "workspace_box":{"type":"object"},
  "keep_out_boxes":{"type":"array","items":{"type":"object"}},
  "nominal_miss_mm":{"type":"number"},
  "touch_noise_mm":{"type":"number"},
  "acceptance":{"type":"object","properties":{
    "tip_box_max_by_recipe_mm":{"type":"object","description":"in place of tip_box_max_mm, by the name of a recipe",
      "additionalProperties":{"type":"number"}},
    "proof_rms_max_mm":{"type":["number","null"],"description":"of a proof; null: 0.030"},
    "probe":{"type":"object","description":"of a qualification; null: no limit, of the scatter: touch_noise_mm","properties":{
      "scatter_max_mm":{"type":["number","null"]},
      "run_out_max_mm":{"type":["number","null"]},
      "lobes_max_mm":{"type":["number","null"]},
      "step_max_mm":{"type":["number","null"]}}}}},
  "scene":{"type":"object","description":"what the cell looks like, in R_-1; bodies in the frame that they move with; a solid has holes (center_mm, axis, radius_mm), which go through it",
    "required":["frames","gains","arm_bodies","probe_bodies","solids","park_joints_deg"]},
  "controller":{"type":"string"},
  "confirm_s":{"type":"number","description":"for how long the confirmation at the cell is awaited"}}})";

constexpr std::string_view kJoints = R"({
"type":"object",
"required":["joints_deg","data_age_ms","sequence","instance_id"],
"properties":{
  "joints_deg":{"type":["array","null"],"items":{"type":"number"},"description":"six, joint 1 first"},
  "data_age_ms":{"type":["integer","null"],"minimum":0},
  "sequence":{"type":"integer","minimum":0,"description":"of the status"},
  "instance_id":{"type":"string"}}})";

constexpr std::string_view kFaults = R"({
"type":"object",
"required":["faults"],
"properties":{"faults":{"type":"array","items":{"type":"object",
  "required":["code","kind","cause","robot_action","next_step"],
  "properties":{
    "code":{"type":"string"},
    "kind":{"enum":["refused","warning","held","suspended","aborted"]},
    "cause":{"type":"string"},
    "robot_action":{"type":"string"},
    "next_step":{"type":"string"}}}}}})";

constexpr std::string_view kHealth = R"({
"type":"object",
"required":["status"],
"properties":{
  "status":{"enum":["ok","ready"]},
  "remarks":{"type":"array","items":{"type":"string"},
    "description":"of readiness: what keeps no run from starting, as a broker or an archive that is not reached"}}})";

constexpr std::string_view kAccess = R"({
"type":"object",
"required":["role"],
"properties":{"role":{"enum":["operate","view","none","wrong token"]}}})";

constexpr std::string_view kAudit = R"({
"type":"object",
"required":["rows","next_before"],
"properties":{
  "rows":{"type":"array","items":{
    "type":"object",
    "required":["id","at","role","token","operator","remote","action","outcome","detail","hash"],
    "properties":{
      "id":{"type":"string"},
      "at":{"type":"string"},
      "role":{"enum":["engineer","operate","view","session over","none","wrong token"]},
      "token":{"type":["string","null"],"description":"the name of the token, where it has one, or of the user"},
      "operator":{"type":["string","null"],"description":"of the run that the request is for"},
      "remote":{"type":"string"},
      "action":{"type":"string"},
      "outcome":{"type":"string","description":"asked: before it is executed; else the status of the answer"},
      "detail":{"type":"string"},
      "hash":{"type":"string","description":"SHA-256 of the hash of the row before and of this row"}}}},
  "next_before":{"type":["string","null"],"description":"ask for the next page with before; null on the last"}}})";

constexpr std::string_view kModels = R"({
"type":"object",
"required":["models","next_before"],
"properties":{
  "models":{"type":"array","items":{
    "type":"object",
    "required":["id","kind","run_id","hash","by","at","valid_until","current","applied_to"],
    "properties":{
      "id":{"type":"string"},
      "kind":{"enum":["approved","rolled_back","applied"]},
      "run_id":{"type":"string","description":"of the model that was approved, taken back or applied"},
      "hash":{"type":"string","description":"of that model"},
      "by":{"type":["string","null"],"description":"the operator who was named"},
      "at":{"type":"string"},
      "valid_until":{"type":["string","null"]},
      "current":{"type":"boolean","description":"the approval by which its model is the cell's"},
      "applied_to":{"type":["string","null"],"description":"of an application: what uses the model"}}}},
  "next_before":{"type":["string","null"],"description":"ask for the next page with before; null on the last"}}})";

constexpr std::string_view kApprovalRequest = R"({
"type":"object",
"additionalProperties":false,
"properties":{
  "operator":{"type":"string","minLength":1,"maxLength":100},
  "valid_days":{"type":"integer","minimum":1,"maximum":36500,"description":"from now; without it no end is set"}}})";

constexpr std::string_view kRollbackRequest = R"({
"type":"object",
"additionalProperties":false,
"properties":{"operator":{"type":"string","minLength":1,"maxLength":100}}})";

constexpr std::string_view kApplicationRequest = R"({
"type":"object",
"required":["to"],
"additionalProperties":false,
"properties":{
  "to":{"type":"string","minLength":1,"maxLength":200,"description":"what uses the model, as a person names it"},
  "hash":{"type":"string","minLength":12,"description":"of a model that was approved, or its first twelve digits; without it of the one that is the cell's"},
  "operator":{"type":"string","minLength":1,"maxLength":100}}})";

constexpr std::string_view kOpenApi = R"({
"type":"object",
"required":["openapi","info","paths","components"],
"properties":{"openapi":{"const":"3.1.0"}}})";

constexpr std::array kDaemonSchemas{DocumentSchema{"Status", kStatus},
                                    DocumentSchema{"Run", kRun},
                                    DocumentSchema{"Runs", kRuns},
                                    DocumentSchema{"StartRequest", kStartRequest},
                                    DocumentSchema{"PlanRequest", kPlanRequest},
                                    DocumentSchema{"Problem", kProblem},
                                    DocumentSchema{"Recipes", kRecipes},
                                    DocumentSchema{"Cell", kCell},
                                    DocumentSchema{"Joints", kJoints},
                                    DocumentSchema{"Faults", kFaults},
                                    DocumentSchema{"Health", kHealth},
                                    DocumentSchema{"Access", kAccess},
                                    DocumentSchema{"Audit", kAudit},
                                    DocumentSchema{"Models", kModels},
                                    DocumentSchema{"ApprovalRequest", kApprovalRequest},
                                    DocumentSchema{"RollbackRequest", kRollbackRequest},
                                    DocumentSchema{"ApplicationRequest", kApplicationRequest},
                                    DocumentSchema{"OpenApi", kOpenApi}};

}  // namespace

std::span<const DocumentSchema> daemon_schemas() { return kDaemonSchemas; }

}  // namespace cell
