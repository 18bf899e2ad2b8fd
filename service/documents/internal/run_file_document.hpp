#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/documents/words.hpp"

/// The fields of touchcal/run-file/1. Joints are in 10^-6 degrees as they came over the wire; what is JSON in
/// the store is a text here, so that it stays the same to the byte.
namespace cell::run_file {

using Joints = std::array<int, 6>;

struct Contact {
  std::string source;  // latched, polled, by hand: as in PROTOCOL.md
  Joints joints_microdeg{};

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("source", self.source);
    fields("joints_microdeg", self.joints_microdeg);
  }
};

struct Touch {
  int number = 0;
  int plane = 0;
  calib::TouchRole role = calib::TouchRole::kFit;
  Contact contact;
  int overtravel_dmm = 0;
  std::string captured_at;
  std::int64_t session = 0;
  std::int64_t sequence = 0;
  int aimed_with = 0;
  std::optional<double> noise_um;
  std::optional<Contact> first;
  std::optional<Joints> again_microdeg;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("number", self.number);
    fields("plane", self.plane);
    fields("role", self.role);
    fields("contact", self.contact);
    fields("overtravel_dmm", self.overtravel_dmm);
    fields("captured_at", self.captured_at);
    fields("session", self.session);
    fields("sequence", self.sequence);
    fields("aimed_with", self.aimed_with);
    fields("noise_um", self.noise_um);
    fields("first", self.first);
    fields("again_microdeg", self.again_microdeg);
  }
};

struct Superseded {
  Touch touch;
  std::string reason;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("touch", self.touch);
    fields("reason", self.reason);
  }
};

struct Reference {
  int number = 0;
  int touches_done = 0;
  Joints joints_microdeg{};
  std::optional<double> drift_mm;
  std::string captured_at;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("number", self.number);
    fields("touches_done", self.touches_done);
    fields("joints_microdeg", self.joints_microdeg);
    fields("drift_mm", self.drift_mm);
    fields("captured_at", self.captured_at);
  }
};

struct Change {
  std::string kind;  // put_off, drop_fitted, skip
  int place = 0;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("kind", self.kind);
    fields("place", self.place);
  }
};

struct Refused {
  std::int64_t session = 0;
  std::int64_t sequence = 0;
  Joints joints_microdeg{};
  std::string reason;
  std::string at;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("session", self.session);
    fields("sequence", self.sequence);
    fields("joints_microdeg", self.joints_microdeg);
    fields("reason", self.reason);
    fields("at", self.at);
  }
};

struct Temperature {
  double celsius = 0.0;
  std::optional<double> std_k;
  std::optional<std::string> measured_at;
  std::optional<std::string> source;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("celsius", self.celsius);
    fields("std_k", self.std_k);
    fields("measured_at", self.measured_at);
    fields("source", self.source);
  }
};

struct Run {
  std::string id;
  std::string kind;
  std::optional<std::string> of_run;
  std::string recipe;
  RunOutcome outcome = RunOutcome::kComplete;
  Verdict verdict = Verdict::kNone;
  int touches_total = 0;
  std::string started_at;
  std::string ended_at;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;
  std::optional<std::string> plan_id;
  std::optional<std::string> operator_name;
  std::optional<Temperature> block_temperature;
  std::optional<std::string> stiffness;
  std::optional<std::string> config_digest;
  std::optional<std::string> conditions;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("id", self.id);
    fields("kind", self.kind);
    fields("of_run", self.of_run);
    fields("recipe", self.recipe);
    fields("outcome", self.outcome);
    fields("verdict", self.verdict);
    fields("touches_total", self.touches_total);
    fields("started_at", self.started_at);
    fields("ended_at", self.ended_at);
    fields("fault_code", self.fault_code);
    fields("fault_message", self.fault_message);
    fields("plan_id", self.plan_id);
    fields("operator", self.operator_name);
    fields("block_temperature", self.block_temperature);
    fields("stiffness", self.stiffness);
    fields("config_digest", self.config_digest);
    fields("conditions", self.conditions);
  }
};

struct Document {
  std::string schema = "touchcal/run-file/1";
  std::string touchcal_version;
  std::string cell;
  std::string exported_at;
  Run run;
  std::vector<Touch> touches;
  std::vector<Superseded> superseded_touches;
  std::vector<Reference> reference_touches;
  std::vector<Change> plan_changes;
  std::vector<Refused> refused_contacts;
  std::optional<std::string> plan;
  std::optional<std::string> result;
  std::optional<std::string> arm;
  std::optional<std::string> model;
  std::string sha256;  // of this document with "" here

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("touchcal_version", self.touchcal_version);
    fields("cell", self.cell);
    fields("exported_at", self.exported_at);
    fields("run", self.run);
    fields("touches", self.touches);
    fields("superseded_touches", self.superseded_touches);
    fields("reference_touches", self.reference_touches);
    fields("plan_changes", self.plan_changes);
    fields("refused_contacts", self.refused_contacts);
    fields("plan", self.plan);
    fields("result", self.result);
    fields("arm", self.arm);
    fields("model", self.model);
    fields("sha256", self.sha256);
  }
};

/// What its sha256 must be.
std::string digest_of(Document document);

}  // namespace cell::run_file
