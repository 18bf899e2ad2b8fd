#include "service/documents/verification_document.hpp"

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

}  // namespace

std::string document_text(const ProofDocument& document) { return written(document); }
std::string document_text(const CheckDocument& document) { return written(document); }

ProofDocument read_proof(std::string_view text) {
  return document_from<ProofDocument>(text, Absent::kIsRefused);
}
CheckDocument read_check(std::string_view text) {
  return document_from<CheckDocument>(text, Absent::kIsRefused);
}

std::string schema_of(std::string_view text) {
  return document_from<NamedSchema>(text, Absent::kKeepsDefault).schema;
}

}  // namespace cell
