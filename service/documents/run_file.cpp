#include "service/documents/run_file.hpp"

#include <algorithm>

#include "cs8_protocol/names.hpp"
#include "service/base/digest.hpp"
#include "service/base/version.hpp"
#include "service/documents/internal/document_fields.hpp"
#include "service/documents/internal/run_file_document.hpp"

namespace cell {
namespace {

run_file::Joints written_joints(const cs8::JointsMicrodeg& joints) {
  run_file::Joints written{};
  std::ranges::copy(joints, written.begin());
  return written;
}

run_file::Contact written_contact(cs8::CaptureSource source, const cs8::JointsMicrodeg& joints) {
  return {.source = std::string(cs8::name(source)), .joints_microdeg = written_joints(joints)};
}

run_file::Touch written_touch(const StoredTouch& touch) {
  run_file::Touch written{.number = touch.number,
                          .plane = touch.plane,
                          .role = touch.role,
                          .contact = written_contact(touch.source, touch.joints),
                          .overtravel_dmm = touch.overtravel_dmm,
                          .captured_at = touch.captured_at,
                          .session = touch.session,
                          .sequence = touch.sequence,
                          .aimed_with = touch.aimed_with,
                          .noise_um = touch.noise_um,
                          .first = {},
                          .again_microdeg = {}};
  if (touch.first) written.first = written_contact(touch.first->source, touch.first->joints);
  if (touch.again) written.again_microdeg = written_joints(*touch.again);
  return written;
}

run_file::Run written_run(const StoredRun& run) {
  run_file::Run written;
  written.id = std::to_string(run.id);
  written.kind = run_kind_name(run.kind);
  if (run.of_run) written.of_run = std::to_string(*run.of_run);
  written.recipe = run.recipe;
  written.outcome = run.outcome;
  written.verdict = run.verdict;
  written.touches_total = run.touches_total;
  written.started_at = run.started_at;
  written.ended_at = run.ended_at.value_or("");
  written.fault_code = run.fault_code;
  written.fault_message = run.fault_message;
  written.plan_id = run.plan_id;
  written.operator_name = run.operator_name;
  if (const auto& block = run.block_temperature)
    written.block_temperature =
        run_file::Temperature{block->celsius, block->std_k, block->measured_at, block->source};
  written.stiffness = run.stiffness;
  written.config_digest = run.config_digest;
  written.conditions = run.conditions_json;
  return written;
}

run_file::Document document_of(const RunFile& file) {
  const RunCopy& copy = file.copy;
  run_file::Document document;
  document.touchcal_version = kVersion;
  document.cell = file.cell;
  document.exported_at = file.exported_at;
  document.run = written_run(copy.run);
  for (const StoredTouch& touch : copy.touches) document.touches.push_back(written_touch(touch));
  for (const SupersededTouch& before : copy.superseded)
    document.superseded_touches.push_back({written_touch(before.touch), before.reason});
  for (const ReferenceTouch& touch : copy.references)
    document.reference_touches.push_back(
        {touch.number, touch.touches_done, written_joints(touch.joints), touch.drift_mm, touch.captured_at});
  for (const PlanChange& change : copy.plan_changes)
    document.plan_changes.push_back({std::string(plan_change_word(change.kind)), change.place});
  for (const RefusedResult& refused : copy.refused)
    document.refused_contacts.push_back({std::int64_t{refused.session}, std::int64_t{refused.sequence},
                                         written_joints(refused.joints), refused.reason, refused.at});
  document.plan = copy.plan_json;
  document.result = copy.result_json;
  document.arm = copy.arm_json;
  document.model = file.model_json;
  return document;
}

}  // namespace

std::string run_file::digest_of(Document document) {
  document.sha256.clear();
  return sha256_hex(written(document));
}

std::string document_text(const RunFile& file) {
  run_file::Document document = document_of(file);
  document.sha256 = run_file::digest_of(document);
  return written(document);
}

}  // namespace cell
