#pragma once

#include <string>
#include <string_view>

namespace cell {

/// The text with the five special characters of HTML and XML as references; control characters but line ends
/// and tabs are left out. The only place that escapes text for a report or a drawing.
std::string escaped_markup(std::string_view text);

}  // namespace cell
