#pragma once

#include <string>
#include <string_view>

#include "service/base/json_figures.hpp"

/// The parts of the HTML report. Each takes the report or its result document and gives markup.
namespace cell {

/// A part of a document; null where it is not there, as in one that an older daemon wrote.
const Json& part(const Json& object, const char* key);

/// Whether a part is this text.
bool is(const Json& value, std::string_view text);

/// A figure for people, "unknown" when it is none; `format` is fmt's.
std::string figure_text(const Json& value, const char* format);

/// The same, but nothing for what is no figure.
std::string figure_if_known(const Json& value, const char* format);

/// A text as it stands there, "unknown" when it is none.
std::string text_or_unknown(const Json& value);

// report_tables.cpp
std::string errors_table(const Json& result);       // Table III
std::string intervals_table(const Json& result);    // each candidate with its uncertainty
std::string repetition_tables(const Json& result);  // Tables IV and V
std::string distance_tables(const Json& result);    // Tables VI and VII
std::string block_and_probe_table(const Json& result);

// report_figures.cpp
std::string condition_figure(const Json& result);  // Figure 4
std::string distance_figures(const Json& report);  // Figures 5 to 12

}  // namespace cell
