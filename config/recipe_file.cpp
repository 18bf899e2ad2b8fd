#include "config/recipe_file.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/recipe.hpp"
#include "config/schema_version.hpp"
#include "config/stiffness_choice.hpp"
#include "config/touched_places.hpp"

namespace cell {
namespace {

/// Fitted touches of a recipe, and held-out ones.
constexpr int kTouchesMax = 2'000;
constexpr int kIterationsMax = 1'000;

/// `"all"`, or the planes by number.
std::vector<int> faces_from_json(const JsonValue& value, int face_count) {
  std::vector<int> faces;
  if (value.is_text()) {
    if (value.text() != "all")
      value.fail("is " + in_quotes(value.text()) + R"(; give "all" or a list of planes)");
    for (int face = 0; face < face_count; ++face) faces.push_back(face);
    return faces;
  }
  for (const JsonValue& plane : value.items(1, static_cast<std::size_t>(face_count))) {
    const int face = plane.integer(1, face_count) - 1;
    if (std::find(faces.begin(), faces.end(), face) != faces.end()) {
      plane.fail("this plane is there twice; name it once");
    }
    faces.push_back(face);
  }
  return faces;
}

calib::PlanCriterion criterion_from_json(const JsonValue& value) {
  const std::string name = value.text();
  for (const auto& [criterion, known] : kCriterionNames) {
    if (name == known) return criterion;
  }
  value.fail("is " + in_quotes(name) +
             R"(; give "tip_box", "tip_joint_ranges", "information" or "condition_number")");
}

void read_touch_counts(const JsonValue& value, int face_count, Recipe& recipe) {
  const JsonObject object =
      value.object({"planes", "fit_per_plane", "fit", "held_out_per_plane", "criterion", "tip_rms_max_mm"});
  recipe.faces = faces_from_json(object.at("planes"), face_count);
  const int planes = static_cast<int>(recipe.faces.size());
  const auto in_all = object.find("fit");
  if (in_all && object.find("fit_per_plane"))
    in_all->fail(R"(stands beside "fit_per_plane"; give one of them)");
  if (in_all) {
    recipe.goal.fit_count = in_all->integer(planes, kTouchesMax);
  } else {
    recipe.fit_per_face = object.at("fit_per_plane").integer(1, kTouchesMax / planes);
  }
  recipe.held_out_per_face = object.at("held_out_per_plane").integer(0, kTouchesMax / planes);
  if (const auto criterion = object.find("criterion"))
    recipe.goal.criterion = criterion_from_json(*criterion);
  if (const auto accuracy = object.find("tip_rms_max_mm")) {
    if (!in_all)
      accuracy->fail(
          R"(has no end beside "fit_per_plane"; give "fit", how many touches there may be at most)");
    recipe.goal.tip_rms_max_m = calib::metres_from_mm(accuracy->number({.min = 1e-12}));
  }
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

[[noreturn]] void refuse_name(const JsonValue& item, const std::string& owner, const std::string& what) {
  item.fail(owner + " has no " + what + " " + in_quotes(item.text()) + "; give one of " +
            in_quotes(what + "s") + " in its file");
}

/// Names of things of the block or the probe, each once, in the order of the run. `owner`: "the block \"b\"";
/// `what`: "place", of which its file has a list.
template <class Named>
std::vector<int> indices_by_name(const JsonValue& value, const std::vector<Named>& all,
                                 const std::string& owner, const std::string& what) {
  std::vector<int> indices;
  for (const JsonValue& item : value.items(1, std::max<std::size_t>(all.size(), 1))) {
    const std::string name = item.text();
    const auto found = std::ranges::find(all, name, &Named::name);
    if (found == all.end()) refuse_name(item, owner, what);
    const auto index = static_cast<int>(found - all.begin());
    if (std::ranges::find(indices, index) != indices.end())
      item.fail("this " + what + " is there twice; name it once");
    indices.push_back(index);
  }
  return indices;
}

std::vector<int> places_from_json(const JsonValue& value, const Block& block) {
  return indices_by_name(value, block.places, "the block " + in_quotes(block.name), "place");
}

std::vector<int> tips_from_json(const JsonValue& value, const Probe& probe) {
  const std::string owner = "the probe " + in_quotes(probe.name);
  if (probe.tips.empty())
    value.fail(owner + R"( has no tips but the first; leave this out, or give the probe's file "tips")");
  return indices_by_name(value, probe.tips, owner, "tip");
}

/// Of the first schema true or false (the default), since then "on", "off" or "auto" (the default).
/// `outranking`: in place of it, so that the arm does not matter for what the file says.
StiffnessChoice stiffness_from_json(const std::optional<JsonValue>& value, bool is_first_schema,
                                    const Arm& arm, std::optional<StiffnessChoice> outranking) {
  if (!value) return outranking.value_or(is_first_schema ? StiffnessChoice::kOff : StiffnessChoice::kAuto);
  std::optional<StiffnessChoice> choice;
  if (is_first_schema) {
    choice = value->boolean() ? StiffnessChoice::kOn : StiffnessChoice::kOff;
  } else {
    choice = stiffness_choice_named(value->text());
  }
  if (!choice) value->fail("is " + in_quotes(value->text()) + R"(; give "on", "off" or "auto")");
  if (outranking) return *outranking;
  if (*choice == StiffnessChoice::kOn && !can_estimate_stiffness(arm)) {
    value->fail("the arm " + in_quotes(arm.name) + " has no masses or no std_compliance_rad_per_nm; add " +
                "\"gravity\" to its file or give " + (is_first_schema ? "false" : R"("off")"));
  }
  return *choice;
}

/// "auto" (the default since the second schema): tried, and kept where the touches ask for it; or "off".
calib::Harmonics harmonics_from_json(const std::optional<JsonValue>& value, bool is_first_schema) {
  if (is_first_schema) {
    if (value) value->fail(R"(unknown key "harmonics" in a recipe of version 1; raise "schema" to 2)");
    return calib::Harmonics::kLeaveOut;
  }
  if (!value || value->text() == "auto") return calib::Harmonics::kWhenShown;
  if (value->text() == "off") return calib::Harmonics::kLeaveOut;
  value->fail("is " + in_quotes(value->text()) + R"(; give "auto" or "off")");
}

/// Likewise; "auto" in the second schema, which does not have the key.
calib::Ripple ripple_from_json(const std::optional<JsonValue>& value, int version) {
  if (version < 3) {
    if (value) value->fail(R"(unknown key "ripple" in a recipe of version 1 or 2; raise "schema" to 3)");
    return version == 1 ? calib::Ripple::kLeaveOut : calib::Ripple::kWhenShown;
  }
  if (!value || value->text() == "auto") return calib::Ripple::kWhenShown;
  if (value->text() == "off") return calib::Ripple::kLeaveOut;
  value->fail("is " + in_quotes(value->text()) + R"(; give "auto" or "off")");
}

calib::IdentificationOptions identification_from_json(const JsonValue& value, int version, const Arm& arm,
                                                      std::optional<StiffnessChoice> stiffness) {
  const JsonObject object =
      value.object({"formulation", "qr_tolerance", "tried_last", "excluded", "weights", "robust", "prior",
                    "stiffness", "harmonics", "ripple", "hold_weak", "iterations_max"});
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
  options.stiffness =
      is_estimated(stiffness_from_json(object.find("stiffness"), version == 1, arm, stiffness), arm);
  options.harmonics = harmonics_from_json(object.find("harmonics"), version == 1);
  options.ripple = ripple_from_json(object.find("ripple"), version);
  if (const auto hold_weak = object.find("hold_weak")) options.hold_weak = hold_weak->boolean();
  if (const auto count = object.find("iterations_max"))
    options.iterations_max = count->integer(1, kIterationsMax);
  return options;
}

/// Eq. 6 has no form for a sphere or bore, and none for planes of several places or for balls of several
/// tips.
void demand_planes_for_coefficients(const JsonObject& object, const Block& block, const Recipe& recipe) {
  if (recipe.identification.formulation != calib::Formulation::kPlaneCoefficients) return;
  if (!recipe.places.empty())
    object.at("places").fail(
        "stands beside the formulation \"plane_coefficients\", in which planes count by their distance "
        "from the origin; give \"signed_distance\"");
  if (!recipe.tips.empty())
    object.at("tips").fail(
        "stands beside the formulation \"plane_coefficients\", in which planes count by where one ball meets "
        "them; give \"signed_distance\"");
  for (const int face : recipe.faces) {
    const calib::Face& touched = block.faces[static_cast<std::size_t>(face)];
    if (touched.is_flat()) continue;
    for (const auto& [key, value] : object.at("identification").members()) {
      if (key != "formulation") continue;
      value.fail("plane " + std::to_string(face + 1) + " of the block is a " +
                 (touched.bore ? "bore" : "sphere") +
                 ", which has no plane coefficients; give \"signed_distance\", or "
                 "leave it out of /touches/planes");
    }
  }
}

/// The planes of all places and tips, each of which is touched.
void demand_touches_for_all(const JsonObject& object, const Block& block, const Recipe& recipe) {
  const auto planes = static_cast<int>(touched_faces(block, recipe).size());
  const std::string of_all = std::to_string(planes) + " planes of all places and tips";
  const bool each = recipe.fit_per_face > 0;
  if (!each && recipe.goal.fit_count < planes)
    object.at("touches").fail("has \"fit\" " + std::to_string(recipe.goal.fit_count) + " for the " + of_all +
                              "; give at least one a plane, or fewer places, tips or planes");
  if ((recipe.fit_per_face + recipe.held_out_per_face) * planes > 2 * kTouchesMax)
    object.at("touches").fail("wants more than " + std::to_string(2 * kTouchesMax) + " touches on the " +
                              of_all + "; give fewer a plane");
}

constexpr std::array kRecipeSchemas{kFirstRecipeSchema, kSecondRecipeSchema, kThirdRecipeSchema,
                                    kFourthRecipeSchema, kRecipeSchema};

}  // namespace

Recipe read_recipe(const std::filesystem::path& file, const Arm& arm, const Block& block, const Probe& probe,
                   std::optional<StiffnessChoice> stiffness) {
  const std::string source = file.string();
  const nlohmann::json document = read_json_file(file);
  const SchemaVersion version = schema_version(document, "recipe", kRecipeSchemas);
  const JsonObject object = JsonValue(source, document)
                                .document(kRecipeSchemas[static_cast<std::size_t>(version.number) - 1],
                                          {"schema", "name", "description", "touches", "reference_every",
                                           "places", "tips", "identification"});
  Recipe recipe;
  recipe.name = object.at("name").text();
  recipe.description = object.at("description").text();
  read_touch_counts(object.at("touches"), static_cast<int>(block.faces.size()), recipe);
  if (const auto every = object.find("reference_every"))
    recipe.reference_every = every->integer(0, kTouchesMax);
  if (const auto places = find_since(4, object, "places", version))
    recipe.places = places_from_json(*places, block);
  for (int place = 1; place < place_count(recipe); ++place)
    if (faces_at_place(block, recipe, place).empty())
      object.at("places").fail(
          "none of the recipe's planes moves there with the block; touch one that lies "
          "on the block's first solid, or leave \"places\" out");
  if (const auto tips = find_since(5, object, "tips", version)) recipe.tips = tips_from_json(*tips, probe);
  demand_touches_for_all(object, block, recipe);
  recipe.identification =
      identification_from_json(object.at("identification"), version.number, arm, stiffness);
  demand_planes_for_coefficients(object, block, recipe);
  return recipe;
}

}  // namespace cell
