#include "service/documents/fleet_document.hpp"

#include <array>
#include <span>

#include "service/documents/internal/document_fields.hpp"
#include "service/documents/schemas.hpp"

namespace cell {
namespace {

constexpr std::string_view kFleet = R"({
"type":"object",
"required":["schema","cells"],
"properties":{
  "schema":{"const":"touchcal/fleet/1"},
  "cells":{"type":"array","items":{
    "type":"object",
    "required":["cell","last_event_at","heard_at","state","arm","arm_serial","last_run_id","recipe","outcome","verdict","ended_at","model","approved_at",
      "valid_until","model_over","tip_box_max_mm","applied_model","applied_at","applied_to","last_proof_at","last_proof_verdict","last_check_at",
      "last_check_verdict","last_check_cause","check_due_at","check_overdue","certificate_artefact","certificate_valid_until","certificate_over","last_fault_code","last_fault_at"],
    "properties":{
      "cell":{"type":"string"},
      "last_event_at":{"type":"string"},
      "heard_at":{"type":"string","description":"when the archive got it, by the archive's clock"},
      "state":{"enum":["running","idle",null],"description":"running: a run was started and has not ended"},
      "arm":{"type":["string","null"],"description":"its type"},
      "arm_serial":{"type":["string","null"]},
      "last_run_id":{"type":["string","null"],"description":"of the last calibration that ended"},
      "recipe":{"type":["string","null"]},
      "outcome":{"type":["string","null"]},
      "verdict":{"type":["string","null"]},
      "ended_at":{"type":["string","null"]},
      "model":{"type":["string","null"],"description":"hash of the one that is the cell's"},
      "approved_at":{"type":["string","null"]},
      "valid_until":{"type":["string","null"]},
      "model_over":{"type":"boolean","description":"its time is, by the archive's clock"},
      "tip_box_max_mm":{"type":["number","null"],"description":"expanded uncertainty of the tip at the worst in the workspace box"},
      "applied_model":{"type":["string","null"],"description":"hash of the one that is in use, as a person said last"},
      "applied_at":{"type":["string","null"]},
      "applied_to":{"type":["string","null"]},
      "last_proof_at":{"type":["string","null"]},
      "last_proof_verdict":{"type":["string","null"]},
      "last_check_at":{"type":["string","null"]},
      "last_check_verdict":{"type":["string","null"]},
      "last_check_cause":{"type":["string","null"]},
      "check_due_at":{"type":["string","null"],"description":"the next one"},
      "check_overdue":{"type":"boolean","description":"by the archive's clock"},
      "certificate_artefact":{"type":["string","null"],"description":"of the first that ends soon, of those that were not renewed"},
      "certificate_valid_until":{"type":["string","null"]},
      "certificate_over":{"type":"boolean","description":"it has ended, by the archive's clock"},
      "last_fault_code":{"type":["string","null"]},
      "last_fault_at":{"type":["string","null"]}}}}}})";

constexpr std::string_view kFleetTrends = R"({
"type":"object",
"required":["schema","trends"],
"properties":{
  "schema":{"const":"touchcal/fleet-trends/1"},
  "trends":{"type":"array","items":{
    "type":"object",
    "required":["arm","month","cells","calibrations","rejected","approved","tip_box_max_mm","checks","alarms","growth_ppm","proofs",
      "failed_proofs","faults"],
    "properties":{
      "arm":{"type":["string","null"],"description":"the type; null for cells that never said theirs"},
      "month":{"type":"string","description":"YYYY-MM, by the clock of each cell"},
      "cells":{"type":"integer","minimum":0},
      "calibrations":{"type":"integer","minimum":0},
      "rejected":{"type":"integer","minimum":0},
      "approved":{"type":"integer","minimum":0},
      "tip_box_max_mm":{"type":["number","null"],"description":"median of the models that were approved"},
      "checks":{"type":"integer","minimum":0},
      "alarms":{"type":"integer","minimum":0},
      "growth_ppm":{"type":["number","null"],"description":"median of the checks"},
      "proofs":{"type":"integer","minimum":0},
      "failed_proofs":{"type":"integer","minimum":0},
      "faults":{"type":"integer","minimum":0}}}}}})";

constexpr std::array kFleetSchemas{DocumentSchema{"Fleet", kFleet},
                                   DocumentSchema{"FleetTrends", kFleetTrends}};

}  // namespace

std::span<const DocumentSchema> fleet_schemas() { return kFleetSchemas; }

std::string document_text(const FleetDocument& document) { return written(document); }
std::string document_text(const FleetTrendsDocument& document) { return written(document); }
std::string document_text(const HistoryDocument& document) { return written(document); }
std::string document_text(const ArchiveDocument& document) { return written(document); }

ArchiveDocument archive_document_from(std::string_view text) {
  return document_from<ArchiveDocument>(text, Absent::kIsRefused);
}

ClosedTouchSet closed_touch_set_from(std::string_view text) {
  return document_from<ClosedTouchSet>(text, Absent::kIsRefused);
}

}  // namespace cell
