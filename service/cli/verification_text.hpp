#pragma once

#include <string>
#include <string_view>

#include "service/documents/verification_document.hpp"

namespace cell {

/// A proof or a check as text: the verdict and why, what was measured, what it could have seen.
std::string proof_text(const ProofDocument& proof);
std::string check_text(const CheckDocument& check);

/// The result document of a run of any kind, as text. Throws as result documents are read: DocumentError.
std::string text_of_result(std::string_view document);

}  // namespace cell
