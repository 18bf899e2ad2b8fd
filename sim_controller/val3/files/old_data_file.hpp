#pragma once

#include <vector>

#include "sim_controller/val3/files/data_file.hpp"
#include "sim_controller/val3/files/elements.hpp"

namespace val3 {

/// The variables of a data file of s5 or s6, whose values get the attributes of s7. Language reference, 1.3.
void read_old_data(Elements& in, pugi::xml_node root, const DataContext& context,
                   std::vector<Global>& globals);

/// world and flange are there in every application; s5 and s6 list them, s7 does not.
bool is_always_there(const Global& global);

}  // namespace val3
