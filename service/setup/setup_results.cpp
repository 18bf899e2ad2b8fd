#include "service/setup/setup_results.hpp"

#include <nlohmann/json.hpp>

#include "service/base/json_figures.hpp"

namespace cell {

std::string setup_result_document(const std::string& cell_file, const std::vector<std::string>& files,
                                  const std::vector<std::string>& remarks,
                                  const std::map<std::string, double>& tip_box_max_by_recipe_mm) {
  return text_of({{"schema", "touchcal/setup-result/1"},
                  {"cell", cell_file},
                  {"files", files},
                  {"remarks", remarks},
                  {"tip_box_max_by_recipe_mm", tip_box_max_by_recipe_mm}});
}

std::string setup_arm_result_document(const std::string& arm, const std::string& file,
                                      const std::vector<std::string>& remarks) {
  return text_of(
      {{"schema", "touchcal/setup-arm-result/1"}, {"arm", arm}, {"file", file}, {"remarks", remarks}});
}

}  // namespace cell
