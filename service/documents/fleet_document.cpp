#include "service/documents/fleet_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const FleetDocument& document) { return written(document); }
std::string document_text(const HistoryDocument& document) { return written(document); }
std::string document_text(const ArchiveDocument& document) { return written(document); }

}  // namespace cell
