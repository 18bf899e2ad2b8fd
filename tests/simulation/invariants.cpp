#include "tests/simulation/invariants.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>

#include "cs8_protocol/names.hpp"

namespace simulation {
namespace {

using cell::State;

/// A disk that stalls keeps a command waiting for a minute.
constexpr Time kAnswerPatience = std::chrono::minutes(3);

double seconds(Time time) { return std::chrono::duration<double>(time).count(); }

std::string motion_text(const MotionSent& motion) {
  return fmt::format("at {:.3f} s {} {} was sent", seconds(motion.at), cs8::name(motion.type),
                     motion.sequence);
}

/// Where a run waits for a person, or is over, the arm stands.
std::optional<std::string> moves_where_it_must_not(const Record& record) {
  for (const MotionSent& motion : record.motions) {
    if (motion.state != State::kHeld && motion.state != State::kAborted && motion.state != State::kStopped)
      continue;
    return motion_text(motion) + " in the state " + std::string(cell::state_name(motion.state));
  }
  return std::nullopt;
}

/// A permit that ends while the command is on its way out is none that the host could know of: what it read
/// in that same moment does not count.
std::optional<std::string> moves_unpermitted(const Record& record) {
  for (const MotionSent& motion : record.motions) {
    const cs8::Permit& permit = motion.permit;
    const bool is_retract = motion.type == cs8::MessageType::kRetract;
    const bool allows = permit.state == cs8::PermitState::kGranted ||
                        (is_retract && permit.state == cs8::PermitState::kRetractOnly);
    // Behind a run that is over the arm is taken back by a permit for that alone, which is of no run.
    const bool is_way_back = motion.state == State::kResetting;
    const bool is_of_run = is_way_back ? is_retract && permit.run == 0
                                       : motion.run && static_cast<std::uint32_t>(*motion.run) == permit.run;
    if ((allows && is_of_run) || motion.permit_read_at == motion.at) continue;
    return fmt::format("{} for run {}; the last permit, of run {}, was '{}' ('{}')", motion_text(motion),
                       motion.run.value_or(0), permit.run, cs8::name(permit.state), cs8::name(permit.reason));
  }
  return std::nullopt;
}

/// A touch that was made again beside the plan is stored without its command: its joints tell which it was.
constexpr std::uint32_t kNoCommand = 0;

bool is_answer(const Record& record, const cell::StoredTouch& touch) {
  const auto is_this = [&touch](const cs8::TouchResult& result) {
    return result.outcome == cs8::Outcome::kContact && result.contact == touch.joints;
  };
  if (touch.sequence == kNoCommand)
    return std::ranges::any_of(record.answers, [&](const auto& answer) { return is_this(answer.second); });
  const auto answer = record.answers.find({touch.session, touch.sequence});
  return answer != record.answers.end() && is_this(answer->second);
}

std::optional<std::string> wrong_in_accepted(const Record& record, const RunRecord& run) {
  if (run.run.touches_total != record.touches_planned)
    return fmt::format("it has {} touches of {} that are planned", run.run.touches_total,
                       record.touches_planned);
  std::set<int> numbers;
  for (const cell::StoredTouch& touch : run.touches) {
    if (!numbers.insert(touch.number).second) return fmt::format("touch {} is there twice", touch.number);
    if (!is_answer(record, touch))
      return fmt::format("touch {} is no contact that the controller gave", touch.number);
  }
  for (int number = 1; number <= run.run.touches_total; ++number)
    if (!numbers.contains(number)) return fmt::format("touch {} is missing", number);
  return std::nullopt;
}

std::optional<std::string> accepted_not_whole(const Record& record) {
  for (const StoreRecord& store : record.stores) {
    for (const RunRecord& run : store.runs) {
      if (run.run.verdict != cell::Verdict::kAccepted) continue;
      if (const auto wrong = wrong_in_accepted(record, run))
        return fmt::format("run {} is accepted, and {}", run.run.id, *wrong);
    }
  }
  return std::nullopt;
}

/// How often each command is among the touches of a store.
std::map<CommandNumber, int> stored_commands(const StoreRecord& store) {
  std::map<CommandNumber, int> counts;
  for (const RunRecord& run : store.runs) {
    for (const cell::StoredTouch& touch : run.touches) ++counts[{touch.session, touch.sequence}];
    for (const cell::SupersededTouch& old : run.superseded) ++counts[{old.touch.session, old.touch.sequence}];
  }
  return counts;
}

/// Whether a touch that was made again has this contact: in place of the first one, or beside it.
bool has_repetition(const StoreRecord& store, const cs8::JointsMicrodeg& contact) {
  const auto is_it = [&contact](const cell::StoredTouch& touch) {
    return touch.again == contact || (touch.sequence == kNoCommand && touch.joints == contact);
  };
  return std::ranges::any_of(store.runs, [&](const RunRecord& run) {
    return std::ranges::any_of(run.touches, is_it) ||
           std::ranges::any_of(run.superseded, is_it, &cell::SupersededTouch::touch);
  });
}

/// Kept as a contact that counts for nothing.
bool is_refused(const StoreRecord& store, const CommandNumber& command) {
  return std::ranges::any_of(store.runs, [&command](const RunRecord& run) {
    return std::ranges::any_of(run.refused, [&command](const cell::RefusedResult& refused) {
      return CommandNumber{refused.session, refused.sequence} == command;
    });
  });
}

std::optional<std::string> answers_lost(const Record& record) {
  for (const StoreRecord& store : record.stores) {
    const auto stored = stored_commands(store);
    for (std::size_t i = 0; i < store.acknowledged_count && i < record.acknowledged.size(); ++i) {
      const Acknowledged& answer = record.acknowledged[i];
      if (!answer.excuse.empty() || stored.contains(answer.command)) continue;
      if (is_refused(store, answer.command)) continue;
      if (has_repetition(store, answer.result.contact)) continue;
      return fmt::format(
          "at {:.3f} s the contact of command {} (session {}) was acknowledged, and at {:.3f} s ({}) no "
          "touch "
          "has it",
          seconds(answer.at), answer.command.sequence, answer.command.session, seconds(store.at),
          store.occasion);
    }
  }
  return std::nullopt;
}

std::optional<std::string> answers_doubled(const Record& record) {
  for (const StoreRecord& store : record.stores) {
    for (const auto& [command, count] : stored_commands(store)) {
      if (count < 2 || command.sequence == kNoCommand) continue;
      return fmt::format("at {:.3f} s ({}) the contact of command {} (session {}) is stored {} times",
                         seconds(store.at), store.occasion, command.sequence, command.session, count);
    }
  }
  return std::nullopt;
}

/// The touches of a run are in the order in which they were commanded; one that was made again stands where
/// the first one stood.
std::optional<std::string> answers_out_of_order(const Record& record) {
  for (const StoreRecord& store : record.stores) {
    for (const RunRecord& run : store.runs) {
      const auto was_repeated = [&run](int number) {
        return std::ranges::any_of(run.superseded,
                                   [number](const auto& old) { return old.touch.number == number; });
      };
      CommandNumber last;
      for (const cell::StoredTouch& touch : run.touches) {
        if (was_repeated(touch.number) || touch.sequence == kNoCommand) continue;
        const CommandNumber command{touch.session, touch.sequence};
        if (command <= last)
          return fmt::format("run {}: touch {} is of command {}, and the one before it of {}", run.run.id,
                             touch.number, command.sequence, last.sequence);
        last = command;
      }
    }
  }
  return std::nullopt;
}

/// At the end: what the store had before was read without results.
std::optional<std::string> result_differs(const Record& record) {
  if (record.stores.empty()) return std::nullopt;
  for (const RunRecord& run : record.stores.back().runs) {
    if (run.run.outcome != cell::RunOutcome::kComplete) continue;
    if (run.result_json == run.undisturbed_json) continue;
    return fmt::format("run {}: its {} touches give another result when nothing goes wrong", run.run.id,
                       run.touches.size());
  }
  return std::nullopt;
}

std::optional<std::string> dead_end(const Record& record) {
  for (const StateRecord& state : record.states) {
    if (!state.exits.empty()) continue;
    return fmt::format("at {:.3f} s nothing leads out of {}", seconds(state.at),
                       cell::state_name(state.state));
  }
  if (!record.came_to_end && !record.thrown)
    return "a person who does what the cell asks for does not come to an end";
  return std::nullopt;
}

/// Who asks again with the same key gets the first answer again.
std::optional<std::string> key_answered_otherwise(const Record& record) {
  std::map<std::string, const HttpAnswer*> firsts;
  for (const HttpAnswer& answer : record.http_answers) {
    if (answer.key.empty() || answer.status / 100 != 2 || answer.end != HttpAnswer::End::kAnswered) continue;
    const HttpAnswer& first = *firsts.emplace(answer.key, &answer).first->second;
    if (first.status == answer.status && first.body == answer.body) continue;
    if (!record.said_answer_not_kept)
      return fmt::format("at {:.3f} s {} with {} has another answer than at {:.3f} s", seconds(answer.at),
                         answer.request, answer.key, seconds(first.at));
  }
  return std::nullopt;
}

std::optional<std::string> request_left_alone(const Record& record) {
  for (const HttpAnswer& answer : record.http_answers) {
    if (answer.at - answer.asked_at <= kAnswerPatience) continue;
    return fmt::format("{} of {:.3f} s had no answer and no end at {:.3f} s", answer.request,
                       seconds(answer.asked_at), seconds(answer.at));
  }
  return std::nullopt;
}

std::optional<std::string> process_ended(const Record& record) { return record.thrown; }

constexpr std::array kInvariants{
    Invariant{"no_motion_in_held_aborted_stopped", moves_where_it_must_not},
    Invariant{"no_motion_without_permit", moves_unpermitted},
    Invariant{"accepted_run_is_whole", accepted_not_whole},
    Invariant{"answered_touches_are_durable", answers_lost},
    Invariant{"answered_touches_are_stored_once", answers_doubled},
    Invariant{"answered_touches_are_in_order", answers_out_of_order},
    Invariant{"result_is_that_of_its_touches", result_differs},
    Invariant{"every_state_has_a_way_out", dead_end},
    Invariant{"answers_to_a_key_are_the_same", key_answered_otherwise},
    Invariant{"requests_are_answered", request_left_alone},
    Invariant{"nothing_ends_the_process", process_ended},
};

}  // namespace

std::span<const Invariant> invariants() { return kInvariants; }

std::vector<std::string> broken_invariants(const Record& record) {
  std::vector<std::string> broken;
  for (const Invariant& invariant : kInvariants)
    if (const auto what = invariant.broken(record))
      broken.push_back(std::string(invariant.name) + ": " + *what);
  return broken;
}

}  // namespace simulation
