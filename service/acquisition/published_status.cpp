#include "service/acquisition/published_status.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "service/base/utc_time.hpp"

namespace cell {

PublishedStatus::PublishedStatus(Clocks clocks, Wake& wake, std::string instance_id, Hooks hooks)
    : clocks_(std::move(clocks)), wake_(wake), hooks_(std::move(hooks)) {
  status_.instance_id = std::move(instance_id);
  status_.since = format_utc(clocks_.system());
}

void PublishedStatus::enter(State state) {
  if (state == status_.state) return;
  spdlog::info("{} -> {}{}", state_name(status_.state), state_name(state),
               status_.run_id ? fmt::format(" (run {})", *status_.run_id) : "");
  status_.state = state;
  status_.waiting_for.reset();
  status_.since = format_utc(clocks_.system());
  hooks_.on_entered(state);
  publish();
  wake_.wake();
}

void PublishedStatus::apply(Event event) { enter(after_event(status_.state, event)); }

void PublishedStatus::raise(Fault fault, Event event) {
  const std::string name(describe(fault.code).name);
  spdlog::warn("fault {}: {}", name, fault.message());
  try {
    hooks_.store_fault(name, fault.message());
  } catch (const std::exception& error) {
    spdlog::error("the fault could not be stored: {}", error.what());
  }
  show(std::move(fault), event);
}

void PublishedStatus::show(Fault fault, Event event) {
  status_.fault = std::move(fault);
  publish();
  apply(event);
}

void PublishedStatus::warn(Fault fault) {
  spdlog::warn("warning {}: {}", describe(fault.code).name, fault.message());
  warning_before_ = std::exchange(status_.warning, std::move(fault));
  publish();
}

void PublishedStatus::end_warning(FaultCode code) {
  if (warning_before_ && warning_before_->code == code) warning_before_.reset();
  if (!status_.warning || status_.warning->code != code) return;
  spdlog::info("the warning {} is over", describe(code).name);
  status_.warning = std::exchange(warning_before_, std::nullopt);
  publish();
}

void PublishedStatus::publish() {
  ++status_.sequence;
  hooks_.describe(status_);
  if (status_listener_) status_listener_(status_);
}

void PublishedStatus::wait_for(std::optional<std::string> name) {
  if (status_.waiting_for == name) return;
  status_.waiting_for = std::move(name);
  publish();
}

void PublishedStatus::begin_run(std::int64_t run_id) {
  status_.run_id = run_id;
  status_.warning.reset();
  warning_before_.reset();
  status_.reference_drift_m.reset();
  status_.fault.reset();
  status_.verdict = Verdict::kNone;
}

void PublishedStatus::forget_run() {
  status_.run_id.reset();
  status_.recipe.reset();
  status_.verdict = Verdict::kNone;
  status_.fault.reset();
}

void PublishedStatus::set_last_accepted(std::int64_t run_id, std::optional<std::string> at) {
  status_.last_accepted_run_id = run_id;
  status_.last_accepted_at = std::move(at);
}

}  // namespace cell
