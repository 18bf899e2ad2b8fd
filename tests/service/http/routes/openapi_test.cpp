#include "service/http/routes/openapi.hpp"

#include <gmock/gmock.h>

#include <set>

#include "config/file_bytes.hpp"
#include "service/documents/json_view.hpp"
#include "service/documents/schemas.hpp"
#include "tests/service/document_schema.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;

TEST(OpenApi, NamesEveryRouteAndNoOther) {
  std::set<std::string> declared;
  for (const Route& route : routes())
    declared.insert((route.method == "GET" ? "get " : "post ") + std::string(route.path));
  std::set<std::string> documented;
  for (const auto& [path, methods] : openapi().at("paths").items()) {
    for (const auto& [method, unused] : methods.items()) documented.insert(method + " " + path);
  }
  EXPECT_EQ(documented, declared);
  EXPECT_EQ(declared.size(), routes().size()) << "a route is declared twice";
}

TEST(OpenApi, HasAPathForEveryCommand) {
  for (const Command command : kCommands) {
    const std::string name(command_name(command));
    const auto has = [&](const std::string& path) {
      return openapi().at("paths").contains(path) && openapi().at("paths").at(path).contains("post");
    };
    EXPECT_TRUE(command == Command::kStart ? has("/api/v1/runs")
                                           : has("/api/v1/runs/{id}/" + name) || has("/api/v1/cell/" + name))
        << name;
  }
}

TEST(OpenApi, HasEverySchemaThatItRefersTo) {
  const std::string text = openapi_document();
  const std::string begin = "\"$ref\":\"#";
  int seen = 0;
  for (std::size_t at = text.find(begin); at != text.npos; at = text.find(begin, at + 1), ++seen) {
    const std::size_t from = at + begin.size();
    const std::string pointer = text.substr(from, text.find('"', from) - from);
    EXPECT_TRUE(openapi().contains(json::json_pointer(pointer))) << pointer;
  }
  EXPECT_GT(seen, 10);
}

TEST(OpenApi, ADocumentThatIsNotAsItsSchemaSaysIsSeen) {
  const json status = openapi().at("components").at("schemas").at("Status");
  const auto faults = [&](const json& document) {
    std::vector<std::string> wrong;
    check_schema(document, status, "", wrong);
    return wrong.size();
  };
  const json good = json::parse(status_document({.instance_id = "i", .since = "t"}));
  EXPECT_EQ(faults(good), 0u);
  for (const auto& [name, unused] : good.items()) {
    json without = good;
    without.erase(name);
    EXPECT_EQ(faults(without), 1u) << name;
    json other = good;
    other[name] = json::object();
    EXPECT_EQ(faults(other), 1u) << name << " is not told from an object";
  }
}

TEST(OpenApi, EveryFieldOfTheStatusIsDescribed) {
  const json& described = openapi().at("components").at("schemas").at("Status").at("properties");
  const json status = json::parse(status_document({}));
  for (const auto& [name, unused] : status.items())
    EXPECT_TRUE(described.contains(name)) << name << " is missing in service/documents/schemas.cpp";
}

TEST(OpenApi, TheResultOfThePapersTouchesIsAsItsSchemaSays) {
  QuietCell quiet;
  HttpRequest request{.method = "POST",
                      .path = "/api/v1/identify",
                      .authorization = "Bearer " + std::string(64, 'a'),
                      .content_type = "application/json"};
  request.body = read_file_bytes(std::string(TOUCHCAL_SOURCE_DIR) + "/tests/data/table3-exact.touches.json",
                                 kTouchesBytesMax);
  request.query.emplace("recipe", "edf-23");
  const Tokens tokens{std::string(64, 'a'), std::string(64, 'b')};
  const HttpResponse response = quiet.run(route(request, quiet.operation(), tokens));
  ASSERT_EQ(response.status, 200u) << response.body;
  expect_as_documented(request, response);
  EXPECT_EQ(json::parse(response.body).at("identifiable_count"), 23);
  request.query = {{"recipe", "none"}};
  EXPECT_EQ(quiet.run(route(request, quiet.operation(), tokens)).status, 422u);
  request.query.clear();
  for (const char* body : {"", "{}", "[]", R"({"schema":"touchcal/touches/1","arm":"tx90","touches":[]})",
                           R"({"schema":"touchcal/touches/1","arm":"other","touches":[]})"}) {
    request.body = body;
    const HttpResponse refused = quiet.run(route(request, quiet.operation(), tokens));
    EXPECT_THAT(refused.status, ::testing::AnyOf(400u, 422u)) << body;
    expect_as_documented(request, refused);
  }
}

}  // namespace
}  // namespace cell
