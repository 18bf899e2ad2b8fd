#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/documents/words.hpp"

namespace cell {

/// What the report of a run of any kind says of the run itself. Joints are in degrees; no value is unknown.
struct ReportHead {
  struct OfRun {
    std::string id;
    std::string recipe;
    std::optional<std::string> operator_name;
    std::string started_at;
    std::optional<std::string> ended_at;
    RunOutcome outcome = RunOutcome::kRunning;
    Verdict verdict = Verdict::kNone;
    int touches_done = 0;
    std::optional<int> touches_total;
    std::optional<std::string> fault_code;
    std::optional<std::string> fault_message;
    std::optional<std::string> plan_id;
    std::optional<std::string> config_digest;
    std::optional<double> block_temperature_c;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("id", self.id);
      fields("recipe", self.recipe);
      fields("operator", self.operator_name);
      fields("started_at", self.started_at);
      fields("ended_at", self.ended_at);
      fields("outcome", self.outcome);
      fields("verdict", self.verdict);
      fields("touches_done", self.touches_done);
      fields("touches_total", self.touches_total);
      fields("fault_code", self.fault_code);
      fields("fault_message", self.fault_message);
      fields("plan_id", self.plan_id);
      fields("config_digest", self.config_digest);
      fields("block_temperature_c", self.block_temperature_c);
    }
  };
  struct RawData {
    std::string sha256;
    std::string of;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("sha256", self.sha256);
      fields("of", self.of);
    }
  };
  /// A touch whose answer no longer counts, as it was made again.
  struct Superseded {
    int number = 0;
    int plane = 0;
    std::string reason;
    std::string captured_at;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("number", self.number);
      fields("plane", self.plane);
      fields("reason", self.reason);
      fields("captured_at", self.captured_at);
    }
  };
  struct RaisedFault {
    std::string at;
    std::string code;
    std::string message;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("at", self.at);
      fields("code", self.code);
      fields("message", self.message);
    }
  };
  /// A contact that counts for nothing.
  struct Refused {
    std::int64_t sequence = 0;            // of its command
    std::vector<std::string> joints_deg;  // as those of a touch
    std::string reason;
    std::string at;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("sequence", self.sequence);
      fields("joints_deg", self.joints_deg);
      fields("reason", self.reason);
      fields("at", self.at);
    }
  };

  std::string touchcal_version;
  OfRun run;
  RawData raw_data;
  std::vector<Superseded> touched_again;
  std::vector<Refused> refused_contacts;  // oldest first; none in a report of an older daemon
  std::vector<RaisedFault> faults;        // oldest first

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("touchcal_version", self.touchcal_version);
    fields("run", self.run);
    fields("raw_data", self.raw_data);
    fields("touched_again", self.touched_again);
    fields("refused_contacts", self.refused_contacts);
    fields("faults", self.faults);
  }
};

}  // namespace cell
