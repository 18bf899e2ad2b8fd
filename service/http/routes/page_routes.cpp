// The operator's page and its assets.
#include <algorithm>

#include "service/http/routes/route_table.hpp"
#include "service/page/assets.hpp"

namespace cell {
namespace {

/// The page connects to this daemon only, runs only its scripts and is shown in no frame.
constexpr std::string_view kPagePolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; "
    "base-uri 'none'; frame-ancestors 'none'; form-action 'none'";

HttpResponse asset_response(const Call& call, const PageAsset& asset, std::string_view caching) {
  HttpResponse response{.content_type = std::string(asset.content_type),
                        .headers = {{"ETag", std::string(asset.etag)},
                                    {"Cache-Control", std::string(caching)},
                                    {"Content-Security-Policy", std::string(kPagePolicy)}}};
  const auto& known = call.request.if_none_match;
  if (known && known->find(asset.etag) != std::string::npos) {
    response.status = 304;
    return response;
  }
  if (asset.is_gzip) response.headers.emplace_back("Content-Encoding", "gzip");
  response.body = asset.bytes;
  return response;
}

HttpResponse get_page(const Call& call) { return asset_response(call, page_assets().front(), "no-cache"); }

/// Always compressed with gzip, which every browser accepts.
HttpResponse get_asset(const Call& call) {
  const auto assets = page_assets().subspan(1);
  const auto found = std::ranges::find(assets, call.id, &PageAsset::name);
  if (found == assets.end()) return not_found("the page has no such asset; reload it");
  return asset_response(call, *found, "public, max-age=31536000, immutable");
}

}  // namespace

std::vector<Route> page_routes() {
  return {
      {.method = "GET",
       .path = "/",
       .summary = "The operator's page",
       .access = Access::kOpen,
       .handle = get_page,
       .answers = {{.content_type = "text/html; charset=utf-8"}, {.status = 304}}},
      {.method = "GET",
       .path = "/assets/{id}",
       .summary = "What the page loads, compressed with gzip",
       .access = Access::kOpen,
       .handle = get_asset,
       .answers = {{.content_type = "text/javascript; charset=utf-8"}, {.status = 304}}},
  };
}

}  // namespace cell
