#include "sim_controller/val3/checks/sarif.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>
#include <vector>

#include "sim_controller/val3/checks/report.hpp"
#include "sim_controller/val3/checks/rules.hpp"

namespace val3 {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kSchema = "https://json.schemastore.org/sarif-2.1.0.json";

/// A path as a URI: what is no plain character by its bytes (RFC 3986).
std::string uri_of(std::string_view path) {
  constexpr std::string_view kPlainCharacters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string uri = path.starts_with('/') ? "file://" : "";
  for (const char c : path) {
    if (kPlainCharacters.find(c) != std::string_view::npos) {
      uri += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    uri += '%';
    uri += kDigits[byte >> 4U];
    uri += kDigits[byte & 15U];
  }
  return uri;
}

Json json_of(const Rule& rule) {
  return {{"id", rule.id},
          {"shortDescription", {{"text", rule.what}}},
          {"fullDescription", {{"text", rule.why}}},
          {"help", {{"text", rule.remedy}}},
          {"defaultConfiguration", {{"level", name_of(rule.severity)}}}};
}

Json place_of(const Position& at) {
  Json place{{"artifactLocation", {{"uri", uri_of(at.file)}}}};
  if (at.line > 0) {
    place["region"] = {{"startLine", at.line}};
    if (at.column > 0) place["region"]["startColumn"] = at.column;
  }
  return {{"physicalLocation", std::move(place)}};
}

}  // namespace

void write_sarif(const Findings& findings, std::string_view tool_version, std::ostream& out) {
  std::set<std::string_view> found;
  for (const Finding& finding : findings) found.insert(finding.rule);
  Json rules = Json::array();
  for (const std::string_view id : found) {
    const Rule* const rule = find_rule(id);
    rules.push_back(rule != nullptr ? json_of(*rule) : Json{{"id", id}});
  }
  Json results = Json::array();
  for (const Finding& finding : findings) {
    const auto index = std::distance(found.begin(), found.find(finding.rule));
    results.push_back(
        {{"ruleId", finding.rule},
         {"ruleIndex", index},
         {"level", name_of(finding.severity)},
         {"message",
          {{"text", finding.remedy.empty() ? finding.what : finding.what + ". Remedy: " + finding.remedy}}},
         {"locations", Json::array({place_of(finding.at)})}});
  }
  const Json log{
      {"$schema", kSchema},
      {"version", "2.1.0"},
      {"runs",
       Json::array(
           {{{"tool",
              {{"driver", {{"name", "cs8sim"}, {"version", tool_version}, {"rules", std::move(rules)}}}}},
             {"columnKind", "unicodeCodePoints"},
             {"results", std::move(results)}}})}};
  // A name in a file may be of any bytes.
  out << log.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace val3
