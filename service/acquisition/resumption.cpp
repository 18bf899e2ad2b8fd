// How an Operation goes on with a run that an earlier daemon left open: on hold until a person asks for it,
// then with the same plan, the same touches and an aim that knows what it knew. Each co_await stands alone in
// its statement, see drive.cpp.
#include "service/acquisition/resumption.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "service/acquisition/operation.hpp"
#include "service/base/log_format.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/run/planning_problem.hpp"
#include "service/run/run_conditions.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

using Json = nlohmann::json;

template <class Vector>
Json array_of(const Vector& vector) {
  return Json(std::vector<double>(vector.begin(), vector.end()));
}

template <class Vector>
void read_array(const Json& json, Vector& vector) {
  const auto values = json.get<std::vector<double>>();
  if (static_cast<Eigen::Index>(values.size()) != vector.size())
    throw std::invalid_argument("another length");
  std::copy(values.begin(), values.end(), vector.begin());
}

}  // namespace

std::string command_text(const calib::PlannedTouch& touch, const std::vector<calib::JointVector>& way) {
  Json way_rad = Json::array();
  for (const calib::JointVector& joints : way) way_rad.push_back(array_of(joints));
  return Json{{"face", touch.face},
              {"role", static_cast<int>(touch.role)},
              {"joints_rad", array_of(touch.joints)},
              {"clear_joints_rad", array_of(touch.clear_joints)},
              {"approach_joints_rad", array_of(touch.approach_joints)},
              {"search_end_joints_rad", array_of(touch.search_end_joints)},
              {"predicted_miss_m", touch.predicted_position_error_m},
              {"way_rad", way_rad}}
      .dump();
}

std::optional<CommandedTouch> command_from_text(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    calib::PlannedTouch touch{.face = json.at("face"),
                              .role = static_cast<calib::TouchRole>(json.at("role").get<int>()),
                              .predicted_position_error_m = json.at("predicted_miss_m")};
    read_array(json.at("joints_rad"), touch.joints);
    read_array(json.at("clear_joints_rad"), touch.clear_joints);
    read_array(json.at("approach_joints_rad"), touch.approach_joints);
    read_array(json.at("search_end_joints_rad"), touch.search_end_joints);
    CommandedTouch command{std::move(touch), {}};
    for (const Json& joints : json.at("way_rad")) read_array(joints, command.way.emplace_back());
    return command;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::optional<std::string> why_not_resumable(const Cell& cell, const StoredRun& run,
                                             const std::optional<std::string>& config_digest) {
  if (!cell.recipes.contains(run.recipe)) return fmt::format("the cell has no recipe '{}' now", run.recipe);
  if (run.config_digest != config_digest) return "the cell's files are not those of the run";
  return std::nullopt;
}

/// Takes up the run that the daemon before this one left open. Nothing moves by it.
void Operation::restore_run() {
  auto stored = store_.running();
  // An older one was over for everybody; only its end could not be written then.
  if (stored && stored->id != store_.runs(1).front().id) stored.reset();
  store_.finish_interrupted(now_text(), stored ? std::optional(stored->id) : std::nullopt);
  if (!stored) return;
  if (const auto why = why_not_resumable(cell_, *stored, config_digest_)) {
    spdlog::warn("run {} was interrupted and cannot be resumed: {}", stored->id, *why);
    RunEnd end{.outcome = RunOutcome::kInterrupted, .verdict = Verdict::kIncomplete, .ended_at = now_text()};
    end.fault_code = std::string(describe(FaultCode::kDaemonRestarted).name);
    end.fault_message = Fault{FaultCode::kDaemonRestarted, "it cannot be resumed: " + *why}.message();
    store_.finish_run(stored->id, end);
    return;
  }
  run_.emplace(stored->id, *tip_regions_, cell_.recipes.at(stored->recipe), stored->started_at);
  run_->restore(store_.touches(stored->id), stored->touches_total);
  conditions_ = stored->conditions_json.value_or("");
  run_open_ = true;
  set_logged_run(stored->id);
  guided_ = is_guided(stored->conditions_json);
  interrupted_ = Interrupted{stored->plan_id, store_.plan_changes(stored->id)};
  if (const auto open = store_.open_command(stored->id)) {
    if (auto command = command_from_text(open->touch_json)) {
      open_touch_ = OpenTouch{open->session, open->sequence, std::move(command->touch), open->aimed_with};
      made_way_ = std::move(command->way);
    }
  }
  status_.fault = Fault{FaultCode::kDaemonRestarted, {}};
  spdlog::warn("run {} was interrupted after {} of {} touches; it waits to be resumed", stored->id,
               stored->touches_done, stored->touches_total);
}

/// With a run on hold that nobody resumed yet, a missing link changes nothing.
Event Operation::link_down() const { return interrupted_ ? Event::kNotReadyFault : Event::kLinkDown; }

/// All that a run on hold needs before a person confirms that it goes on: a link, what became of its last
/// command, its plan. False when another state was entered.
asio::awaitable<bool> Operation::make_resumable() {
  const State state = status_.state;
  if (!client_.connected()) co_await connect();
  if (status_.state != state || !client_.connected()) co_return false;
  if (open_touch_ && open_touch_->session != session_) open_touch_.reset();  // lost with its session
  if (open_touch_) co_await settle_open_command(open_touch_->sequence);
  if (status_.state != state || !client_.connected()) co_return false;
  if (!interrupted_) co_return true;
  const bool planned = co_await plan_again();
  if (!planned || status_.state != state) co_return false;
  try {
    store_.append_resumption(run_->id(), now_text(), run_->touches_done());
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kNotReadyFault);
    co_return false;
  }
  interrupted_.reset();
  double made_s = 0.0;
  for (std::size_t i = 0; i < run_->touches_made() && run_->planned(i); ++i)
    made_s += run_->planned(i)->travel_s + run_->planned(i)->touch_s;
  run_began_ =
      clock_() - std::chrono::duration_cast<std::chrono::seconds>(std::chrono::duration<double>(made_s));
  publish();
  co_return true;
}

/// The run's plan once more: planning is deterministic, and a plan's id is the digest of its document.
asio::awaitable<bool> Operation::plan_again() {
  if (!interrupted_->plan_id) {
    const bool planned = co_await plan();  // it was interrupted before it had one
    co_return planned;
  }
  planning_ = planning_problem(cell_, run_->recipe());
  const PlanOutcome outcome = co_await plan_recipe(run_->recipe().name);
  const auto* plan = std::get_if<std::shared_ptr<const Plan>>(&outcome);
  if (!plan || (*plan)->id != *interrupted_->plan_id) {
    raise({FaultCode::kDaemonRestarted, "it cannot be resumed: it would be planned in another way now"},
          Event::kAbortFault);
    co_return false;
  }
  run_->set_plan((*plan)->touches);
  for (const PlanChange& change : interrupted_->plan_changes) run_->change_plan(change);
  stored_changes_ = run_->plan_changes().size();
  begin_aim();
  if (!guided_) {
    recall_aim();
    restore_reference();
  }
  co_return true;
}

/// The aim and the touch ahead as they were when the last touch was made: the next one was aimed before its
/// contact was known.
void Operation::recall_aim() {
  const std::vector<StoredTouch>& stored = run_->touches();
  const std::vector<calib::Touch>& touches = run_->problem().touches;
  if (stored.empty() || !run_->planned(stored.size() - 1)) return;
  const calib::PlannedTouch& last = *run_->planned(stored.size() - 1);
  const int aimed_with = stored.back().aimed_with;
  const auto learn_up_to = [&](std::size_t count) {
    while (aim_->touch_count() < std::min(count, touches.size())) aim_->add(touches[aim_->touch_count()]);
  };
  learn_up_to(static_cast<std::size_t>(std::max(aimed_with, 0)));
  auto made = aimed_with == kNominalMiss ? calib::nominal_touch(planning_, last)
                                         : calib::aim_touch(planning_, *aim_, last);
  learn_up_to(touches.size() - 1);
  auto* aimed = std::get_if<calib::AimedTouch>(&made);
  if (!aimed) return;
  made_ = std::move(*aimed);
  if (is_surprise(touches.back().joints)) return;
  ahead_ = prepared(stored.size(), calib::transfer_end_of(*made_));
  if (!ahead_) return;
  before_ = std::move(made_);  // the arm may stand on the way between both
  made_ = ahead_->aimed;
}

/// What is needed to know the answer again after a restart, kept before the command leaves. False when it
/// cannot be kept: then the command must not leave.
bool Operation::keep_open_command() {
  try {
    const std::vector<PlanChange>& changes = run_->plan_changes();
    for (; stored_changes_ < changes.size(); ++stored_changes_)
      store_.append_plan_change(run_->id(), changes[stored_changes_]);
    store_.set_open_command(run_->id(), {.session = open_touch_->session,
                                         .sequence = open_touch_->sequence,
                                         .aimed_with = open_touch_->aimed_with,
                                         .touch_json = command_text(open_touch_->planned, made_way_)});
    return true;
  } catch (const std::exception& error) {
    open_touch_.reset();
    raise({FaultCode::kStoreFailed, error.what()}, Event::kHoldFault);
    return false;
  }
}

}  // namespace cell
