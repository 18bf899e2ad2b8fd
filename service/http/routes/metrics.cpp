#include "service/http/routes/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <limits>
#include <map>
#include <tuple>

#include "service/base/version.hpp"

namespace cell {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;

Gauge& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

}  // namespace

struct Metrics::Families {
  prometheus::Registry registry;
  Family<Gauge>& state = prometheus::BuildGauge()
                             .Name("touchcal_state")
                             .Help("1 for the present PackML state of the cell")
                             .Register(registry);
  Family<Counter>& requests = prometheus::BuildCounter()
                                  .Name("touchcal_http_requests_total")
                                  .Help("Answers by route and status")
                                  .Register(registry);
  Family<Counter>& faults =
      prometheus::BuildCounter().Name("touchcal_faults_total").Help("Faults by code").Register(registry);
  Counter& touches = prometheus::BuildCounter()
                         .Name("touchcal_touches_total")
                         .Help("Touches that count, of all runs")
                         .Register(registry)
                         .Add({});
  Gauge& connected = gauge(registry, "touchcal_controller_connected", "1 while the controller is connected");
  Gauge& link_age = gauge(registry, "touchcal_link_age_seconds",
                          "Since the last message of the controller; NaN before the first");
  Gauge& touches_done = gauge(registry, "touchcal_run_touches_done", "Touches of the run so far");
  Gauge& condition =
      gauge(registry, "touchcal_run_condition_number", "Of the latest result; NaN before there is one");
  std::map<std::tuple<std::string_view, std::string_view, unsigned>, Counter*> counters;
  std::string shown_state;
  std::string counted_fault;  // code and message: the same fault is counted once
  std::optional<std::int64_t> run_id;
  int touches_counted = 0;
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {
  prometheus::BuildGauge()
      .Name("touchcal_build_info")
      .Help("1, with the version")
      .Register(families_->registry)
      .Add({{"version", std::string(kVersion)}})
      .Set(1.0);
}

Metrics::~Metrics() = default;

void Metrics::count_request(std::string_view method, std::string_view route, unsigned status) {
  Counter*& counter = families_->counters[{method, route, status}];
  if (!counter) {
    counter = &families_->requests.Add(
        {{"method", std::string(method)}, {"route", std::string(route)}, {"status", std::to_string(status)}});
  }
  counter->Increment();
}

void Metrics::follow(const Status& status) {
  Families& all = *families_;
  const std::string fault =
      status.fault ? std::string(describe(status.fault->code).name) + status.fault->detail : std::string();
  if (!fault.empty() && fault != all.counted_fault)
    all.faults.Add({{"code", std::string(describe(status.fault->code).name)}}).Increment();
  all.counted_fault = fault;
  if (status.run_id != all.run_id) all.touches_counted = 0;
  all.run_id = status.run_id;
  if (status.touches_done > all.touches_counted)
    all.touches.Increment(static_cast<double>(status.touches_done - all.touches_counted));
  all.touches_counted = status.touches_done;
}

std::string Metrics::text(const Status& status) {
  Families& all = *families_;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const std::string state(state_name(status.state));
  if (all.shown_state != state && !all.shown_state.empty())
    all.state.Add({{"state", all.shown_state}}).Set(0.0);
  all.state.Add({{"state", state}}).Set(1.0);
  all.shown_state = state;
  all.connected.Set(status.controller.connected ? 1.0 : 0.0);
  all.link_age.Set(status.data_age_ms ? static_cast<double>(*status.data_age_ms) / 1e3 : kUnknown);
  all.touches_done.Set(status.touches_done);
  all.condition.Set(status.condition_number.value_or(kUnknown));
  return prometheus::TextSerializer().Serialize(all.registry.Collect());
}

}  // namespace cell
