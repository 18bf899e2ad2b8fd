#pragma once

#include <map>
#include <string>
#include <vector>

/// What the commands say with --json; the fields are those of service/doc/surfaces.md, section 3.
namespace cell {

std::string setup_result_document(const std::string& cell_file, const std::vector<std::string>& files,
                                  const std::vector<std::string>& remarks,
                                  const std::map<std::string, double>& tip_box_max_by_recipe_mm);

std::string setup_arm_result_document(const std::string& arm, const std::string& file,
                                      const std::vector<std::string>& remarks);

}  // namespace cell
