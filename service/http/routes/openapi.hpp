#pragma once

#include <string>

namespace cell {

/// The OpenAPI 3.1 document of all routes (route_table.hpp) with the schemas of their documents
/// (schemas.hpp).
const std::string& openapi_document();

}  // namespace cell
