#pragma once

#include <string>
#include <string_view>

#include "service/documents/qualification_document.hpp"
#include "service/documents/tool_document.hpp"
#include "service/documents/verification_document.hpp"

namespace cell {

/// A proof, a check, a qualification or a touched tool as text: the verdict and why, what was measured.
std::string proof_text(const ProofDocument& proof);
std::string check_text(const CheckDocument& check);
std::string qualification_text(const QualificationDocument& qualification);
std::string tool_text(const ToolDocument& tool);

/// The result document of a run of any kind, as text. Throws as result documents are read: DocumentError.
std::string text_of_result(std::string_view document);

}  // namespace cell
