#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "service/http/routes/openapi.hpp"
#include "service/http/routes/route_table.hpp"

/// Answers held against the OpenAPI document: the part of JSON Schema that it uses.
namespace cell {

inline const nlohmann::json& openapi() {
  static const nlohmann::json document = nlohmann::json::parse(openapi_document());
  return document;
}

inline bool has_type(const nlohmann::json& value, const std::string& type) {
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return value.type_name() == type;
}

/// What is wrong with `value`, a line each; a keyword that is not known here is wrong too.
inline void check_schema(const nlohmann::json& value, const nlohmann::json& schema, const std::string& where,
                         std::vector<std::string>& wrong) {
  using nlohmann::json;
  const auto expect = [&](bool is_so, const std::string& what) {
    if (!is_so) wrong.push_back(where + ": " + what + ", not " + value.dump().substr(0, 60));
  };
  for (const auto& [key, wanted] : schema.items()) {
    if (key == "description") continue;
    if (key == "$ref") {
      check_schema(value, openapi().at(json::json_pointer(wanted.get<std::string>().substr(1))), where,
                   wrong);
    } else if (key == "oneOf") {
      const auto fits = [&](const json& one) {
        std::vector<std::string> of_this;
        check_schema(value, one, where, of_this);
        return of_this.empty();
      };
      expect(std::count_if(wanted.begin(), wanted.end(), fits) == 1, "just one of " + wanted.dump());
    } else if (key == "type") {
      const json types = wanted.is_array() ? wanted : json::array({wanted});
      bool any = false;
      for (const json& type : types) any = any || has_type(value, type);
      expect(any, "a " + wanted.dump() + " is wanted");
    } else if (key == "enum") {
      expect(std::find(wanted.begin(), wanted.end(), value) != wanted.end(), "one of " + wanted.dump());
    } else if (key == "const") {
      expect(value == wanted, wanted.dump());
    } else if (key == "minimum") {
      expect(!value.is_number() || value >= wanted, "at least " + wanted.dump());
    } else if (key == "maximum") {
      expect(!value.is_number() || value <= wanted, "at most " + wanted.dump());
    } else if (key == "minItems") {
      expect(!value.is_array() || value.size() >= wanted.get<std::size_t>(),
             "as many items as " + wanted.dump());
    } else if (key == "maxItems") {
      expect(!value.is_array() || value.size() <= wanted.get<std::size_t>(),
             "no more items than " + wanted.dump());
    } else if (key == "pattern") {
      // The patterns here are beginnings of a text: "^urn:".
      expect(value.get<std::string>().starts_with(wanted.get<std::string>().substr(1)), wanted.dump());
    } else if (key == "required") {
      if (!value.is_object()) continue;  // the type says whether it may be another
      for (const json& name : wanted) expect(value.contains(name), "has " + name.dump());
    } else if (key == "properties") {
      if (!value.is_object()) continue;
      for (const auto& [name, part] : wanted.items()) {
        if (value.contains(name)) check_schema(value.at(name), part, where + "/" + name, wrong);
      }
    } else if (key == "additionalProperties") {  // here always beside no "properties"
      if (!value.is_object()) continue;
      for (const auto& [name, part] : value.items()) check_schema(part, wanted, where + "/" + name, wrong);
    } else if (key == "items") {
      for (std::size_t i = 0; i < value.size(); ++i)
        check_schema(value.at(i), wanted, where + "/" + std::to_string(i), wrong);
    } else {
      wrong.push_back(where + ": the schema's '" + key + "' is not known here");
    }
  }
}

/// The answer is one that the document names for its route, and its body is of that schema.
inline void expect_as_documented(const HttpRequest& request, const HttpResponse& response) {
  using nlohmann::json;
  const Route* route = find_route(request.method, request.path);
  if (!route) {
    EXPECT_EQ(response.content_type, "application/problem+json") << request.path;
    return;
  }
  const std::string method = route->method == "GET" ? "get" : "post";
  const json& responses = openapi().at("paths").at(std::string(route->path)).at(method).at("responses");
  std::string status = std::to_string(response.status);
  if (response.status >= 400) status = status.substr(0, 1) + "XX";
  ASSERT_TRUE(responses.contains(status)) << route->path << ' ' << response.status << ' ' << response.body;
  if (!responses.at(status).contains("content")) {
    EXPECT_EQ(response.body, "") << route->path;
    return;
  }
  const json& content = responses.at(status).at("content");
  ASSERT_TRUE(content.contains(response.content_type)) << route->path << ' ' << response.content_type;
  if (response.content_type.find("json") == std::string::npos) return;
  std::vector<std::string> wrong;
  check_schema(json::parse(response.body), content.at(response.content_type).at("schema"), "", wrong);
  EXPECT_EQ(wrong, std::vector<std::string>()) << route->path;
}

}  // namespace cell
