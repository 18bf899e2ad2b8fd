#pragma once

#include <vector>

#include "sim_controller/val3/files/type_words.hpp"
#include "sim_controller/val3/files/xml_file.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What a program file is read with.
struct ProgramContext {
  const TypeWords& words;
  const std::vector<std::size_t>& elements_of_user;
  Version language;
};

/// Appends the programs of a program file (.pgx) of any form, parsed. Language reference, 1.5.
void read_program_file(const XmlFile& xml, const ProgramContext& context, FileFindings& findings,
                       std::vector<Program>& programs);

}  // namespace val3
