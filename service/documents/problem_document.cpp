#include "service/documents/problem_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

ProblemDocument read_problem(std::string_view text) {
  return document_from<ProblemDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
