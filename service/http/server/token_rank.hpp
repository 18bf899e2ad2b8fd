#pragma once

namespace cell {

/// What the token of a request is worth, as far as the server needs to know: none, or not one of the
/// daemon's; one that may read; one that may operate. A later one is kept longer when places are short.
enum class TokenRank { kNone, kView, kOperate };

}  // namespace cell
