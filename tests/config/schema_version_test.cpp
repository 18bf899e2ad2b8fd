#include "config/schema_version.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "folder.hpp"

namespace cell {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 3> kSchemas{"touchcal/thing/1", "touchcal/thing/2",
                                                   "touchcal/thing/3"};

int number_of(const json& document) { return schema_version(document, "thing", kSchemas).number; }

TEST(SchemaVersion, IsThatOfTheDocumentAndTheNewestForOneOfNone) {
  EXPECT_EQ(number_of({{"schema", "touchcal/thing/1"}}), 1);
  EXPECT_EQ(number_of({{"schema", "touchcal/thing/2"}}), 2);
  for (const json& other : {json{{"schema", "touchcal/thing/9"}}, json::object(), json::array(), json(3)})
    EXPECT_EQ(number_of(other), 3) << other;
}

TEST(SchemaVersion, AKeyThatCameLaterIsRefusedInAnEarlierDocument) {
  const json document{{"colour", "red"}};
  const JsonObject object = JsonValue("file", document).object({"colour", "weight"});
  EXPECT_EQ(find_since(2, object, "colour", {.kind = "thing", .number = 2}).value().text(), "red");
  EXPECT_FALSE(find_since(2, object, "weight", {.kind = "thing", .number = 1}))
      << "what is not there is no fault";
  const ConfigError error =
      error_of([&] { static_cast<void>(find_since(3, object, "colour", {.kind = "thing", .number = 2})); });
  EXPECT_EQ(error.pointer(), "/colour");
  EXPECT_EQ(error.message(), R"(unknown key "colour" in a thing of version 2; raise "schema" to 3)");
}

}  // namespace
}  // namespace cell
