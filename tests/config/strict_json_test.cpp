#include "config/strict_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "config/json_value.hpp"
#include "folder.hpp"

namespace cell {
namespace {

using testing::HasSubstr;

constexpr std::size_t kSizeMax = 10'000;

nlohmann::json parse(const std::string& bytes) { return parse_strict_json("body", bytes, kSizeMax); }

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') +
         std::string(static_cast<std::size_t>(depth), ']');
}

TEST(StrictJson, BuildsTheSameDocumentAsTheLibrary) {
  for (const std::string bytes :
       {R"({"a":[1,-2,3.5,1e3,true,false,null,"x"],"b":{"c":{},"d":[[],[{"e":0}]]},"":""})", "3", R"("text")",
        "[]", " {\n} \r\n", R"({"a":{"a":{"a":1}}})", R"(["\u0000 \ud83d\ude00"])", "18446744073709551615",
        "123456789012345678901234567890"}) {
    EXPECT_EQ(parse(bytes), nlohmann::json::parse(bytes)) << bytes;
  }
}

struct Refused {
  std::string bytes;
  std::string pointer;
  std::string said;
};

TEST(StrictJson, SaysWhereAndWhatItRefuses) {
  const std::vector<Refused> cases{
      {"", "", "empty"},
      {" \n\t", "", "empty"},
      {"{\"a\":1}x", "", "line 1, column 8"},
      {"{\"a\":1}{}", "", "line 1, column 8"},
      {"{\"a\":1,}", "", "line 1, column 8"},
      {"{\n \"a\": nope\n}", "", "line 2, column 8"},
      {"[1,\n2", "", "line 2, column 2: the JSON document ends too early"},
      {"[NaN]", "", "not JSON near"},
      {"[Infinity]", "", "not JSON near"},
      {"[1e999]", "", "1e999 is too large"},
      {"{\"a\":[0,-1e999]}", "/a", "too large"},
      {"{'a':1}", "", "not JSON"},
      {"// comment\n{}", "", "not JSON"},
      {"[01]", "", "not JSON"},
      {"\xEF\xBB\xBF{}", "", "byte order mark"},
      {std::string("{}\0", 3), "", "column 3: a NUL byte"},
      {std::string("{}\0rubbish", 10), "", "NUL"},
      {std::string("[\"a\0b\"]", 7), "", "NUL"},
      {"[\"\xFF\"]", "", "not JSON"},
      {"[\"\xC0\xAF\"]", "", "not JSON"},
      {"[\"\xED\xA0\x80\"]", "", "not JSON"},
      {"[\"\\ud800\"]", "", "not JSON"},
      {"{\"a\":1,\"a\":2}", "", "the key \"a\" is there twice"},
      {"{\"p\":[0,{\"a~/\":{\"x\":1,\"x\":2}}]}", "/p/1/a~0~1", "the key \"x\" is there twice"},
      {nested(kJsonDepthMax + 1), "", "nested more than 32 deep"},
      {std::string(1'000, '{'), "", "not JSON"},
      {std::string(kSizeMax + 1, ' '), "", "larger than 10000 bytes"},
  };
  for (const Refused& refused : cases) {
    const ConfigError error = error_of([&] { parse(refused.bytes); });
    EXPECT_EQ(error.pointer(), refused.pointer) << refused.bytes;
    EXPECT_THAT(error.what(), HasSubstr(refused.said)) << refused.bytes;
    EXPECT_THAT(error.what(), testing::StartsWith("body: ")) << refused.bytes;
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << refused.bytes;
  }
}

TEST(StrictJson, TheDeepestAllowedDocumentIsRead) {
  EXPECT_EQ(parse(nested(kJsonDepthMax)), nlohmann::json::parse(nested(kJsonDepthMax)));
}

TEST(StrictJson, AMillionOpenBracketsAreRefusedWithoutHarm) {
  const std::string bytes(1'000'000, '[');
  EXPECT_THAT(error_of([&] { parse_strict_json("body", bytes, bytes.size()); }).what(), HasSubstr("nested"));
}

TEST(StrictJson, EveryCutOfADocumentIsRefused) {
  const std::string whole = R"({"a":[1,2,{"b":"c"}],"d":null})";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(std::string(error_of([&] { parse(whole.substr(0, length)); }).what()), "") << length;
  }
}

TEST(JsonValue, SaysWhatIsWantedAndWhatIsThere) {
  const nlohmann::json document = parse(
      R"({"five":[1,2,3,4,5],"text":["x",1,1,1,1,1],"angle_deg":180,"angle_rad":3,"half":0.5,"empty":"","odd/~":1})");
  const JsonValue root("body", document);
  const JsonObject object =
      root.object({"five", "text", "angle_deg", "angle_rad", "half", "empty", "odd/~", "gone"});
  const auto what = [](const std::function<void()>& action) { return std::string(error_of(action).what()); };
  EXPECT_EQ(what([&] { static_cast<void>(object.at("five").numbers<6>()); }),
            "body: /five: wants 6 numbers, has 5; add the missing ones");
  EXPECT_EQ(what([&] { static_cast<void>(object.at("text").numbers<6>()); }),
            "body: /text/0: is a text; give a finite number");
  EXPECT_EQ(what([&] { static_cast<void>(object.radians("angle")); }),
            "body: /angle_rad: the angle is also given as \"angle_deg\"; keep one of them");
  EXPECT_EQ(what([&] { static_cast<void>(object.at("half").integer(0, 3)); }),
            "body: /half: is 0.5; give a whole number from 0 to 3");
  EXPECT_EQ(what([&] { static_cast<void>(object.at("gone")); }), "body: \"gone\" is missing; add it");
  EXPECT_EQ(what([&] { static_cast<void>(object.at("empty").text()); }),
            "body: /empty: is empty; give a text");
  EXPECT_EQ(what([&] { static_cast<void>(object.at("odd/~").text()); }),
            "body: /odd~1~0: is a number; give a text");
  EXPECT_THROW(static_cast<void>(object.at("undeclared")), std::logic_error);
  EXPECT_THAT(what([&] {
                static_cast<void>(root.object({"five", "text"}));
              }),
              HasSubstr("unknown key \"angle_deg\"; known here: five, text"));
}

}  // namespace
}  // namespace cell
