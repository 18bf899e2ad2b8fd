// What is taken of the file of a run from outside.
#include <algorithm>
#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "config/arm_file.hpp"
#include "config/config_error.hpp"
#include "config/strict_json.hpp"
#include "cs8_protocol/names.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/internal/document_fields.hpp"
#include "service/documents/internal/run_file_document.hpp"
#include "service/documents/model_document.hpp"
#include "service/documents/plan_document.hpp"
#include "service/documents/qualification_document.hpp"
#include "service/documents/result_document.hpp"
#include "service/documents/run_file.hpp"
#include "service/documents/tool_document.hpp"
#include "service/documents/verification_document.hpp"

namespace cell {
namespace {

constexpr int kPlaneMax = 64;
constexpr std::size_t kNameBytesMax = 200;

void demand(bool holds, const std::string& pointer, const std::string& otherwise) {
  if (!holds) throw DocumentError(pointer, otherwise);
}

/// Takes each row of a list by `take`, which is given the row and the way to it.
template <class Rows, class Take>
void each_row(const char* list, const Rows& rows, const Take& take) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    take(rows[i], std::string("/") + list + "/" + std::to_string(i));
}

template <class Rows>
void demand_different(const char* list, const Rows& rows) {
  std::set<int> seen;
  each_row(list, rows, [&](const auto& row, const std::string& at) {
    demand(row.number >= 1, at + "/number", "expected a whole number from 1 on");
    demand(seen.insert(row.number).second, at + "/number", "another one has this number");
  });
}

/// As format_utc() writes a time.
void demand_time(const std::string& pointer, const std::string& text) {
  constexpr std::string_view kForm = "0000-00-00T00:00:00.000Z";
  const bool is_time =
      text.size() == kForm.size() && std::ranges::equal(text, kForm, [](char given, char form) {
        return form == '0' ? given >= '0' && given <= '9' : given == form;
      });
  demand(is_time, pointer, "expected a time such as 2026-01-31T08:15:30.250Z");
}

std::int64_t id_in(const std::string& pointer, const std::string& text) {
  std::int64_t id = 0;
  const char* const text_end = text.data() + text.size();
  const auto [end, failure] = std::from_chars(text.data(), text_end, id);
  demand(failure == std::errc{} && end == text_end && id >= 1, pointer, "expected the id of a run");
  return id;
}

std::uint32_t word_in(const std::string& pointer, std::int64_t value) {
  constexpr std::int64_t kMax = std::numeric_limits<std::uint32_t>::max();
  demand(value >= 0 && value <= kMax, pointer, "expected a whole number from 0 to " + std::to_string(kMax));
  return static_cast<std::uint32_t>(value);
}

cs8::CaptureSource source_in(const std::string& pointer, const std::string& word) {
  for (const auto source :
       {cs8::CaptureSource::kNone, cs8::CaptureSource::kLatched, cs8::CaptureSource::kPolled})
    if (cs8::name(source) == word) return source;
  throw DocumentError(pointer, "'" + word + "' is not a source of a contact");
}

cs8::JointsMicrodeg stored_joints(const run_file::Joints& joints) {
  cs8::JointsMicrodeg stored{};
  std::ranges::copy(joints, stored.begin());
  return stored;
}

StoredTouch stored_touch(const run_file::Touch& touch, const std::string& at) {
  demand(touch.number >= 1, at + "/number", "expected a whole number from 1 on");
  demand(touch.plane >= 1 && touch.plane <= kPlaneMax, at + "/plane", "no block has this plane");
  demand_time(at + "/captured_at", touch.captured_at);
  StoredTouch stored{.number = touch.number,
                     .plane = touch.plane,
                     .role = touch.role,
                     .joints = stored_joints(touch.contact.joints_microdeg),
                     .source = source_in(at + "/contact/source", touch.contact.source),
                     .overtravel_dmm = touch.overtravel_dmm,
                     .captured_at = touch.captured_at,
                     .session = word_in(at + "/session", touch.session),
                     .sequence = word_in(at + "/sequence", touch.sequence),
                     .aimed_with = touch.aimed_with,
                     .noise_um = touch.noise_um,
                     .first = {},
                     .again = {}};
  if (touch.first)
    stored.first = FirstContact{source_in(at + "/first/source", touch.first->source),
                                stored_joints(touch.first->joints_microdeg)};
  if (touch.again_microdeg) stored.again = stored_joints(*touch.again_microdeg);
  return stored;
}

StoredRun stored_run(const run_file::Run& run) {
  const auto kind = run_kind_named(run.kind);
  demand(kind.has_value(), "/run/kind", "'" + run.kind + "' is no kind of run of this version of touchcal");
  demand(*kind == RunKind::kQualification || (*kind == RunKind::kCalibration) != run.of_run.has_value(),
         "/run/of_run", "a proof, a check and a tool are of a run, a calibration is of none");
  demand(run.outcome != RunOutcome::kRunning, "/run/outcome", "the run is not over");
  demand(!run.recipe.empty() && run.recipe.size() <= kNameBytesMax, "/run/recipe",
         "expected the name of a recipe");
  demand(run.touches_total >= 0, "/run/touches_total", "expected a whole number from 0 on");
  demand_time("/run/started_at", run.started_at);
  demand_time("/run/ended_at", run.ended_at);
  StoredRun stored;
  stored.id = id_in("/run/id", run.id);
  stored.kind = *kind;
  if (run.of_run) stored.of_run = id_in("/run/of_run", *run.of_run);
  stored.recipe = run.recipe;
  stored.touches_total = run.touches_total;
  stored.started_at = run.started_at;
  stored.ended_at = run.ended_at;
  stored.outcome = run.outcome;
  stored.verdict = run.verdict;
  stored.fault_code = run.fault_code;
  stored.fault_message = run.fault_message;
  stored.plan_id = run.plan_id;
  stored.operator_name = run.operator_name;
  if (const auto& block = run.block_temperature)
    stored.block_temperature =
        StoredTemperature{block->celsius, block->std_k, block->measured_at, block->source};
  stored.stiffness = run.stiffness;
  stored.config_digest = run.config_digest;
  stored.conditions_json = run.conditions;
  return stored;
}

RunCopy stored_copy(const run_file::Document& document) {
  demand_different("touches", document.touches);
  demand_different("reference_touches", document.reference_touches);
  demand(document.refused_contacts.size() <= static_cast<std::size_t>(kRefusedKept), "/refused_contacts",
         "no run keeps so many");
  RunCopy copy;
  copy.run = stored_run(document.run);
  each_row("touches", document.touches, [&](const run_file::Touch& row, const std::string& at) {
    copy.touches.push_back(stored_touch(row, at));
  });
  each_row("superseded_touches", document.superseded_touches,
           [&](const run_file::Superseded& row, const std::string& at) {
             copy.superseded.push_back({stored_touch(row.touch, at + "/touch"), row.reason});
           });
  each_row("reference_touches", document.reference_touches,
           [&](const run_file::Reference& row, const std::string& at) {
             demand_time(at + "/captured_at", row.captured_at);
             copy.references.push_back({row.number, row.touches_done, stored_joints(row.joints_microdeg),
                                        row.drift_mm, row.captured_at});
           });
  each_row("plan_changes", document.plan_changes, [&](const run_file::Change& row, const std::string& at) {
    const auto kind = plan_change_with(row.kind);
    demand(kind && row.place >= 0, at, "is no change of a plan");
    copy.plan_changes.push_back({*kind, row.place});
  });
  each_row("refused_contacts", document.refused_contacts,
           [&](const run_file::Refused& row, const std::string& at) {
             demand_time(at + "/at", row.at);
             copy.refused.push_back({word_in(at + "/session", row.session),
                                     word_in(at + "/sequence", row.sequence),
                                     stored_joints(row.joints_microdeg), row.reason, row.at});
           });
  copy.plan_json = document.plan;
  copy.result_json = document.result;
  copy.arm_json = document.arm;
  return copy;
}

/// A text that others read as a document of its own: what is wrong in it is told with its place here.
template <class Read>
void demand_document(const char* pointer, const std::optional<std::string>& text, const Read& read) {
  if (!text) return;
  try {
    (void)parse_strict_json("the text", *text, kRunFileBytesMax);
    read(*text);
  } catch (const std::runtime_error& error) {
    throw DocumentError(pointer, error.what());
  }
}

void demand_result(const RunCopy& copy) {
  demand_document("/result", copy.result_json, [&](const std::string& text) {
    if (copy.run.kind == RunKind::kProof) {
      (void)read_proof(text);
    } else if (copy.run.kind == RunKind::kCheck) {
      (void)read_check(text);
    } else if (copy.run.kind == RunKind::kQualification) {
      (void)read_qualification(text);
    } else if (copy.run.kind == RunKind::kTool) {
      (void)read_tool(text);
    } else {
      (void)read_result(text);
    }
  });
}

void demand_documents(const RunFile& file) {
  const RunCopy& copy = file.copy;
  demand_result(copy);
  demand_document("/run/conditions", copy.run.conditions_json,
                  [](const std::string& text) { (void)read_conditions(text); });
  demand_document("/plan", copy.plan_json, [](const std::string& text) { (void)read_plan(text); });
  demand_document("/arm", copy.arm_json,
                  [](const std::string& text) { (void)read_arm_text("the arm", text); });
  demand_document("/model", file.model_json, [&](const std::string& text) {
    const std::string hash = read_model(text).hash;
    demand(copy.arm_json && hash == model_hash(copy.run, copy.touches, *copy.arm_json), "/hash",
           "is not that of the touches and the arm in this file");
  });
}

run_file::Document parsed(std::string_view text) {
  nlohmann::json json;
  try {
    json = parse_strict_json("the file", text, kRunFileBytesMax);
  } catch (const ConfigError& error) {
    throw DocumentError(error.pointer(), error.message());
  }
  const std::string wanted = run_file::Document().schema;
  demand(json.is_object() && json.value("schema", nlohmann::json()) == wanted, "/schema",
         "is not " + wanted + ", which touchcal export-run writes");
  return document_from<run_file::Document>(text, Absent::kIsRefused);
}

}  // namespace

ReadRunFile read_run_file(std::string_view text) {
  const run_file::Document document = parsed(text);
  demand(document.sha256 == run_file::digest_of(document), "/sha256",
         "is not that of the file, which was changed or damaged since it was exported");
  demand(!document.cell.empty() && document.cell.size() <= kNameBytesMax, "/cell",
         "expected the name of a cell");
  demand_time("/exported_at", document.exported_at);
  RunFile file{.cell = document.cell,
               .exported_at = document.exported_at,
               .copy = stored_copy(document),
               .model_json = document.model};
  demand_documents(file);
  return {std::move(file), document.sha256};
}

}  // namespace cell
