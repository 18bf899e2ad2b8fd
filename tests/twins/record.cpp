#include "tests/twins/record.hpp"

#include <iomanip>
#include <sstream>
#include <type_traits>
#include <utility>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"

namespace twins {
namespace {

class FieldList {
 public:
  template <class Value>
    requires(!std::is_same_v<Value, cs8::JointsMicrodeg>)
  void add(const char* name, Value value) {
    fields.push_back({name, static_cast<std::int64_t>(value)});
  }
  void add(const std::string& name, const cs8::JointsMicrodeg& joints) {
    for (std::size_t i = 0; i < joints.size(); ++i)
      fields.push_back({name + std::to_string(i + 1), joints[i]});
  }

  void list(const cs8::Welcome& m) {
    for (const char c : m.application) add("application", c);
    for (const char c : m.arm) add("arm", c);
    add("application_version", m.application_version);
    add("language_version", m.language_version);
    add("session", m.session);
    add("last_sequence", m.last_sequence);
    add("open_sequence", m.open_sequence);
    add("heartbeat_timeout_ms", m.heartbeat_timeout_ms);
    add("clock_ms", m.clock_ms);
    add("lower_limits", m.lower_limits);
    add("upper_limits", m.upper_limits);
    add("search_length_max_dmm", m.search_length_max_dmm);
    add("search_speed_max_um_s", m.search_speed_max_um_s);
  }
  void list(const cs8::Rejected& m) {
    add("reason", m.reason);
    add("detail", m.detail);
  }
  void list(const cs8::TouchResult& m) {
    add("outcome", m.outcome);
    add("phase", m.phase);
    add("source", m.source);
    add("contact", m.contact);
    add("stopped", m.stopped);
    add("overtravel_dmm", m.overtravel_dmm);
    add("search_speed_um_s", m.search_speed_um_s);
    add("monitor_speed_percent", m.monitor_speed_percent);
    add("contact_clock_ms", m.contact_clock_ms);
    add("error_number", m.error_number);
    add("first_source", m.first_source);
    add("first_contact", m.first_contact);
    add("edges", m.edges);
  }
  void list(const cs8::MoveResult& m) {
    add("outcome", m.outcome);
    add("phase", m.phase);
    add("joints", m.joints);
    add("error_number", m.error_number);
  }
  void list(const cs8::ResultUnknown& m) { add("command_sequence", m.command_sequence); }
  void list(const cs8::Fault& m) {
    add("code", m.code);
    add("detail", m.detail);
  }
  void list(const cs8::Permit& m) {
    add("run", m.run);
    add("state", m.state);
    add("reason", m.reason);
    add("detail", m.detail);
  }
  template <class NoneToCompare>
  void list(const NoneToCompare&) {}

  std::vector<Field> fields;
};

}  // namespace

std::vector<Field> fields_of(const cs8::Message& message) {
  FieldList list;
  list.add("sequence", message.sequence);
  std::visit([&list](const auto& payload) { list.list(payload); }, message.payload);
  return std::move(list.fields);
}

std::string text_of(const Entry& entry) {
  std::ostringstream at;
  at << std::fixed << std::setprecision(3) << std::setw(8) << entry.at_s << ' ';
  std::string text = at.str();
  if (std::holds_alternative<Closed>(entry.what)) return text + "closed";
  if (const auto* noted = std::get_if<Noted>(&entry.what)) return text + noted->what;
  const auto& message = std::get<cs8::Message>(entry.what);
  text += cs8::name(cs8::type_of(message));
  for (const Field& field : fields_of(message)) {
    const bool is_long = field.name.starts_with("application") || field.name.starts_with("arm") ||
                         field.name.find("limits") != std::string::npos;
    if (!is_long) text += " " + field.name + "=" + std::to_string(field.value);
  }
  return text;
}

}  // namespace twins
