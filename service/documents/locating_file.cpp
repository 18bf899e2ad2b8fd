#include "service/documents/locating_file.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "service/base/digest.hpp"
#include "service/base/durable_file.hpp"

namespace cell {
namespace {

constexpr const char* kChecksumKey = "sha256";
/// More than any block asks for.
constexpr std::size_t kLocatingTouchesMax = 100;

template <class Value>
nlohmann::json json_or_null(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

std::optional<std::string> text_or_null(const nlohmann::json& json, const char* key,
                                        const JsonObject& document) {
  const JsonValue value = document.at(key);
  return json.at(key).is_null() ? std::nullopt : std::optional(value.text());
}

}  // namespace

void write_locating(const std::filesystem::path& file, const LocatingRecord& record) {
  nlohmann::json document{{"schema", kLocatingSchema},
                          {"config_digest", json_or_null(record.config_digest)},
                          {"from_place", json_or_null(record.from_place)},
                          {"touches", nlohmann::json::array()}};
  for (const LocatingTouch& touch : record.touches)
    document["touches"].push_back({{"joints_microdeg", touch.joints},
                                   {"moved_m", json_or_null(touch.moved_m)},
                                   {"touched_at", touch.touched_at}});
  document[kChecksumKey] = sha256_hex(document.dump());
  replace_file(file, document.dump() + '\n');
}

std::optional<LocatingRecord> read_locating(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  const nlohmann::json json = read_json_file(file);
  const JsonObject document =
      JsonValue(file.string(), json)
          .document(kLocatingSchema, {"schema", "config_digest", "from_place", "touches", kChecksumKey});
  nlohmann::json summed = json;
  summed.erase(kChecksumKey);
  if (document.at(kChecksumKey).text() != sha256_hex(summed.dump()))
    document.at(kChecksumKey).fail("does not match: the file is not as touchcald wrote it");
  LocatingRecord record{.config_digest = text_or_null(json, "config_digest", document),
                        .from_place = text_or_null(json, "from_place", document)};
  for (const JsonValue& value : document.at("touches").items(1, kLocatingTouchesMax)) {
    const JsonObject entry = value.object({"joints_microdeg", "moved_m", "touched_at"});
    LocatingTouch touch{.touched_at = entry.at("touched_at").text()};
    const auto joints = entry.at("joints_microdeg").items(touch.joints.size(), touch.joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i)
      touch.joints[i] = joints[i].integer(std::numeric_limits<std::int32_t>::min(),
                                          std::numeric_limits<std::int32_t>::max());
    const JsonValue moved = entry.at("moved_m");
    if (!json.at("touches").at(record.touches.size()).at("moved_m").is_null())
      touch.moved_m = moved.number(kNotNegative);
    record.touches.push_back(std::move(touch));
  }
  return record;
}

}  // namespace cell
