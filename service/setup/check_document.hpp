#pragma once

#include <filesystem>
#include <string>

#include "service/setup/setup_check.hpp"

/// What a page asks with and what it shows; the fields are those of service/doc/surfaces.md, section 6.
namespace cell {

/// touchcal/setup-questions/1: the questions of a cell of which nothing is said yet.
std::string setup_questions_document(const std::filesystem::path& shipped_config,
                                     const SetupLanguage& language);

/// touchcal/setup-check/1: what the cell would be, and the questions that these answers lead to.
std::string setup_check_document(const SetupCheck& check, const std::filesystem::path& shipped_config,
                                 const SetupLanguage& language);

}  // namespace cell
