#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "sim_controller/val3/files/file_findings.hpp"
#include "sim_controller/val3/program/type.hpp"

namespace val3 {

/// Attributes of a stored value, with the names of s7.
using Attributes = std::map<std::string, std::string>;

/// Those that a value of this kind has, in their usual writing (truths as true and false, blend and
/// configuration as s7 writes them); the others, and values of the wrong form, are found and left out.
/// Language reference, 1.3 and 1.4.
Attributes checked_attributes(Kind kind, const Attributes& stored, int line, FileFindings& findings);

/// What a point, frame or tool is given in: "name[i]" or "alias:name[i]".
struct StoredFather {
  std::string alias;
  std::string name;
  std::size_t index = 0;
};
std::optional<StoredFather> father_in(std::string_view text);

/// A finite number that fills the text, blanks around it aside.
std::optional<double> number_in(std::string_view text);

}  // namespace val3
