#include "service/documents/places_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const PlacesDocument& document) { return written(document); }

}  // namespace cell
