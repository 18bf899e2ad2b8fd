#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "service/offline_programs/number_places.hpp"
#include "service/offline_programs/offline_target.hpp"
#include "service/offline_programs/xml_text.hpp"

/// The variables of a VAL3 data file (.dtx) of s5 to s8, with the places of the numbers of points, joints,
/// frames and trsfs. Language reference, 1.3 and 1.4.
namespace cell {

/// More elements than that hold no program's points.
inline constexpr std::size_t kStoredElementsMax = 200'000;

enum class StoredKind {
  kPoint,
  kJoint,
  kFrame,
  kTrsf,
  kOtherArm,  // points and joints of an arm that has not six axes: they can be left alone only
  kPlain,     // numbers, texts, signals, tools, ...: nothing here looks at them
  kUnknown,   // a user's type, which may hold points
};

/// "fPiece[0]", "alias:fPiece[0]".
struct FrameName {
  std::string alias;
  std::string name;
  std::string key = "0";
};

struct StoredElement {
  std::string key = "0";  // "3", "1,2"; of a collection its text
  int line = 0;
  /// Of a joint its angles in degrees, else a trsf. None where a file of s5 or s6 has no element for them.
  std::optional<NumberPlaces> numbers;
  std::optional<FrameName> father;  // of points and frames
  PostureWords posture;             // of points
};

struct StoredVariable {
  std::string name;
  StoredKind kind = StoredKind::kPlain;
  std::string type;  // as the file says
  int line = 0;
  bool is_collection = false;
  /// Elements that the variable has; those that are not in the file are 0.
  std::size_t size = 1;
  std::vector<StoredElement> elements;
};

struct StoredData {
  std::vector<StoredVariable> variables;
  std::map<std::string, std::size_t, std::less<>> places;  // of the variables by their names
};

/// Elements of kPlain, kOtherArm and kUnknown are not read. Throws ConfigError with the line: no data file, a
/// name, a key or a number of the wrong form, something twice, an unknown section, more than
/// kStoredElementsMax elements.
StoredData read_stored_data(const XmlText& xml);

/// "pPick[3]"; "pPick["left"]" of a collection.
std::string shown_element(const StoredVariable& variable, const std::string& key);

/// Used by both forms of a file.
struct VariableReader {
  explicit VariableReader(const XmlText& text) : xml(text) {}

  const XmlText& xml;
  StoredData data;
  std::size_t elements_left = kStoredElementsMax;

  [[nodiscard]] std::string required(pugi::xml_node element, const char* name) const;
  /// As s7 writes them, or without the axis's letter as s5 and s6 do.
  [[nodiscard]] PostureWords posture_of(pugi::xml_node element) const;
  /// "2 3", "2,3" as "2,3"; a key of an array has one to three numbers.
  [[nodiscard]] std::string index_key(pugi::xml_node element, const std::string& text) const;
  void take_element(pugi::xml_node element);
  void keep(pugi::xml_node element, StoredVariable variable);
};

/// The form of s5 and s6: a section a type.
void read_old_stored_data(VariableReader& reader);

}  // namespace cell
