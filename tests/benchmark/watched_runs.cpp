#include "tests/benchmark/watched_runs.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "service/store/refused_result.hpp"
#include "service/store/run_store.hpp"

namespace bench {
namespace {

using nlohmann::json;

constexpr int kStartsMax = 100;                     // of a run whose cell is not ready yet
constexpr std::chrono::seconds kLeavePatience{60};  // a state that is not left by then has no way out
constexpr int kHandMs = 100;                        // a person's hand does one thing after the other
/// A run that was held looks at its reference place once more, which tells more of the noise: its result is
/// of the same touches, weighed a little differently.
constexpr double kShareOfStd = 0.1;

json short_recipe() {
  return {{"schema", "touchcal/recipe/1"},
          {"name", "short"},
          {"description", "just enough touches"},
          {"reference_every", 10},
          {"touches", {{"planes", "all"}, {"fit_per_plane", 7}, {"held_out_per_plane", 1}}},
          {"identification",
           {{"formulation", "signed_distance"}, {"tried_last", json::array()}, {"excluded", json::array()}}}};
}

/// The reference place is touched again and again; places of the plan are apart by more.
bool are_near(const cs8::JointsMicrodeg& a, const cs8::JointsMicrodeg& b) {
  constexpr std::int64_t kNearMicrodeg = 10'000;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(std::int64_t{a[i]} - b[i]) > kNearMicrodeg) return false;
  return true;
}

}  // namespace

WatchedRuns::WatchedRuns(bool calls_can_fail, std::vector<std::string> daemon_options)
    : cell_({.heartbeat_timeout_ms = 2'000,
             .noise = false,
             .calls_can_fail = calls_can_fail,
             .recipes = json::array({short_recipe()}),
             .daemon_options = std::move(daemon_options)}) {
  cell_.wire().on_frame([this](const SeenFrame& frame) { note(frame); });
  cell_.wait_until_state("IDLE");
  start();
  if (wait_for_end() != "COMPLETE") throw std::runtime_error("undisturbed: " + cell_.status().dump());
  frames_in_a_run_ = seen_frames();
  undisturbed_ = result();
  std::printf("an undisturbed run: %d frames, %zu contacts\n", frames_in_a_run_, answered_.size());
  std::fflush(stdout);
}

void WatchedRuns::note(const SeenFrame& frame) {
  const std::lock_guard lock(mutex_);
  ++frames_;
  if (const auto* welcome = std::get_if<cs8::Welcome>(&frame.message.payload)) session_ = welcome->session;
  const auto* touch = std::get_if<cs8::TouchResult>(&frame.message.payload);
  if (touch && touch->outcome == cs8::Outcome::kContact)
    answered_[{session_, frame.message.sequence}] = touch->contact;
  if (const auto* taken = std::get_if<cs8::ResultAcknowledge>(&frame.message.payload))
    acknowledged_.insert({session_, taken->command_sequence});
  if (std::holds_alternative<cs8::Touch>(frame.message.payload)) {
    ++touch_commands_;
    if (const auto act = std::exchange(at_next_touch_, nullptr)) act();
  }
  seen_.notify_all();
}

int WatchedRuns::seen_frames() {
  const std::lock_guard lock(mutex_);
  return frames_;
}

int WatchedRuns::seen_touch_commands() {
  const std::lock_guard lock(mutex_);
  return touch_commands_;
}

bool WatchedRuns::wait_for_frames(int wanted, std::chrono::microseconds patience) {
  std::unique_lock lock(mutex_);
  return seen_.wait_for(lock, patience, [&] { return frames_ >= wanted; });
}

void WatchedRuns::pass_time(std::chrono::microseconds time) {
  std::unique_lock lock(mutex_);
  seen_.wait_for(lock, time, [] { return false; });
}

void WatchedRuns::at_next_touch(std::function<void()> act) {
  const std::lock_guard lock(mutex_);
  at_next_touch_ = std::move(act);
}

void WatchedRuns::start() {
  {
    const std::lock_guard lock(mutex_);
    answered_.clear();
    acknowledged_.clear();
    frames_ = touch_commands_ = 0;
    at_next_touch_ = nullptr;
    logs_.clear();
  }
  const std::string wanted = R"({"recipe":"short"})";
  // The state of a controller that was met this moment is not known yet.
  PlainAnswer answer = cell_.post("/api/v1/runs", wanted);
  for (int asked = 0; answer.status == 409 && asked < kStartsMax; ++asked) {
    pause_ms(kHandMs);
    answer = cell_.post("/api/v1/runs", wanted);
  }
  if (answer.status != 201) throw std::runtime_error("no run is started: " + answer.body);
  run_ = json::parse(answer.body).at("id");
}

void WatchedRuns::keep_log() { logs_ += cell_.log(); }

void WatchedRuns::restart(Tally& tally) {
  keep_log();
  const auto begin = Clock::now();
  cell_.start_daemon();
  const std::string state = cell_.status().at("state");
  tally.answers_ms.push_back(milliseconds(Clock::now() - begin));
  cell_.wait_until([](const json& now) { return now.at("controller_connected") == true; });
  tally.ready_ms.push_back(milliseconds(Clock::now() - begin));
  if (tally.ready_ms.back() > kReadyMaxMs)
    std::printf("run %s: ready after %.0f ms, at first in %s:\n%s\n", run_.c_str(), tally.ready_ms.back(),
                state.c_str(), cell_.log().c_str());
}

std::string WatchedRuns::wait_for_end() {
  return cell_
      .wait_until([this](const json& now) {
        const std::string state = now.at("state");
        if (state == "IDLE") return true;  // of a daemon that found the run ended
        const bool is_over = state == "COMPLETE" || state == "ABORTED" || state == "STOPPED";
        return (is_over || state == "HELD") && now.at("run_id") == run_;
      })
      .at("state");
}

void WatchedRuns::settle(Tally& tally, const std::vector<std::string>& remedies) {
  constexpr int kWordsMax = 100;
  std::string state = wait_for_end();
  for (int words = 0; state == "HELD" && words < kWordsMax; ++words, state = wait_for_end()) {
    remove(remedies);
    if (cell_.post("/api/v1/runs/" + run_ + "/resume").status != 202) pause_ms(100);
  }
  ++tally.runs;
  judge(tally);
  if (state == "COMPLETE" || state == "IDLE") return;
  const json now = cell_.status();
  std::printf("run %s is given up: %s, %s\n", run_.c_str(), now.at("fault_code").dump().c_str(),
              now.at("fault_message").dump().c_str());
  leave(state, remedies);
}

/// From a run that did not end by itself to the next start.
void WatchedRuns::leave(const std::string& state, const std::vector<std::string>& remedies) {
  remove(remedies);
  if (state == "HELD") (void)cell_.post("/api/v1/runs/" + run_ + "/abort");
  cell_.wait_until([](const json& now) { return now.at("controller_connected") == true; });
  const auto is_left = [this](const json& now) {
    const std::string at = now.at("state");
    if (at == "ABORTED") (void)cell_.post("/api/v1/cell/clear");
    if (at == "STOPPED") (void)cell_.post("/api/v1/cell/reset");
    return at == "IDLE";
  };
  cell_.wait_until(is_left, kLeavePatience);
}

/// What a person does at the cell, each some simulated time after the other.
void WatchedRuns::remove(const std::vector<std::string>& remedies) {
  for (const std::string& remedy : remedies) {
    cell_.inject("{\"fault\":\"" + remedy + "\"}");
    pause_ms(kHandMs);
  }
}

json WatchedRuns::result() const { return json::parse(cell_.get("/api/v1/runs/" + run_ + "/result").body); }

/// Holds the store against the wire, and the result against the undisturbed one.
void WatchedRuns::judge(Tally& tally) {
  Answered answered;
  decltype(acknowledged_) acknowledged;
  {
    const std::lock_guard lock(mutex_);
    answered = answered_;
    acknowledged = acknowledged_;
  }
  const cell::RunStore store(cell_.state() / "touchcal.sqlite");
  const std::int64_t id = std::stoll(run_);
  const bool is_complete = store.run(id)->outcome == cell::RunOutcome::kComplete;
  std::set<std::pair<std::uint32_t, std::uint32_t>> stored;
  std::set<int> numbers;
  // Reference touches and repetitions are stored without the command that they answer.
  std::vector<cs8::JointsMicrodeg> without_command;
  const auto note_stored = [&](const cell::StoredTouch& touch) {
    if (touch.sequence == 0) return without_command.push_back(touch.joints);
    if (!stored.insert({touch.session, touch.sequence}).second) ++tally.doubled;
  };
  for (const cell::StoredTouch& touch : store.touches(id)) {
    note_stored(touch);
    if (!numbers.insert(touch.number).second) ++tally.doubled;
  }
  for (const cell::SupersededTouch& old : store.superseded_touches(id)) note_stored(old.touch);
  // What was refused is kept apart with its reason: no measurement, and not lost.
  std::set<std::pair<std::uint32_t, std::uint32_t>> refused;
  for (const cell::RefusedResult& one : cell::refused_results(store, id)) {
    if (stored.contains({one.session, one.sequence}) || !refused.insert({one.session, one.sequence}).second)
      ++tally.doubled;
  }
  for (const cell::ReferenceTouch& touch : store.references(id)) without_command.push_back(touch.joints);
  for (const cell::StoredTouch& touch : store.touches(id))
    if (touch.again) without_command.push_back(*touch.again);
  for (const auto& [command, joints] : answered) {
    if (stored.contains(command)) continue;
    const auto same = std::ranges::find(without_command, joints);
    if (refused.contains(command)) {
      // A reference touch is, too, where the daemon ended between the disk and the acknowledgement.
      if (same != without_command.end()) without_command.erase(same);
      ++tally.discarded;
      continue;
    }
    if (same != without_command.end()) {
      without_command.erase(same);
    } else if (const auto references = store.references(id); std::ranges::any_of(
                   references, [&](const auto& one) { return are_near(one.joints, joints); })) {
      ++tally.references_again;
    } else if (!is_complete && !acknowledged.contains(command)) {
      ++tally.unacknowledged;  // it stays at the controller, and no one was told that it is there
    } else {
      ++tally.lost;
      std::printf("run %s%s: the answer to command %u of session %u%s is not in the store\n", run_.c_str(),
                  is_complete ? ", complete" : "", command.second, command.first,
                  acknowledged.contains(command) ? ", acknowledged," : "");
    }
  }
  tally.doubled += static_cast<int>(without_command.size());
  if (!is_complete) {
    ++tally.given_up;
  } else if (is_like_undisturbed(result())) {
    ++tally.ended_alike;
  }
}

bool WatchedRuns::is_like_undisturbed(const json& result) const {
  for (const char* key : {"touch_count", "complete", "converged", "identifiable_count", "rejected_touches"})
    if (result.at(key) != undisturbed_.at(key)) return false;
  if (result.at("verdict").at("accepted") != undisturbed_.at("verdict").at("accepted")) return false;
  for (std::size_t i = 0; i < undisturbed_.at("parameters").size(); ++i) {
    const json& ours = result.at("parameters")[i];
    const json& theirs = undisturbed_.at("parameters")[i];
    if (ours.at("status") != theirs.at("status")) return false;
    if (theirs.at("status") != "identified") continue;
    const double apart = ours.at("error").get<double>() - theirs.at("error").get<double>();
    if (std::abs(apart) > kShareOfStd * theirs.at("std_uncertainty").get<double>()) return false;
  }
  return true;
}

}  // namespace bench
