#include "service/http/routes/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "config/utc_text.hpp"
#include "service/base/version.hpp"
#include "service/run/cell_figures.hpp"
#include "service/run/fault_table.hpp"

namespace cell {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;

Gauge& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

Family<Gauge>& gauges(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry);
}

constexpr double kUnknownFigure = std::numeric_limits<double>::quiet_NaN();

/// 0 also where the clock was set back since.
double age_s(const std::optional<std::string>& at, std::chrono::system_clock::time_point now) {
  if (!at) return 0.0;
  const auto time = time_from_utc(*at);
  return time ? std::max(std::chrono::duration<double>(now - *time).count(), 0.0) : kUnknownFigure;
}

/// Negative where `at` is behind.
double until_s(CellFigures::Time at, std::chrono::system_clock::time_point now) {
  return std::chrono::duration<double>(at - now).count();
}

/// 0 also where the clock was set back since.
double since_s(const std::optional<CellFigures::Time>& at, std::chrono::system_clock::time_point now) {
  return at ? std::max(-until_s(*at, now), 0.0) : kUnknownFigure;
}

double figure_of(std::optional<bool> is_so) { return is_so ? (*is_so ? 1.0 : 0.0) : kUnknownFigure; }

/// A family of one label whose rows come and go: what is not known has none.
class LabelledGauges {
 public:
  LabelledGauges(Family<Gauge>& family, std::string label) : family_(family), label_(std::move(label)) {}

  void show(const std::map<std::string, double>& figures) {
    std::erase_if(shown_, [&](const auto& row) {
      if (figures.contains(row.first)) return false;
      family_.Remove(row.second);
      return true;
    });
    for (const auto& [of, figure] : figures) {
      Gauge*& shown = shown_[of];
      if (!shown) shown = &family_.Add({{label_, of}});
      shown->Set(figure);
    }
  }

 private:
  Family<Gauge>& family_;
  std::string label_;
  std::map<std::string, Gauge*> shown_;
};

/// What is stored of the cell's checks and models.
class StoredFamilies {
 public:
  explicit StoredFamilies(prometheus::Registry& registry)
      : check_age_(gauge(registry, "touchcal_check_age_seconds",
                         "Since the newest check of the calibration that counts; NaN before the first")),
        check_due_(gauge(registry, "touchcal_check_due_seconds",
                         "Until the next check, negative when it is overdue; NaN without a rule")),
        check_passed_(gauge(registry, "touchcal_check_passed",
                            "1 where the newest check with a verdict found the cell unchanged, 0 where not")),
        arm_growth_(gauge(registry, "touchcal_arm_growth_ratio",
                          "Of the arm's lengths since the reference, by the newest check")),
        proof_passed_(gauge(registry, "touchcal_proof_passed",
                            "1 where the newest proof of the calibration that counts was passed, 0 where it "
                            "was missed")),
        model_age_(gauge(registry, "touchcal_approved_model_age_seconds",
                         "Since the approval of the cell's model; NaN where there is none")),
        model_of_this_arm_(gauge(registry, "touchcal_approved_model_of_this_arm",
                                 "1 where the approved model is of the arm with the serial number of the "
                                 "cell's file, 0 of another; NaN where one is unknown")),
        joint_(gauges(registry, "touchcal_check_joint_radians", "Offset of a joint, by the newest check"),
               "joint"),
        limit_ratio_(gauges(registry, "touchcal_check_limit_ratio",
                            "Of the newest point of a chart to its limit; over 1 it is beyond it"),
                     "quantity"),
        certificate_(gauges(registry, "touchcal_certificate_valid_seconds",
                            "Until the certificate of an artefact ends, negative when it has ended"),
                     "artefact") {}

  void show(const CellFigures& figures, std::chrono::system_clock::time_point now) {
    check_age_.Set(since_s(figures.checked_at, now));
    check_due_.Set(figures.check_due_at ? until_s(*figures.check_due_at, now) : kUnknownFigure);
    check_passed_.Set(figure_of(figures.is_unchanged));
    arm_growth_.Set(figures.arm_growth.value_or(kUnknownFigure));
    proof_passed_.Set(figure_of(figures.is_proved));
    model_age_.Set(since_s(figures.model_approved_at, now));
    model_of_this_arm_.Set(figure_of(figures.is_model_of_this_arm));
    std::map<std::string, double> joints, certificates;
    for (const auto& [joint, offset_rad] : figures.joint_offsets_rad)
      joints[std::to_string(joint)] = offset_rad;
    for (const auto& [artefact, ends_at] : figures.certificate_ends)
      certificates[artefact] = until_s(ends_at, now);
    joint_.show(joints);
    limit_ratio_.show(figures.limit_ratios);
    certificate_.show(certificates);
  }

 private:
  Gauge& check_age_;
  Gauge& check_due_;
  Gauge& check_passed_;
  Gauge& arm_growth_;
  Gauge& proof_passed_;
  Gauge& model_age_;
  Gauge& model_of_this_arm_;
  LabelledGauges joint_;
  LabelledGauges limit_ratio_;
  LabelledGauges certificate_;
};

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
  Counter& internal_errors = prometheus::BuildCounter()
                                 .Name("touchcal_internal_errors_total")
                                 .Help("Answers of 500, and of 503 for a database that is damaged")
                                 .Register(registry)
                                 .Add({});
  Family<Counter>& faults =
      prometheus::BuildCounter().Name("touchcal_faults_total").Help("Faults by code").Register(registry);
  Counter& touches = prometheus::BuildCounter()
                         .Name("touchcal_touches_total")
                         .Help("Touches that count, of all runs")
                         .Register(registry)
                         .Add({});
  Gauge& connected = gauge(registry, "touchcal_controller_connected", "1 while the controller is connected");
  Gauge& time = gauge(registry, "touchcal_time_seconds", "This machine's clock, since 1970");
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
  StoredFamilies stored{registry};
  CellFigures figures;
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
  // From the start: a series that begins with 1 has not risen, to Prometheus.
  for (const FaultEntry& entry : fault_table()) families_->faults.Add({{"code", std::string(entry.name)}});
}

Metrics::~Metrics() = default;

void Metrics::count_request(std::string_view method, std::string_view route, unsigned status) {
  Counter*& counter = families_->counters[{method, route, status}];
  if (!counter) {
    counter = &families_->requests.Add(
        {{"method", std::string(method)}, {"route", std::string(route)}, {"status", std::to_string(status)}});
  }
  counter->Increment();
  if (status == 500) count_internal_error();
}

void Metrics::count_internal_error() { families_->internal_errors.Increment(); }

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

void Metrics::take(const CellFigures& figures) { families_->figures = figures; }

std::string Metrics::text(const Status& status, std::chrono::system_clock::time_point now) {
  Families& all = *families_;
  for (const SinkState& sink : status.sinks) {
    const prometheus::Labels label{{"sink", sink.sink}};
    all.outbox_rows.Add(label).Set(static_cast<double>(sink.behind));
    all.outbox_oldest.Add(label).Set(age_s(sink.oldest_at, now));
    all.sink_connected.Add(label).Set(sink.connected ? 1.0 : 0.0);
  }
  all.time.Set(std::chrono::duration<double>(now.time_since_epoch()).count());
  const std::string state(state_name(status.state));
  if (all.shown_state != state && !all.shown_state.empty())
    all.state.Add({{"state", all.shown_state}}).Set(0.0);
  all.state.Add({{"state", state}}).Set(1.0);
  all.shown_state = state;
  all.connected.Set(status.controller.connected ? 1.0 : 0.0);
  all.link_age.Set(status.data_age_ms ? static_cast<double>(*status.data_age_ms) / 1e3 : kUnknownFigure);
  all.touches_done.Set(status.touches_done);
  all.condition.Set(status.condition_number.value_or(kUnknownFigure));
  all.stored.show(all.figures, now);
  return prometheus::TextSerializer().Serialize(all.registry.Collect());
}

}  // namespace cell
