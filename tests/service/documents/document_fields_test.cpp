#include "service/documents/internal/document_fields.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "service/documents/json_view.hpp"
#include "service/documents/problem_document.hpp"
#include "service/documents/run_document.hpp"
#include "service/http/server/problem.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::ThrowsMessage;

struct Inner {
  std::array<double, 2> pair{};

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("pair", self.pair);
  }
};

struct Sample {
  int count = 0;
  std::optional<double> figure;
  std::vector<Inner> list;
  std::map<std::string, std::string> texts;
  std::optional<std::optional<Inner>> place;
  std::optional<std::string> maybe;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("count", self.count);
    fields("figure", self.figure);
    fields("list", self.list);
    fields("texts", self.texts);
    fields("place", self.place);
    fields.if_set("maybe", self.maybe);
  }
};

Sample read(const char* text, Absent absent = Absent::kIsRefused) {
  return document_from<Sample>(text, absent);
}

TEST(DocumentFields, StandInTheOrderOfTheirDeclaration) {
  EXPECT_EQ(written(Sample{}), R"({"count":0,"figure":null,"list":[],"texts":{},"place":null})");
  const char* full =
      R"({"count":2,"figure":0.1,"list":[{"pair":[1.0,2.5]}],"texts":{"a":"b"},"place":null,"maybe":"m"})";
  EXPECT_EQ(written(read(full)), full);
}

TEST(DocumentFields, AFigureThatIsNoNumberIsNull) {
  EXPECT_EQ(written(Inner{{std::numeric_limits<double>::quiet_NaN(), 1.0}}), R"({"pair":[null,1.0]})");
}

TEST(DocumentFields, NullAndAbsentAreNotTheSameWhereBothMeanSomething) {
  const char* rest = R"({"count":2,"list":[],"texts":{}})";
  EXPECT_FALSE(read(rest).place.has_value());
  const Sample with_null = read(R"({"count":2,"list":[],"texts":{},"place":null})");
  ASSERT_TRUE(with_null.place.has_value());
  EXPECT_FALSE(with_null.place->has_value());
}

TEST(DocumentFields, WhatIsNotThereKeepsItsDefaultOrIsRefused) {
  EXPECT_THAT([] { read("{}"); }, ThrowsMessage<DocumentError>("/count: is missing"));
  EXPECT_EQ(read("{}", Absent::kKeepsDefault).count, 0);
  EXPECT_EQ(read(R"({"count":null,"list":null})", Absent::kKeepsDefault).count, 0);
}

TEST(DocumentFields, TheWayToWhatCannotBeReadIsItsPointer) {
  EXPECT_THAT([] { read(R"({"count":1,"list":[{"pair":[1,2]},{"pair":[1,"2"]}],"texts":{}})"); },
              ThrowsMessage<DocumentError>("/list/1/pair/1: expected a number, found string"));
  EXPECT_THAT([] { read(R"({"count":1,"list":[{"pair":[1]}],"texts":{}})"); },
              ThrowsMessage<DocumentError>("/list/0/pair: expected an array of 2, found array"));
  EXPECT_THAT([] { read(R"({"count":1,"list":[],"texts":{"a":1}})"); },
              ThrowsMessage<DocumentError>("/texts/a: expected a text, found number"));
}

TEST(DocumentFields, AWholeNumberThatItsTypeDoesNotHoldIsRefused) {
  const auto counted = [](const std::string& count) {
    const std::string text = R"({"count":)" + count + R"(,"list":[],"texts":{}})";
    return read(text.c_str()).count;
  };
  EXPECT_EQ(counted("12"), 12);
  EXPECT_EQ(counted("12.0"), 12);
  EXPECT_EQ(counted("-2147483648"), std::numeric_limits<int>::min());
  for (const char* count : {"3.3e29", "-1e300", "2147483648", "-2147483649.0", "2147483648.0", "1.5",
                            "18446744073709551615", "9223372036854775808"})
    EXPECT_THROW(counted(count), DocumentError) << count;
}

TEST(StatusDocument, IsWrittenAsItWasRead) {
  for (const Status& status : {Status{}, Status{.run_id = 7,
                                         .touches_total = 140,
                                         .condition_number = 12.5,
                                         .by_hand = HandGuide{.about_joints = calib::JointVector::Ones()},
                                         .fault = Fault{FaultCode::kNoContact, "x"},
                                         .data_age_ms = 12}}) {
    const std::string text = status_document(status);
    EXPECT_EQ(document_text(read_status(text)), text);
  }
  EXPECT_THAT([] { read_status("{}"); }, ThrowsMessage<DocumentError>("/state: is missing"));
}

TEST(StatusDocument, AWordOfNoStateIsRefused) {
  EXPECT_THAT([] { read_status(R"({"state":"EXECUTED"})"); },
              ThrowsMessage<DocumentError>("/state: 'EXECUTED' is not a word of this version of touchcal"));
}

TEST(RunDocument, IsWrittenAsItWasRead) {
  const StoredRun run{
      .id = 2, .recipe = "edf-25", .conditions_json = R"({"touching":"guided","later":[1.50]})"};
  const std::string text = run_document(run),
                    page =
                        runs_document({.runs = {run, {}}, .damaged = {{1, "table runs"}}, .next_before = 1});
  EXPECT_EQ(document_text(read_run(text)), text);
  EXPECT_EQ(read_run(text).touch_mode, "guided");
  EXPECT_EQ(document_text(read_runs(page)), page);
  EXPECT_EQ(read_runs(page).damaged.at(0).detail, "table runs");
}

TEST(StartDocument, HoldsOnlyWhatIsAskedFor) {
  EXPECT_EQ(document_text(StartDocument{.operator_name = "A", .recipe = "edf-25"}),
            R"({"operator":"A","recipe":"edf-25"})");
  EXPECT_EQ(
      document_text(StartDocument{.block_temperature_c = 25.5,
                                  .recipe = "edf-25",
                                  .std_block_temperature_k = 0.5,
                                  .stiffness = "on"}),
      R"({"block_temperature_c":25.5,"recipe":"edf-25","std_block_temperature_k":0.5,"stiffness":"on"})");
}

/// The server writes the document and this reads it: the two hold the same keys.
TEST(ProblemDocument, IsReadInFull) {
  const ProblemDocument read = read_problem(to_response({.status = 409,
                                                         .kind = ProblemKind::kPreconditions,
                                                         .detail = "what",
                                                         .pointer = "/a",
                                                         .errors = {{"code", "why"}},
                                                         .exits = {"reset"},
                                                         .parameter = "p"})
                                                .body);
  EXPECT_EQ(read.type, "urn:touchcal:problem:preconditions");
  EXPECT_EQ(read.title, "Not in this state");
  EXPECT_EQ(read.status, 409);
  EXPECT_EQ(read.detail, "what");
  EXPECT_EQ(read.pointer, "/a");
  EXPECT_EQ(read.parameter, "p");
  EXPECT_EQ(read.errors.value().at(0).detail, "why");
  EXPECT_THAT(read.exits.value(), ElementsAre("reset"));
}

}  // namespace
}  // namespace cell
