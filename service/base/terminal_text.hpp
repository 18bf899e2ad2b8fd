#pragma once

#include <string>
#include <string_view>

namespace cell {

/// The text with a '?' for each character that would steer a terminal or turn the direction of what stands
/// beside it: control characters but line ends (C0, DEL, C1), those of bidirectional text, line and paragraph
/// separators, and bytes that are no UTF-8. The only place that clears text of requests for a terminal.
std::string terminal_text(std::string_view text);

}  // namespace cell
