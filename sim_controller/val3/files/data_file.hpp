#pragma once

#include <vector>

#include "sim_controller/val3/files/type_words.hpp"
#include "sim_controller/val3/files/xml_file.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What a data file is read with.
struct DataContext {
  const TypeWords& words;
  const std::vector<UserType>& user_types;
  const std::vector<std::size_t>& elements_of_user;  // as ElementBudget::of() wants them
  ElementBudget& budget;
};

/// Appends the variables of a data file (.dtx) of any form, in the file's order. Language reference, 1.3 and
/// 1.4. What does not belong there is found and left out.
void read_data_file(const XmlFile& xml, const DataContext& context, FileFindings& findings,
                    std::vector<Global>& globals);

}  // namespace val3
