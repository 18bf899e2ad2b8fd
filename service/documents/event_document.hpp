#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "service/documents/carried_json.hpp"
#include "service/store/outbox.hpp"

/// What others than this cell read of it, beside the status and the approved model.
namespace cell {

/// touchcal/event/1: a fact, as it is told.
struct EventDocument {
  std::string schema = "touchcal/event/1";
  std::string cell;
  std::int64_t seq = 0;
  std::int64_t instance = 0;
  std::string kind;
  std::string at;  // RFC 3339
  std::optional<std::string> run;
  std::string previous;  // sha256 of the event before; empty for the first
  CarriedJson body;
  std::string sha256;  // fact_digest()

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("cell", self.cell);
    fields("seq", self.seq);
    fields("instance", self.instance);
    fields("kind", self.kind);
    fields("at", self.at);
    fields("run", self.run);
    fields("previous", self.previous);
    fields("body", self.body);
    fields("sha256", self.sha256);
  }
};

/// touchcal/online/1: whether a cell's daemon is connected. One that is offline with a lower `instance` than
/// the last that was online is late and counts for nothing.
struct OnlineDocument {
  std::string schema = "touchcal/online/1";
  std::string cell;
  std::int64_t instance = 0;  // count of the daemon's starts
  bool online = false;
  std::string version;
  std::optional<std::string> at;  // RFC 3339; no value where the connection broke off

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("cell", self.cell);
    fields("instance", self.instance);
    fields("online", self.online);
    fields("version", self.version);
    fields("at", self.at);
  }
};

EventDocument event_of(const Fact& fact, const std::string& cell);

std::string document_text(const EventDocument& document);
std::string document_text(const OnlineDocument& document);

}  // namespace cell
