#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "cs8_protocol/names.hpp"
#include "tests/cs8_protocol/samples.hpp"

/// PROTOCOL.md is written by hand; these hold it to what the code does.
namespace cs8 {
namespace {

using Row = std::vector<std::string>;

std::string read_source(const std::string& path) {
  std::ifstream file(std::string(TOUCHCAL_SOURCE_DIR) + "/cs8_protocol/" + path);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Section {
  std::vector<Row> rows;  // of its tables, without heads
  std::string hex_head;   // what stands behind ```hex
  std::vector<std::uint8_t> hex;
};

Row cells_of(const std::string& line) {
  Row cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    cells.push_back(std::regex_replace(cell, std::regex("^ +| +$|`"), ""));
  }
  return cells;
}

/// By heading, without its number signs.
std::map<std::string, Section> read_page() {
  std::map<std::string, Section> sections;
  Section* section = nullptr;
  bool in_hex = false;
  bool in_table = false;
  std::istringstream page(read_source("PROTOCOL.md"));
  for (std::string line; std::getline(page, line);) {
    const bool is_row = line.starts_with('|');
    if (line.starts_with('#')) {
      section = &sections[line.substr(line.find(' ') + 1)];
    } else if (line.starts_with("```")) {
      in_hex = line.starts_with("```hex ");
      if (in_hex) section->hex_head = line.substr(7);
    } else if (in_hex) {
      std::istringstream bytes(line);
      for (std::string byte; bytes >> byte;) {
        section->hex.push_back(static_cast<std::uint8_t>(std::stoi(byte, nullptr, 16)));
      }
    } else if (is_row && in_table && !line.starts_with("| ---")) {
      section->rows.push_back(cells_of(line));
    }
    in_table = is_row;
  }
  return sections;
}

/// Type, value and size of each field in wire order, as the page writes them.
class FieldLister {
 public:
  struct Field {
    std::string type;
    std::string value;
    std::size_t size;
  };
  std::vector<Field> fields;

  template <class... Values>
  void operator()(const Values&... values) {
    (fields.push_back({type_name(values), text(values), sizeof(values)}), ...);
  }

 private:
  static std::string type_name(std::uint32_t) { return "u32"; }
  static std::string type_name(std::int32_t) { return "i32"; }
  template <class Enum>
    requires std::is_enum_v<Enum>
  static std::string type_name(Enum) {
    return "i32";
  }
  static std::string type_name(const Text16&) { return "16 bytes"; }
  static std::string type_name(const JointsMicrodeg&) { return "6 i32"; }
  static std::string type_name(const std::array<JointsMicrodeg, kViaCountMax>&) { return "30 i32"; }

  static std::string text(std::uint32_t number) { return std::to_string(number); }
  static std::string text(std::int32_t number) { return std::to_string(number); }
  template <class Enum>
    requires std::is_enum_v<Enum>
  static std::string text(Enum value) {
    return std::to_string(static_cast<std::int32_t>(value)) + " " + std::string(name(value));
  }
  static std::string text(const Text16& field) { return std::string(text_of(field)); }
  static std::string text(const JointsMicrodeg& joints) { return list({joints.begin(), joints.end()}); }
  static std::string text(const std::array<JointsMicrodeg, kViaCountMax>& postures) {
    std::vector<std::int32_t> all;
    for (const JointsMicrodeg& joints : postures) all.insert(all.end(), joints.begin(), joints.end());
    return list(all);
  }
  static std::string list(std::vector<std::int32_t> numbers) {
    while (numbers.size() > 1 && numbers.back() == 0) numbers.pop_back();
    std::string all;
    for (const std::int32_t number : numbers) all += (all.empty() ? "" : " ") + std::to_string(number);
    return all;
  }
};

/// The fields that messages.hpp hands to visit(), by struct name.
std::map<std::string, Row> declared_fields() {
  std::map<std::string, Row> declared;
  const std::string source = read_source("messages.hpp");
  const std::regex declaration(R"(struct (\w+) \{[^}]*?kType = (?:[^}]|\{\})*?fields\(([^)]*)\))");
  for (std::sregex_iterator found(source.begin(), source.end(), declaration), none; found != none; ++found) {
    const std::string fields = (*found)[2];
    const std::regex member(R"(m\.(\w+))");
    for (std::sregex_iterator field(fields.begin(), fields.end(), member); field != none; ++field) {
      declared[(*found)[1]].push_back((*field)[1]);
    }
  }
  return declared;
}

/// "touch_result" from "TouchResult".
std::string snake_case(const std::string& pascal) {
  std::string snake;
  for (const char c : pascal) {
    if (std::isupper(c) != 0 && !snake.empty()) snake += '_';
    snake += static_cast<char>(std::tolower(c));
  }
  return snake;
}

std::string heading(MessageType type) {
  return std::string(name(type)) + " (" + std::to_string(static_cast<int>(type)) + "), " +
         std::to_string(kHeaderSize + payload_size(type)) + " bytes";
}

TEST(ProtocolPage, EveryMessageHasASectionWithItsNumberAndSize) {
  const auto page = read_page();
  for (const Message& message : one_of_each()) {
    EXPECT_TRUE(page.contains(heading(type_of(message)))) << heading(type_of(message));
  }
}

TEST(ProtocolPage, EveryExampleInHexIsTheMessageItsTableDeclares) {
  const auto page = read_page();
  for (const Message& sample : one_of_each()) {
    const MessageType type = type_of(sample);
    SCOPED_TRACE(heading(type));
    const Section& section = page.at(heading(type));
    ASSERT_EQ(section.hex.size(), kHeaderSize + payload_size(type));
    const DecodeResult decoded = decode_frame(section.hex);
    ASSERT_TRUE(std::holds_alternative<Message>(decoded)) << std::get<DecodeError>(decoded).text();
    const auto& message = std::get<Message>(decoded);
    EXPECT_EQ(section.hex_head, std::string(name(type_of(message))) + " " + std::to_string(message.sequence));
    EXPECT_EQ(encode(message), section.hex);

    FieldLister lister;
    std::visit([&]<class Body>(const Body& body) { Body::visit(body, lister); }, message.payload);
    ASSERT_EQ(section.rows.size(), lister.fields.size());
    std::size_t byte = kHeaderSize;
    for (std::size_t i = 0; i < section.rows.size(); ++i) {
      const Row& row = section.rows[i];
      ASSERT_EQ(row.size(), 5u);
      EXPECT_EQ(row[0], std::to_string(byte));
      EXPECT_EQ(row[1], lister.fields[i].type) << row[2];
      EXPECT_EQ(row[3], lister.fields[i].value) << row[2];
      byte += lister.fields[i].size;
    }
    EXPECT_EQ(byte, section.hex.size());
  }
}

TEST(ProtocolPage, EveryFieldHasTheNameItHasInTheCode) {
  const auto page = read_page();
  std::map<std::string, Row> declared;
  for (const auto& [type, fields] : declared_fields()) declared[snake_case(type)] = fields;
  for (const Message& message : one_of_each()) {
    const std::string type(name(type_of(message)));
    Row documented;
    for (const Row& row : page.at(heading(type_of(message))).rows) documented.push_back(row.at(2));
    EXPECT_EQ(documented, declared[type]) << type;
  }
}

template <class Enum>
class ProtocolPageTable : public ::testing::Test {};

struct Table {
  const char* heading;
  std::size_t columns;
};
Table table_of(RejectReason) { return {"9. Reject reasons", 4}; }
Table table_of(Outcome) { return {"10. Outcomes", 4}; }
Table table_of(FaultCode) { return {"11. Fault codes", 4}; }
Table table_of(Phase) { return {"Phases", 3}; }
Table table_of(CaptureSource) { return {"Sources of a contact", 3}; }
Table table_of(WorkingMode) { return {"Working modes", 3}; }
Table table_of(PermitState) { return {"Permit states", 3}; }
Table table_of(PermitReason) { return {"Permit reasons", 3}; }

using Enumerations = ::testing::Types<RejectReason, Outcome, FaultCode, Phase, CaptureSource, WorkingMode,
                                      PermitState, PermitReason>;
TYPED_TEST_SUITE(ProtocolPageTable, Enumerations);

TYPED_TEST(ProtocolPageTable, ListsExactlyTheValuesThatTheCodecTakes) {
  const Table table = table_of(TypeParam{});
  std::map<std::string, std::string> documented;
  const auto page = read_page();
  for (const Row& row : page.at(table.heading).rows) {
    ASSERT_EQ(row.size(), table.columns) << row.at(0);
    documented[row[0]] = row[1];
    if (table.columns == 4) {
      EXPECT_FALSE(row[2].empty()) << row[1] << " has no cause";
      EXPECT_FALSE(row[3].empty()) << row[1] << " has no remedy";
    }
  }
  std::map<std::string, std::string> taken;
  for (int value = -100; value < 1000; ++value) {
    const auto named = name(static_cast<TypeParam>(value));
    if (!named.empty()) taken[std::to_string(value)] = named;
  }
  EXPECT_EQ(documented, taken);
}

}  // namespace
}  // namespace cs8
