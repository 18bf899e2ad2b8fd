#include "service/documents/model_document.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "cs8_protocol/names.hpp"
#include "service/base/digest.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/documents/internal/document_fields.hpp"

namespace cell {
namespace {

/// What a model takes of a result, whatever version of the daemon stored that.
struct PartsOfResult {
  Carried<TipDocument> tip_uncertainty;
  CarriedJson parameters;
  CarriedJson nongeometric_parameters;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("tip_uncertainty", self.tip_uncertainty);
    fields("parameters", self.parameters);
    fields("nongeometric_parameters", self.nongeometric_parameters);
  }
};

struct NamedArm {
  std::string name;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("name", self.name);
  }
};

/// What the run was made under; all unknown where nothing is stored or what is stored cannot be read.
ConditionsDocument conditions_of(const StoredRun& run) try {
  if (!run.conditions_json) return {};
  return read_conditions(*run.conditions_json);
} catch (const DocumentError&) {
  return {};
}

template <class Value>
nlohmann::json canonical_or_null(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json canonical_touch(const StoredTouch& touch) {
  nlohmann::json canonical{{"again_microdeg", nullptr},
                           {"aimed_with", touch.aimed_with},
                           {"captured_at", touch.captured_at},
                           {"first_microdeg", nullptr},
                           {"first_source", nullptr},
                           {"joints_microdeg", touch.joints},
                           {"noise_um", canonical_or_null(touch.noise_um)},
                           {"number", touch.number},
                           {"overtravel_dmm", touch.overtravel_dmm},
                           {"plane", touch.plane},
                           {"role", std::string(word_of(touch.role))},
                           {"sequence", touch.sequence},
                           {"session", touch.session},
                           {"source", std::string(cs8::name(touch.source))}};
  if (touch.again) canonical["again_microdeg"] = *touch.again;
  if (touch.first) {
    canonical["first_microdeg"] = touch.first->joints;
    canonical["first_source"] = std::string(cs8::name(touch.first->source));
  }
  return canonical;
}

}  // namespace

std::string model_hash(const StoredRun& run, const std::vector<StoredTouch>& touches,
                       const std::string& arm_json) {
  nlohmann::json list = nlohmann::json::array();
  for (const StoredTouch& touch : touches) list.push_back(canonical_touch(touch));
  const nlohmann::json canonical{{"arm", arm_json},
                                 {"config_digest", canonical_or_null(run.config_digest)},
                                 {"run_id", std::to_string(run.id)},
                                 {"touches", std::move(list)}};
  return sha256_hex(canonical.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

ModelDocument model_of(const StoredRun& run, const std::vector<StoredTouch>& touches,
                       const std::string& arm_json, const std::string& result_json) {
  auto parts = document_from<PartsOfResult>(result_json, Absent::kKeepsDefault);
  const ConditionsDocument conditions = conditions_of(run);
  ModelDocument model{.hash = model_hash(run, touches, arm_json),
                      .run_id = std::to_string(run.id),
                      .arm = name_of_arm(arm_json),
                      .arm_serial = conditions.arm_serial,
                      .controller_serial = conditions.controller_serial,
                      .config_digest = run.config_digest,
                      .arm_moving_min = conditions.arm_moving_min,
                      .tip_uncertainty = std::move(parts.tip_uncertainty),
                      .parameters = std::move(parts.parameters),
                      .nongeometric_parameters = std::move(parts.nongeometric_parameters)};
  if (run.block_temperature) model.block_temperature_c = run.block_temperature->celsius;
  return model;
}

std::string name_of_arm(std::string_view arm_json) {
  return document_from<NamedArm>(arm_json, Absent::kIsRefused).name;
}

std::optional<std::string> why_other_arm(const ModelDocument& model, const Cell& cell) {
  const auto other = [&model](const std::string& of_model, const std::string& of_cell) {
    return fmt::format(
        "the model of run {} is of the arm {}, and this cell has the arm {} now; calibrate this arm and "
        "approve "
        "that run",
        model.run_id, of_model, of_cell);
  };
  if (model.arm != cell.arm.name) return other("'" + model.arm + "'", "'" + cell.arm.name + "'");
  if (!model.arm_serial || !cell.arm_serial || *model.arm_serial == *cell.arm_serial) return std::nullopt;
  return other("with the serial number '" + *model.arm_serial + "'",
               "with the serial number '" + *cell.arm_serial + "'");
}

ModelsDocument models_page(const std::vector<Approval>& history, std::size_t limit,
                           std::optional<std::int64_t> before_id) {
  const std::vector<Approval> standing = standing_approvals(history);
  ModelsDocument page;
  for (auto row = history.rbegin(); row != history.rend(); ++row) {
    if (before_id && row->id >= *before_id) continue;
    if (page.models.size() == limit) {
      page.next_before = page.models.back().id;
      break;
    }
    page.models.push_back({.id = std::to_string(row->id),
                           .kind = std::string(approval_kind_name(row->kind)),
                           .run_id = std::to_string(row->run_id),
                           .hash = row->hash,
                           .by = row->operator_name,
                           .at = row->at,
                           .valid_until = row->valid_until,
                           .current = !standing.empty() && standing.back().id == row->id,
                           .applied_to = row->applied_to});
  }
  return page;
}

std::string document_text(const ModelDocument& document) { return written(document); }
std::string document_text(const ModelsDocument& document) { return written(document); }
std::string document_text(const ApprovalRequest& document) { return written(document); }

ModelDocument read_model(std::string_view text) {
  return document_from<ModelDocument>(text, Absent::kKeepsDefault);
}

ModelsDocument read_models(std::string_view text) {
  return document_from<ModelsDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
