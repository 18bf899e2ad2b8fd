#include <array>

#include "service/documents/schemas.hpp"

namespace cell {
namespace {

constexpr std::string_view kSetupAnswers = R"({
"type":"object",
"description":"What a person says of a new cell; config/FILES.md has all keys, and all but schema may be missing",
"required":["schema"],
"properties":{"schema":{"const":"touchcal/setup/1"}}})";

constexpr std::string_view kSetupQuestion = R"({
"type":"object",
"required":["pointer","section","kind","optional","count","prompt","unit","explanation","choices","guessed","new_entry"],
"properties":{
  "pointer":{"type":"string","description":"RFC 6901, of the answer in touchcal/setup/1"},
  "section":{"enum":["arm","block","probe","space","limits","tools"]},
  "kind":{"enum":["text","number","numbers","yes_no","count","sides","arm"],
    "description":"count: the answer is a list, of which it is asked how long it is"},
  "optional":{"type":"boolean","description":"null is an answer"},
  "count":{"type":["integer","null"],"description":"of numbers: how many"},
  "prompt":{"type":"string"},
  "unit":{"type":"string"},
  "explanation":{"type":"string"},
  "choices":{"type":"array","items":{"type":"string"}},
  "guessed":{"type":"boolean","description":"nobody has answered it"},
  "new_entry":{"type":["object","null"],"description":"of a list: what is added to it"}}})";

constexpr std::string_view kSetupQuestions = R"({
"type":"object",
"required":["schema","language","answers","questions"],
"properties":{
  "schema":{"const":"touchcal/setup-questions/1"},
  "language":{"enum":["en","fr","de"]},
  "answers":{"$ref":"#/components/schemas/SetupAnswers"},
  "questions":{"type":"array","items":{"$ref":"#/components/schemas/SetupQuestion"}}}})";

constexpr std::string_view kSetupCheck = R"({
"type":"object",
"required":["schema","passes","refused","remarks","files","scene_svg","answers","questions"],
"properties":{
  "schema":{"const":"touchcal/setup-check/1"},
  "passes":{"type":["boolean","null"],"description":"null: not known here, as the arm's file is at the cell"},
  "refused":{"type":"array","items":{"type":"object","required":["pointer","sentence","remedy","file"],
    "properties":{
      "pointer":{"type":"string","description":"RFC 6901, of the answer; of a place in file where there is one"},
      "sentence":{"type":"string"},
      "remedy":{"type":"string"},
      "file":{"type":["string","null"]}}}},
  "remarks":{"type":"array","items":{"type":"string"}},
  "files":{"type":"array","items":{"type":"object","required":["name","text"],
    "properties":{"name":{"type":"string"},"text":{"type":"string"}}}},
  "scene_svg":{"type":["string","null"],"description":"null: the arm is not known here"},
  "answers":{"$ref":"#/components/schemas/SetupAnswers"},
  "questions":{"type":"array","items":{"$ref":"#/components/schemas/SetupQuestion"}}}})";

constexpr std::array kSetupSchemas{
    DocumentSchema{"SetupAnswers", kSetupAnswers}, DocumentSchema{"SetupQuestion", kSetupQuestion},
    DocumentSchema{"SetupQuestions", kSetupQuestions}, DocumentSchema{"SetupCheck", kSetupCheck}};

}  // namespace

std::span<const DocumentSchema> setup_schemas() { return kSetupSchemas; }

}  // namespace cell
