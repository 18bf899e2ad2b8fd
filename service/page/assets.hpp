#pragma once

#include <span>
#include <string_view>

/// The operator's page as it was built: build.mjs writes the table's source.
namespace cell {

struct PageAsset {
  std::string_view name;  // "main-A1B2C3D4.js"; empty for the page itself
  std::string_view content_type;
  std::string_view etag;  // in quotes
  std::string_view bytes;
  bool is_gzip = false;  // `bytes` are compressed
};

/// The page first, then all that it loads. A name has the digest of its bytes in it: what has another content
/// has another name.
std::span<const PageAsset> page_assets();

}  // namespace cell
