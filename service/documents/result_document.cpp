#include "service/documents/result_document.hpp"

#include <nlohmann/json.hpp>

#include "service/documents/internal/document_fields.hpp"

namespace cell {
namespace {

/// A result of which only the verdict is looked at, as it was written.
struct CarriedVerdict {
  CarriedJson verdict;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields(ResultDocument::kVerdictKey, self.verdict);
  }
};

}  // namespace

std::string document_text(const ResultDocument& document) { return written(document); }

ResultDocument read_result(std::string_view text) {
  return document_from<ResultDocument>(text, Absent::kKeepsDefault);
}

std::string verdict_text(std::string_view result) {
  const auto carried = document_from<CarriedVerdict>(result, Absent::kIsRefused);
  return nlohmann::json::parse(carried.verdict.text).dump();
}

}  // namespace cell
