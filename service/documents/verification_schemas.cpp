#include <array>

#include "service/documents/schemas.hpp"

namespace cell {
namespace {

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
  "changed":{"type":"boolean"},
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

constexpr std::array kVerificationSchemas{DocumentSchema{"Checks", kChecks},
                                          DocumentSchema{"Comparison", kComparison},
                                          DocumentSchema{"ComparedPart", kComparedPart}};

}  // namespace

std::span<const DocumentSchema> verification_schemas() { return kVerificationSchemas; }

}  // namespace cell
