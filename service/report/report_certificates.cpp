// What the lengths rest on, and what a certificate of a laboratory would have to say beside this report.
#include <spdlog/fmt/fmt.h>

#include <array>
#include <map>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

using html::Row;

/// The keys of a certificate that have a column of their own (config/FILES.md).
constexpr std::array kColumns{"laboratory", "number", "issued", "valid_until", "traceable_to"};

Row certificate_row(const Words& words, std::string_view what,
                    const ConditionsDocument::Certified& certified) {
  Row row{words(what), words.known(certified.name), words.known(certified.serial)};
  std::map<std::string, std::string> texts =
      certified.certificate.value_or(std::map<std::string, std::string>());
  for (const char* key : kColumns) {
    const auto found = texts.extract(key);
    row.push_back(found.empty() ? words("unknown") : words.known(found.mapped()));
  }
  std::string others;
  for (const auto& [key, text] : texts)
    others += fmt::format("{}{}: {}", others.empty() ? "" : "; ", key, text);
  row.push_back(others);
  return row;
}

/// ISO/IEC 17025:2017, 7.8.2.1 and 7.8.4.1: what the makers of this program cannot know.
std::vector<html::Text> to_be_added(const Words& words) {
  return {words("the name and address of the laboratory, and where the work was done"),
          words("the customer's name and how to reach them"),
          words("the method, with its number in the laboratory's own list and what was done otherwise"),
          words("the condition of the robot when it was received, and whether it was adjusted since"),
          words("the temperature of the room and its change during the run"),
          words("the statement that the result is of this robot alone"),
          words("the statement of metrological traceability, with the accreditation where there is one"),
          words("the name, function and signature of who authorizes the certificate")};
}

}  // namespace

std::string certificates_table(const Words& words, const ConditionsDocument& conditions) {
  return html::table(
      words, words("What the lengths rest on"),
      {words("instrument"), words("name"), words("serial number"), words("laboratory"), words("number"),
       words("issued"), words("valid until"), words("traceable to"), words("more")},
      {certificate_row(words, "block", conditions.block), certificate_row(words, "probe", conditions.probe)});
}

std::string certificates_section(const Words& words, const ConditionsDocument& conditions) {
  return section(
      words("Certificates"),
      certificates_table(words, conditions) +
          html::paragraph(words(
              "The chain of this calibration: the standard that the block's certificate names, the faces of "
              "the "
              "block at 20 °C, the touches, the errors of the arm. The block is the only ruler; an unknown "
              "certificate means that nobody vouches for it.")) +
          html::paragraph(
              words("This report is no certificate of a laboratory. One by ISO/IEC 17025 needs besides, from "
                    "whoever issues it:")) +
          bullets(to_be_added(words)));
}

}  // namespace cell
