#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;

using StartBodyTest = RoutesTest;

TEST_F(StartBodyTest, ABodyMustSayThatItIsJson) {
  HttpRequest request = made("POST", "/api/v1/runs");
  request.authorization = "Bearer " + kTokens.operate;
  request.body = R"({"recipe":"edf-25"})";
  for (const char* type :
       {"text/plain", "application/x-www-form-urlencoded", "application/jsonx", "", "json"}) {
    request.content_type = type;
    EXPECT_EQ(problem(send(request)).at("status"), 415) << type;
  }
  request.content_type.reset();
  EXPECT_EQ(problem(send(request)).at("status"), 415);
  for (const char* type : {"application/json", "application/json; charset=utf-8",
                           "application/json ;charset=utf-8", "Application/JSON"}) {
    request.content_type = type;
    EXPECT_NE(send(request).status, 415u) << type;
  }
}

struct BadBody {
  const char* what;
  std::string body;
  unsigned status = 400;
  std::string pointer;
};

TEST_F(StartBodyTest, AStartsBodyIsTakenToTheLetter) {
  const std::vector<BadBody> bodies{
      {"nothing", ""},
      {"blanks", "  \n"},
      {"no JSON", "recipe=edf-25"},
      {"cut off", R"({"recipe":"edf-25")"},
      {"something behind", R"({"recipe":"edf-25"} x)"},
      {"an array", R"(["edf-25"])"},
      {"a string", R"("edf-25")"},
      {"null", "null"},
      {"no recipe", "{}", 400, "/recipe"},
      {"a number", R"({"recipe":25})", 400, "/recipe"},
      {"a null", R"({"recipe":null})", 400, "/recipe"},
      {"an unknown key", R"({"recipe":"edf-25","speed":2})", 400, "/speed"},
      {"an unknown key that needs escapes", R"({"a/b~c":2})", 400, "/a~1b~0c"},
      {"a key twice", R"({"recipe":"edf-25","recipe":"edf-23"})"},
      {"a NUL", std::string(R"({"recipe":"edf-25"})") + '\0'},
      {"a NUL inside", std::string("{\"recipe\":\"edf\0-25\"}", 20)},
      {"no UTF-8", "{\"recipe\":\"\xff\xfe\"}"},
      {"a byte order mark", "\xEF\xBB\xBF{\"recipe\":\"edf-25\"}"},
      {"deep nesting", std::string(30000, '[') + std::string(30000, ']')},
      {"deep nesting in the recipe",
       R"({"recipe":)" + std::string(30000, '[') + std::string(30000, ']') + "}"},
      {"a huge number", R"({"recipe":1e999})"},
      {"NaN", R"({"recipe":NaN})"},
      {"a tool of a calibration", R"({"recipe":"edf-25","tool":"saw"})", 400, "/tool"},
      {"no tool", R"({"kind":"tool"})", 400, "/tool"},
      {"a tool that there is not", R"({"kind":"tool","tool":"saw"})", 400, "/tool"},
      {"a tool that is no text", R"({"kind":"tool","tool":7})", 400, "/tool"},
      {"an unknown recipe", R"({"recipe":"edf-99"})", 422, "/recipe"},
      {"an empty name", R"({"recipe":""})", 422, "/recipe"},
      {"a name with a NUL", R"({"recipe":"edf-25\u0000"})", 422, "/recipe"}};
  for (const BadBody& bad : bodies) {
    const json document = problem(post("/api/v1/runs", bad.body));
    EXPECT_EQ(document.at("status"), bad.status) << bad.what << ": " << document;
    ASSERT_TRUE(document.contains("pointer")) << bad.what << ": " << document;
    if (!bad.pointer.empty()) {
      EXPECT_EQ(document.at("pointer"), bad.pointer) << bad.what;
    }
    EXPECT_TRUE(cell_.store().runs(1).empty()) << bad.what << " began a run";
  }
}

TEST_F(StartBodyTest, AStartsTemperatureComesWithItsDeviationAndWithinBounds) {
  const std::string c = "/block_temperature_c", std = "/std_block_temperature_k",
                    at = "/block_temperature_at";
  const auto with = [](const std::string& rest) { return R"({"recipe":"edf-25",)" + rest + "}"; };
  const auto value = [&](const std::string& text) {
    return with(R"("std_block_temperature_k":0.5,"block_temperature_c":)" + text);
  };
  const auto deviation = [&](const std::string& text) {
    return with(R"("block_temperature_c":25,"std_block_temperature_k":)" + text);
  };
  const std::vector<BadBody> bodies{
      {"no deviation", with(R"("block_temperature_c":25)"), 400, std},
      {"a deviation alone", with(R"("std_block_temperature_k":0.5)"), 400, c},
      {"a time alone", with(R"("block_temperature_at":"1970-01-01T00:00:00Z")"), 400, c},
      {"a text", value(R"("25")"), 400, c},
      {"a null", value("null"), 400, c},
      {"kelvins", value("298.15"), 400, c},
      {"colder than a room", value("-50.1"), 400, c},
      {"certainty", deviation("0"), 400, std},
      {"a negative deviation", deviation("-1"), 400, std},
      {"no knowledge", deviation("101"), 400, std},
      {"a deviation as text", deviation(R"("1")"), 400, std},
      {"a time that is none", deviation(R"(1,"block_temperature_at":"today")"), 400, at},
      {"a time as number", deviation(R"(1,"block_temperature_at":0)"), 400, at},
      {"an arm that has moved for ever", with(R"("arm_moving_min":1441)"), 400, "/arm_moving_min"},
      {"moving as text", with(R"("arm_moving_min":"60")"), 400, "/arm_moving_min"},
      {"another kind", with(R"("kind":"trial")"), 400, "/kind"},
      {"a proof with its own plan", R"({"kind":"proof","plan_id":"x"})", 400, "/plan_id"},
      {"a proof with a choice of its own", R"({"kind":"proof","stiffness":"on"})", 400, "/stiffness"},
      {"a check by hand", R"({"kind":"check","touching":"guided"})", 400, "/touching"},
      {"a check of no run", R"({"kind":"check","of_run":"last"})", 400, "/of_run"},
      {"a check of a number", R"({"kind":"check","of_run":3})", 400, "/of_run"},
      {"a calibration of a run", with(R"("of_run":"3")"), 400, "/of_run"},
      {"no kind", with(R"("kind":null)"), 400, "/kind"}};
  for (const BadBody& bad : bodies) {
    const json document = problem(post("/api/v1/runs", bad.body));
    EXPECT_EQ(document.at("status"), bad.status) << bad.what << ": " << document;
    EXPECT_EQ(document.value("pointer", ""), bad.pointer) << bad.what << ": " << document;
  }
  // The clock of this cell stands at the beginning of 1970: one that is taken meets the missing link only.
  const json taken =
      problem(post("/api/v1/runs", deviation(R"(0.5,"kind":"calibration","arm_moving_min":60)")));
  ASSERT_EQ(taken.at("status"), 409);
  EXPECT_EQ(taken.at("errors").size(), 1u);
  const json future =
      problem(post("/api/v1/runs", deviation(R"(0.5,"block_temperature_at":"1970-01-01T00:10:00Z")")));
  ASSERT_EQ(future.at("status"), 409);
  EXPECT_EQ(future.at("errors").at(1).at("code"), "temperature_in_future");
}

TEST_F(StartBodyTest, AProofAndACheckNeedACalibrationToBeHeldAgainst) {
  const json nothing = problem(post("/api/v1/runs", R"({"kind":"proof"})"));
  EXPECT_EQ(nothing.at("status"), 409) << nothing;
  EXPECT_EQ(nothing.at("errors").at(0).at("code"), "no_calibration_to_hold_against") << nothing;
  const json unknown = problem(post("/api/v1/runs", R"({"kind":"check","of_run":"9"})"));
  EXPECT_EQ(unknown.at("status"), 422) << unknown;
  EXPECT_EQ(unknown.at("pointer"), "/of_run") << unknown;
  EXPECT_TRUE(cell_.store().runs(1).empty());
}

TEST_F(StartBodyTest, AStartTakesAChoiceOfStiffness) {
  const auto with = [](const std::string& rest) { return R"({"recipe":"edf-25",)" + rest + "}"; };
  for (const char* bad : {R"("stiffness":"yes")", R"("stiffness":true)", R"("stiffness":null)"}) {
    const json document = problem(post("/api/v1/runs", with(bad)));
    EXPECT_EQ(document.at("status"), 400) << bad << document;
    EXPECT_EQ(document.value("pointer", ""), "/stiffness") << bad << document;
  }
  // One that is taken meets the missing link only.
  for (const char* choice : {"on", "off", "auto"}) {
    const json taken = problem(post("/api/v1/runs", with(R"("stiffness":")" + std::string(choice) + '"')));
    ASSERT_EQ(taken.at("status"), 409) << taken;
    EXPECT_EQ(taken.at("errors").size(), 1u);
  }
}
}  // namespace
}  // namespace cell
