#include "service/documents/internal/field_text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

#include "service/documents/internal/document_fields.hpp"

namespace cell {
namespace {

struct OneNumber {
  double number = 0.0;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("number", self.number);
  }
};

struct OfAllKinds {
  std::string name;
  calib::CompensationStatus status = calib::CompensationStatus::kWarned;
  std::optional<std::array<double, 3>> list;
  std::optional<std::string> nothing;
  bool is_there = true;
  std::optional<bool> left_out;
  std::optional<std::optional<double>> empty = std::optional<double>();

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("name", self.name);
    fields("status", self.status);
    fields("list", self.list);
    fields("nothing", self.nothing);
    fields("is_there", self.is_there);
    fields.if_set("left_out", self.left_out);
    fields.if_set("empty", self.empty);
  }
};

template <class Document>
std::string text_of_fields(const Document& document) {
  std::string text;
  FieldText::append(document, text);
  return text;
}

TEST(FieldText, IsWhatTheWriterOfFieldsGives) {
  OfAllKinds document{.name = "pick", .list = {{1.0, -2.5, 0.0}}};
  EXPECT_EQ(text_of_fields(document),
            R"({"name":"pick","status":"warned","list":[1.0,-2.5,0.0],"nothing":null,"is_there":true,)"
            R"("empty":null})");
  for (const char* name : {"", "with \"quotes\"", "back\\slash", "line\nfeed", "J\xc3\xbcrgen", "broken \xff",
                           "\x7f deleted", "a/b"}) {
    document.name = name;
    document.list.reset();
    document.left_out = false;
    document.empty = 0.25;
    EXPECT_EQ(text_of_fields(document), written(document)) << name;
  }
}

TEST(FieldText, WritesNumbersAsOtherDocumentsDo) {
  for (const double number :
       {0.0, -0.0, 1.0, -17.0, 0.1, 1e-4, 9.9e-5, 1e-9, 123456789.125, 999999999999999.0, 1e15, -2.5e20,
        1e300, 5e-324, std::numeric_limits<double>::max(), std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(text_of_fields(OneNumber{number}), written(OneNumber{number})) << number;
}

TEST(FieldText, NoDigitOfANumberIsLost) {
  std::mt19937_64 chance(11);
  for (int i = 0; i < 20'000; ++i) {
    const double number = std::bit_cast<double>(chance());
    if (!std::isfinite(number)) continue;
    const std::string text = text_of_fields(OneNumber{number});
    const double read = std::strtod(text.c_str() + std::string_view(R"({"number":)").size(), nullptr);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(number)) << text;
  }
}

}  // namespace
}  // namespace cell
