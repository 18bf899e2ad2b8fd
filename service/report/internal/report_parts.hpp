#pragma once

#include <string>
#include <string_view>

#include "service/base/json_figures.hpp"

/// Parts of the HTML report. Each takes the report or its result document and returns markup.
namespace cell {

/// A member of a document; null if absent, as in documents of an older daemon.
const Json& part(const Json& object, const char* key);

/// True if the value is this string.
bool is(const Json& value, std::string_view text);

/// A number in fmt's `format`; "unknown" for anything else.
std::string figure_text(const Json& value, const char* format);

/// The same, but empty for anything else.
std::string figure_if_known(const Json& value, const char* format);

/// A string; "unknown" for anything else.
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
