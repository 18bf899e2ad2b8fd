#include "service/http/routes/openapi.hpp"

#include <nlohmann/json.hpp>

#include "service/base/json_figures.hpp"
#include "service/base/version.hpp"
#include "service/documents/schemas.hpp"
#include "service/http/routes/route_table.hpp"

namespace cell {
namespace {

Json reference(std::string_view schema) { return {{"$ref", "#/components/schemas/" + std::string(schema)}}; }

Json parameters_json(const Route& route) {
  Json parameters = Json::array();
  if (route.path.find("{id}") != std::string_view::npos) {
    parameters.push_back(
        {{"name", "id"}, {"in", "path"}, {"required", true}, {"schema", {{"type", "string"}}}});
  }
  for (const QueryParameter& query : route.query) {
    const Json schema =
        query.is_text ? Json{{"type", "string"}}
                      : Json{{"type", "integer"}, {"minimum", query.minimum}, {"maximum", query.maximum}};
    parameters.push_back(
        {{"name", query.name}, {"in", "query"}, {"description", query.words}, {"schema", schema}});
  }
  if (route.method == "POST" && route.dispatch != DispatchMode::kPeople && !route.asks_only) {
    parameters.push_back({{"name", "Idempotency-Key"},
                          {"in", "header"},
                          {"description", "a repetition within 24 h gets the first answer"},
                          {"schema", {{"type", "string"}, {"minLength", 1}, {"maxLength", 255}}}});
  }
  if (route.dispatch == DispatchMode::kEvents) {
    parameters.push_back({{"name", "Last-Event-ID"}, {"in", "header"}, {"schema", {{"type", "string"}}}});
  }
  return parameters;
}

Json responses_json(const Route& route) {
  const Json problem{{"description", "a refusal (RFC 9457)"},
                     {"content", {{"application/problem+json", {{"schema", reference("Problem")}}}}}};
  Json responses = Json::object();
  for (const Answer& answer : route.answers) {
    Json& response = responses[std::to_string(answer.status)];  // one status may come in several forms
    response["description"] = answer.status == 304 ? "not modified" : "as asked";
    if (!answer.schema.empty()) {
      response["content"][std::string(answer.content_type)] = {{"schema", reference(answer.schema)}};
    } else if (answer.status == 200) {
      response["content"][std::string(answer.content_type)] = {{"schema", {{"type", "string"}}}};
    }
  }
  responses["4XX"] = problem;
  responses["5XX"] = problem;
  return responses;
}

Json operation_json(const Route& route) {
  Json operation{{"summary", route.summary}};
  operation["parameters"] = parameters_json(route);
  if (!route.body_schema.empty()) {
    operation["requestBody"] = {
        {"required", true}, {"content", {{"application/json", {{"schema", reference(route.body_schema)}}}}}};
  }
  operation["responses"] = responses_json(route);
  const Json token = {{{"operate", Json::array()}}};
  if (route.access != Access::kView && route.access != Access::kOpen) operation["security"] = token;
  // Reading on loopback needs no token.
  if (route.access == Access::kView) operation["security"] = {{{"view", Json::array()}}, Json::object()};
  return operation;
}

Json make_document() {
  Json paths = Json::object();
  for (const Route& route : routes()) {
    const std::string method = route.method == "GET" ? "get" : "post";
    paths[std::string(route.path)][method] = operation_json(route);
  }
  Json schemas = Json::object();
  for (const auto& list : {daemon_schemas(), file_schemas(), verification_schemas(), people_schemas(),
                           setup_schemas(), fleet_schemas()}) {
    for (const DocumentSchema& schema : list) schemas[std::string(schema.name)] = Json::parse(schema.text);
  }
  const Json bearer{{"type", "http"}, {"scheme", "bearer"}};
  return {
      {"openapi", "3.1.0"},
      {"info",
       {{"title", "touchcald"},
        {"version", kVersion},
        {"description",
         "Calibrates a six-axis arm by touching the faces of a block. Units stand at the end of names; a "
         "figure that is not known is null."}}},
      {"paths", paths},
      {"components", {{"schemas", schemas}, {"securitySchemes", {{"operate", bearer}, {"view", bearer}}}}}};
}

}  // namespace

const std::string& openapi_document() {
  static const std::string document = text_of(make_document());
  return document;
}

}  // namespace cell
