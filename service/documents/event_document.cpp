#include "service/documents/event_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

EventDocument event_of(const Fact& fact, const std::string& cell) {
  return {.cell = cell,
          .seq = fact.seq,
          .instance = fact.instance,
          .kind = fact.kind,
          .at = fact.at,
          .run = fact.run_id ? std::optional(std::to_string(*fact.run_id)) : std::nullopt,
          .previous = fact.previous,
          .body = CarriedJson{fact.body},
          .sha256 = fact.sha256};
}

std::string document_text(const EventDocument& document) { return written(document); }
std::string document_text(const OnlineDocument& document) { return written(document); }

}  // namespace cell
