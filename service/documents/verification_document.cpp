#include "service/documents/verification_document.hpp"

#include <algorithm>
#include <array>

#include "service/documents/document_error.hpp"
#include "service/documents/internal/document_fields.hpp"

namespace cell {
namespace {

struct NamedSchema {
  std::string schema;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
  }
};

template <class Document>
Document document_of_schema(std::string_view text) {
  auto document = document_from<Document>(text, Absent::kIsRefused);
  if (document.schema != Document().schema)
    throw DocumentError("/schema", "must be '" + Document().schema + "', not '" + document.schema + "'");
  return document;
}

}  // namespace

std::string document_text(const ProofDocument& document) { return written(document); }
std::string document_text(const CheckDocument& document) { return written(document); }

ProofDocument read_proof(std::string_view text) { return document_of_schema<ProofDocument>(text); }

CheckDocument read_check(std::string_view text) {
  auto document = document_of_schema<CheckDocument>(text);
  constexpr std::array kCauses{"joint", "block", "stylus", "unknown"};
  if (document.cause && std::ranges::find(kCauses, *document.cause) == kCauses.end())
    throw DocumentError("/cause", "is none of joint, block, stylus, unknown");
  return document;
}

std::string schema_of(std::string_view text) {
  return document_from<NamedSchema>(text, Absent::kKeepsDefault).schema;
}

}  // namespace cell
