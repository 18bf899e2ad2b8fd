// Every entry of every shipped file, spoiled in turn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::EndsWith;

using ReadConfig = CopiedConfig;

/// Pointers of everything in a document but its root.
std::vector<json::json_pointer> places_in(const json& value,
                                          const json::json_pointer& here = json::json_pointer("")) {
  std::vector<json::json_pointer> places;
  const auto visit = [&](const json& child, const json::json_pointer& place) {
    places.push_back(place);
    const auto deeper = places_in(child, place);
    places.insert(places.end(), deeper.begin(), deeper.end());
  };
  if (value.is_object()) {
    for (const auto& [key, child] : value.items()) visit(child, here / key);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) visit(value[i], here / i);
  }
  return places;
}

class EveryEntry : public ReadConfig, public testing::WithParamInterface<const char*> {
 protected:
  [[nodiscard]] ConfigError error_with(const json& document) const {
    const std::filesystem::path file = folder_.write(GetParam(), document.dump());
    return error_of(
        [&] { is_truth(GetParam()) ? static_cast<void>(read_truth(file)) : static_cast<void>(read_cell()); });
  }
  /// The cell that has the file.
  [[nodiscard]] Cell read_cell() const {
    const bool is_of_star = std::string_view(GetParam()).starts_with("cells/star/");
    return cell::read_cell(path(is_of_star ? kStarCell : kCell));
  }
};
INSTANTIATE_TEST_SUITE_P(Files, EveryEntry,
                         testing::Values(kArm, kBlock, kProbe, kRecipe, kCell, kTruth, kRealTruth, kStarProbe,
                                         kStarRecipe, kStarTruth));

TEST_P(EveryEntry, ThatIsNullIsRefusedAtItsPlace) {
  const json whole = json_of(path(GetParam()));
  for (const json::json_pointer& place : places_in(whole)) {
    json document = whole;
    document[place] = nullptr;
    EXPECT_EQ(error_with(document).pointer(), place.to_string());
  }
}

TEST_P(EveryEntry, ThatIsANumberIsRefusedWhenItIsBeyondAllMeasure) {
  const json whole = json_of(path(GetParam()));
  for (const json::json_pointer& place : places_in(whole)) {
    if (!whole.at(place).is_number()) continue;
    for (const double number : {1e308, -1e308}) {
      json document = whole;
      document[place] = number;
      EXPECT_EQ(error_with(document).pointer(), place.to_string()) << number;
    }
  }
}

TEST_P(EveryEntry, ThatIsAnObjectTakesNoKeyItDoesNotKnow) {
  const json whole = json_of(path(GetParam()));
  std::vector<json::json_pointer> places = places_in(whole);
  places.emplace_back("");
  for (const json::json_pointer& place : places) {
    if (!whole.at(place).is_object()) continue;
    json document = whole;
    document[place]["surprise"] = 1;
    EXPECT_EQ(error_with(document).pointer(), (place / "surprise").to_string());
  }
}

TEST_P(EveryEntry, ThatIsCutOffAnywhereIsRefused) {
  const std::string whole = json_of(path(GetParam())).dump();
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    folder_.write(GetParam(), whole.substr(0, length));
    const ConfigError error = error_of([&] {
      is_truth(GetParam()) ? static_cast<void>(read_truth(path(GetParam()))) : static_cast<void>(read_cell());
    });
    EXPECT_THAT(error.source(), EndsWith(GetParam())) << length;
  }
}

}  // namespace
}  // namespace cell
