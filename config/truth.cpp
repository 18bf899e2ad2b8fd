#include "config/truth.hpp"

#include <nlohmann/json.hpp>
#include <set>

#include "calib_core/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"

namespace cell {
namespace {

/// "r0_mm", "theta0_rad" or "theta0_deg"; the error goes in SI units into its place.
int read_error(const std::string& key, const JsonValue& value, calib::ErrorVector& errors) {
  const std::size_t underscore = key.find('_');
  const std::string name = key.substr(0, underscore);
  const std::string unit = underscore == std::string::npos ? "" : key.substr(underscore + 1);
  const std::optional<int> index = calib::error_parameter_index(name);
  if (!index) value.fail("unknown error " + in_quotes(key) + R"(; give names such as "r0_mm", "theta0_rad")");
  const bool is_length = calib::error_parameters()[static_cast<std::size_t>(*index)].is_length();
  if (is_length ? unit != "mm" : unit != "rad" && unit != "deg") {
    value.fail("the unit is not in the name; write " + in_quotes(name + (is_length ? "_mm" : "_rad")));
  }
  const double number = value.number();
  errors[*index] = unit == "mm"    ? calib::metres_from_mm(number)
                   : unit == "deg" ? calib::radians_from_degrees(number)
                                   : number;
  return *index;
}

}  // namespace

Truth read_truth(const std::filesystem::path& file) {
  const std::string source = file.string();
  const nlohmann::json document = read_json_file(file);
  const JsonObject object = JsonValue(source, document).document(kTruthSchema, {"schema", "name", "errors"});
  Truth truth;
  truth.name = object.at("name").text();
  std::set<int> given;
  for (const auto& [key, value] : object.at("errors").members()) {
    if (!given.insert(read_error(key, value, truth.errors)).second) {
      value.fail("this error is given in two units; keep one of them");
    }
  }
  return truth;
}

}  // namespace cell
