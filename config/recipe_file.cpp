#include "config/recipe_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"

namespace cell {
namespace {

constexpr int kTouchesPerPlaneMax = 10'000;
constexpr int kIterationsMax = 1'000;

void read_touch_counts(const JsonValue& value, int face_count, Recipe& recipe) {
  const JsonObject object = value.object({"planes", "fit_per_plane", "held_out_per_plane"});
  for (const JsonValue& plane : object.at("planes").items(1, static_cast<std::size_t>(face_count))) {
    const int face = plane.integer(1, face_count) - 1;
    if (std::find(recipe.faces.begin(), recipe.faces.end(), face) != recipe.faces.end()) {
      plane.fail("this plane is there twice; name it once");
    }
    recipe.faces.push_back(face);
  }
  recipe.fit_per_face = object.at("fit_per_plane").integer(1, kTouchesPerPlaneMax);
  recipe.held_out_per_face = object.at("held_out_per_plane").integer(0, kTouchesPerPlaneMax);
}

std::vector<int> parameters_from_json(const JsonValue& value) {
  std::vector<int> indices;
  for (const JsonValue& item : value.items(0, calib::kErrorParameterCount)) {
    const std::string name = item.text();
    const std::optional<int> index = calib::error_parameter_index(name);
    if (!index)
      item.fail("unknown parameter " + in_quotes(name) + "; give a name such as \"alpha6\" or \"r2\"");
    if (std::find(indices.begin(), indices.end(), *index) != indices.end()) {
      item.fail("this parameter is there twice; name it once");
    }
    indices.push_back(*index);
  }
  return indices;
}

calib::Formulation formulation_from_json(const JsonValue& value) {
  const std::string name = value.text();
  if (name == "signed_distance") return calib::Formulation::kSignedDistance;
  if (name == "plane_coefficients") return calib::Formulation::kPlaneCoefficients;
  value.fail("is " + in_quotes(name) + "; give \"signed_distance\" or \"plane_coefficients\"");
}

calib::ColumnScaling weights_from_json(const JsonValue& value) {
  const std::string name = value.text();
  if (name == "columns") return calib::ColumnScaling::kUnitNorm;
  if (name == "units") return calib::ColumnScaling::kUnits;
  value.fail("is " + in_quotes(name) + R"(; give "columns" or "units")");
}

bool stiffness_from_json(const JsonValue& value, const Arm& arm) {
  const bool wanted = value.boolean();
  if (wanted && !arm.std_compliance_rad_per_nm[0]) {
    value.fail("the arm " + in_quotes(arm.name) +
               " has no masses or no std_compliance_rad_per_nm; add \"gravity\" to its file or give false");
  }
  return wanted;
}

calib::IdentificationOptions identification_from_json(const JsonValue& value, const Arm& arm) {
  const JsonObject object = value.object({"formulation", "qr_tolerance", "tried_last", "excluded", "weights",
                                          "robust", "prior", "stiffness", "hold_weak", "iterations_max"});
  calib::IdentificationOptions options;
  if (const auto formulation = object.find("formulation"))
    options.formulation = formulation_from_json(*formulation);
  constexpr NumberRange kTolerances{.min = 1e-20};
  if (const auto tolerance = object.find("qr_tolerance"))
    options.identifiability.qr_tolerance = tolerance->number(kTolerances);
  if (const auto names = object.find("tried_last"))
    options.identifiability.tried_last = parameters_from_json(*names);
  if (const auto names = object.find("excluded"))
    options.identifiability.excluded = parameters_from_json(*names);
  if (const auto weights = object.find("weights")) options.weights = weights_from_json(*weights);
  if (const auto robust = object.find("robust")) options.robust = robust->boolean();
  if (const auto prior = object.find("prior")) options.prior = prior->boolean();
  if (const auto stiffness = object.find("stiffness"))
    options.stiffness = stiffness_from_json(*stiffness, arm);
  if (const auto hold_weak = object.find("hold_weak")) options.hold_weak = hold_weak->boolean();
  if (const auto count = object.find("iterations_max"))
    options.iterations_max = count->integer(1, kIterationsMax);
  return options;
}

}  // namespace

Recipe read_recipe(const std::filesystem::path& file, const Arm& arm, const Block& block) {
  const std::string source = file.string();
  const nlohmann::json document = read_json_file(file);
  const JsonObject object =
      JsonValue(source, document)
          .document(kRecipeSchema, {"schema", "name", "description", "touches", "identification"});
  Recipe recipe;
  recipe.name = object.at("name").text();
  recipe.description = object.at("description").text();
  read_touch_counts(object.at("touches"), static_cast<int>(block.faces.size()), recipe);
  recipe.identification = identification_from_json(object.at("identification"), arm);
  return recipe;
}

}  // namespace cell
