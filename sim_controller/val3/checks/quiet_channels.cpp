#include "sim_controller/val3/checks/quiet_channels.hpp"

#include "sim_controller/val3/checks/program_graph.hpp"
#include "sim_controller/val3/checks/uses.hpp"
#include "sim_controller/val3/language/scope.hpp"

namespace val3 {

void QuietChannels::add(const Application& application, const Expression& e) {
  if (e.kind != Expression::Kind::kCall || e.text != "sioCtrl" || e.parts.size() != 3) return;
  if (e.parts[1].text != "timeout") return;
  const bool is_quiet = constant_of(e.parts[2]).value_or(0.0) < 0.0;
  any_ = any_ || is_quiet;
  if (const Global* const global = global_of(application, root_of(e.parts[0])))
    (is_quiet ? quiet_ : with_time_).insert(global);
}

bool QuietChannels::contains(const Application& application, const Expression& channel) const {
  const Global* const global = global_of(application, root_of(channel));
  return global == nullptr ? any_ : quiet_.contains(global);
}

bool QuietChannels::surely_contains(const Application& application, const Expression& channel) const {
  const Global* const global = global_of(application, root_of(channel));
  return global != nullptr && quiet_.contains(global) && !with_time_.contains(global);
}

}  // namespace val3
