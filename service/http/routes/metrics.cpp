#include "service/http/routes/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "config/utc_text.hpp"
#include "service/base/version.hpp"

namespace cell {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;

Gauge& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

constexpr double kUnknownFigure = std::numeric_limits<double>::quiet_NaN();

/// 0 also where the clock was set back since.
double age_s(const std::optional<std::string>& at, std::chrono::system_clock::time_point now) {
  if (!at) return 0.0;
  const auto time = time_from_utc(*at);
  return time ? std::max(std::chrono::duration<double>(now - *time).count(), 0.0) : kUnknownFigure;
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
  Family<Gauge>& outbox_rows = prometheus::BuildGauge()
                                   .Name("touchcal_outbox_rows")
                                   .Help("Facts that a sink has not confirmed")
                                   .Register(registry);
  Family<Gauge>& outbox_oldest = prometheus::BuildGauge()
                                     .Name("touchcal_outbox_oldest_seconds")
                                     .Help("Age of the first of them; 0 where there is none")
                                     .Register(registry);
  Family<Gauge>& sink_connected = prometheus::BuildGauge()
                                      .Name("touchcal_sink_connected")
                                      .Help("1 while the sink is connected")
                                      .Register(registry);
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

std::string Metrics::text(const Status& status, std::chrono::system_clock::time_point now) {
  Families& all = *families_;
  for (const SinkState& sink : status.sinks) {
    const prometheus::Labels label{{"sink", sink.sink}};
    all.outbox_rows.Add(label).Set(static_cast<double>(sink.behind));
    all.outbox_oldest.Add(label).Set(age_s(sink.oldest_at, now));
    all.sink_connected.Add(label).Set(sink.connected ? 1.0 : 0.0);
  }
  const std::string state(state_name(status.state));
  if (all.shown_state != state && !all.shown_state.empty())
    all.state.Add({{"state", all.shown_state}}).Set(0.0);
  all.state.Add({{"state", state}}).Set(1.0);
  all.shown_state = state;
  all.connected.Set(status.controller.connected ? 1.0 : 0.0);
  all.link_age.Set(status.data_age_ms ? static_cast<double>(*status.data_age_ms) / 1e3 : kUnknownFigure);
  all.touches_done.Set(status.touches_done);
  all.condition.Set(status.condition_number.value_or(kUnknownFigure));
  return prometheus::TextSerializer().Serialize(all.registry.Collect());
}

}  // namespace cell
