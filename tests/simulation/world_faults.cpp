// What goes wrong in a world: begun at its time or by what is seen, over after a time or when a person comes.
#include <spdlog/fmt/fmt.h>

#include "config/fault_file.hpp"
#include "sim_controller/fault_names.hpp"
#include "tests/simulation/running_world.hpp"

namespace simulation {
namespace {

using namespace std::chrono_literals;

/// A daemon that ends has so much time; then systemd kills it.
constexpr Time kEndPatience = 20s;

}  // namespace

void World::begin_for_a_time(const DrawnFault& fault, const std::function<void()>& end) {
  const auto is_over = [this, &fault, end] {
    journal_.note("fault", fmt::format("is over: {}", fault_kind_name(fault.kind)));
    end();
  };
  if (fault.lasts == kUntilMended) {
    mended_.push_back(is_over);
  } else {
    events_.emplace(clock_.now() + fault.lasts, is_over);
  }
}

void World::disk_trouble(const DrawnFault& fault, DiskTrouble trouble) {
  disk_.trouble = trouble;
  begin_for_a_time(fault, [this] { disk_.trouble = DiskTrouble::kNone; });
}

void World::begin(const DrawnFault& fault) {
  journal_.note("fault", fault_text(fault));
  switch (fault.kind) {
    case FaultKind::kController:
      controller_.inject(sim::planned(std::get<cell::DeclaredFault>(cell::parse_control_line(fault.line))));
      break;
    case FaultKind::kLinkCut:
      network_.cut();
      break;
    case FaultKind::kLinkHalfOpen:
      network_.half_open();
      break;
    case FaultKind::kLinkHeldUp:
      network_.hold_up(fault.lasts);
      break;
    case FaultKind::kLinkInPieces:
      network_.conditions.piece_max = static_cast<std::size_t>(fault.number);
      begin_for_a_time(fault, [this] { network_.conditions.piece_max = 0; });
      break;
    case FaultKind::kLinkRefuses:
      network_.conditions.refuses = true;
      begin_for_a_time(fault, [this] { network_.conditions.refuses = false; });
      break;
    case FaultKind::kLinkSwallows:
      network_.conditions.swallows = true;
      begin_for_a_time(fault, [this] { network_.conditions.swallows = false; });
      break;
    case FaultKind::kDiskFull:
      disk_trouble(fault, DiskTrouble::kFull);
      break;
    case FaultKind::kDiskWriteFails:
      disk_trouble(fault, DiskTrouble::kWriteFails);
      break;
    case FaultKind::kDiskSyncFails:
      disk_trouble(fault, DiskTrouble::kSyncFails);
      break;
    case FaultKind::kDiskWritesShort:
      disk_trouble(fault, DiskTrouble::kWritesShort);
      break;
    case FaultKind::kDiskStalls:
      process_.store_answers_at = fault.lasts == kUntilMended ? kUntilMended : clock_.now() + fault.lasts;
      begin_for_a_time(fault, [this, &fault] {
        if (fault.lasts == kUntilMended) process_.store_answers_at = clock_.now();
      });
      break;
    case FaultKind::kClockJumps:
      clock_.set_wall_clock_ahead(clock_.wall_ahead() + fault.lasts);
      break;
    case FaultKind::kKilled:
      process_.dies_now = process_.daemon != nullptr;
      break;
    case FaultKind::kKilledAtStart:
    case FaultKind::kPowerFailsAtStart:
      if (process_.daemon) end_daemon("the daemon is killed");
      [[fallthrough]];  // it is the next one that dies by its writes
    case FaultKind::kKilledAtWrite:
    case FaultKind::kPowerFails:
      process_.writes_left = fault.number;
      process_.power_fails = takes_power(fault.kind);
      break;
    case FaultKind::kTerminated:
      if (!process_.daemon || process_.killed_by) break;
      process_.killed_by = clock_.now() + kEndPatience;
      process_.daemon->begin_end();
      break;
    case FaultKind::kCommand:
      if (!process_.daemon) break;
      if (fault.command == cell::Command::kStart) {
        start_run();
      } else if (const auto refusal = process_.daemon->operation().command(fault.command)) {
        journal_.note("fault", "refused: " + refusal->detail);
        rest_.see(refusal_text(*refusal));
      }
      break;
    case FaultKind::kClientsFlood:
    case FaultKind::kClientRepeatsKey:
    case FaultKind::kClientsStopReading:
      clients_.begin(fault);
      break;
  }
}

// ---- by what is seen ----

/// Not from where it was seen, which is in the middle of what somebody does.
void World::strike_due() {
  while (const std::vector<DrawnFault>* due = script_.take_due()) {
    if (script_.is_over()) rest_.on_struck(clock_.now(), controller_.report());
    for (const DrawnFault& fault : *due) begin(fault);
    kill_if_due();
    poke();
  }
}

void World::look_for_rest() {
  constexpr Time kBetweenLooks = 20ms;
  if (scenario_.script.empty() || rest_.is_over() || next_look_for_rest_ > clock_.now()) return;
  next_look_for_rest_ = clock_.now() + kBetweenLooks;
  const bool is_served = process_.daemon && !process_.killed_by;
  rest_.look(clock_.now(), is_served ? &process_.daemon->operation() : nullptr, controller_.report());
  if (rest_.is_over()) mend();
}

/// What lasts until a person comes is over, and what has not come does not come any more.
void World::mend() {
  journal_.note("watcher", record_.rest.at ? "it is at rest: the person comes" : "it does not come to rest");
  given_before_rest_ = std::ssize(person_.given());
  for (const auto& end : mended_) end();
  mended_.clear();
  process_.writes_left.reset();
  poke();
}

}  // namespace simulation
