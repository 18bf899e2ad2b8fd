// What the states of an Operation do: one coroutine, one step at a time.
// Each co_await stands alone in its statement and takes named values: GCC 12 miscompiles it inside conditions
// and destroys braced temporaries twice.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "cs8_protocol/names.hpp"
#include "service/acquisition/operation.hpp"
#include "service/acquisition/planning.hpp"
#include "service/acquisition/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// Pauses between attempts to connect: growing, so that a controller that is off is not hammered.
constexpr auto kFirstPause = 100ms;
constexpr auto kLongestPause = 2000ms;

}  // namespace

asio::awaitable<void> Operation::wait_for_wake(std::chrono::milliseconds at_most) {
  wake_.expires_after(at_most);
  boost::system::error_code ignored;
  co_await wake_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
}

asio::awaitable<void> Operation::drive() {
  while (!shutting_down_ || is_active(status_.state)) {
    switch (status_.state) {
      case State::kResetting:
        co_await reset();
        break;
      case State::kStarting:
        co_await start_run();
        break;
      case State::kExecute:
        co_await make_next_touch();
        break;
      case State::kCompleting:
        co_await complete_run();
        break;
      case State::kStopping:
        close_run("stopped");
        apply(Event::kDone);
        break;
      case State::kAborting:
        close_run("aborted");
        apply(Event::kDone);
        break;
      case State::kHolding:
      case State::kUnholding:
        apply(Event::kDone);
        break;
      case State::kClearing:
        // Whatever stopped the arm, the controller is met anew before the next run.
        client_.close();
        apply(Event::kDone);
        break;
      case State::kComplete:
        // A finished run stays to be read while the link comes and goes.
        if (client_.connected()) {
          co_await wait_for_wake(1h);
        } else {
          co_await connect();
        }
        break;
      default:
        co_await wait_for_wake(1h);
    }
  }
}

asio::awaitable<void> Operation::reset() {
  if (!client_.connected()) {
    co_await connect();
    co_return;
  }
  if (open_touch_) {
    co_await settle_open_command(open_touch_->sequence);
  } else if (unmet_preconditions().empty()) {
    apply(Event::kDone);
  } else {
    co_await wait_for_wake(1h);  // each state of the controller wakes
  }
}

/// Tries until there is a link or the state changes. Nothing moves by it.
asio::awaitable<void> Operation::connect() {
  asio::ip::tcp::resolver resolver(executor_);
  const State state = status_.state;
  for (auto pause = std::chrono::milliseconds(kFirstPause); status_.state == state && !shutting_down_;
       pause = std::min(2 * pause, std::chrono::milliseconds(kLongestPause))) {
    boost::system::error_code failure;
    const auto found = co_await resolver.async_resolve(endpoint_.host, std::to_string(endpoint_.port),
                                                       asio::redirect_error(asio::use_awaitable, failure));
    cs8::ConnectReply reply = cs8::LinkError{cs8::LinkErrorKind::kUnreachable,
                                             fmt::format("{}: {}", endpoint_.host, failure.message())};
    if (!failure) {
      const cs8::ExpectedController expected{.arm = cell_.arm.name,
                                             .lower_limits = to_wire(cell_.arm.joint_ranges.lower),
                                             .upper_limits = to_wire(cell_.arm.joint_ranges.upper)};
      reply = co_await client_.connect(found.begin()->endpoint(), expected);
    }
    if (const auto* welcome = std::get_if<cs8::Welcome>(&reply)) {
      session_ = welcome->session;
      status_.fault.reset();  // it was the link's
      publish();
      if (welcome->open_sequence != 0) co_await settle_open_command(welcome->open_sequence);
      co_return;
    }
    const Fault fault = link_fault(std::get<cs8::LinkError>(reply));
    if (!status_.fault || status_.fault->message() != fault.message()) raise(fault, Event::kLinkDown);
    if (status_.state == state && !shutting_down_) co_await wait_for_wake(pause);
  }
}

/// A result that still waits at the controller belongs to a run that is over. A contact in it was captured
/// all the same: it is kept with that run. Then the controller may forget it, and the next run can start.
asio::awaitable<void> Operation::settle_open_command(std::uint32_t sequence) {
  const cs8::QueryReply reply = co_await client_.query(sequence, cell_.deadlines.command);
  if (std::holds_alternative<cs8::LinkError>(reply)) co_return;
  const auto* result = std::get_if<cs8::TouchResult>(&reply);
  const bool ours = open_touch_ && open_touch_->session == session_ && open_touch_->sequence == sequence;
  if (result && ours && result->outcome == cs8::Outcome::kContact &&
      !implausible(cell_, open_touch_->planned, *result)) {
    spdlog::info("run {}: touch {} had been made when the run ended", run_->id(), run_->touches_done() + 1);
    if (!keep_touch(open_touch_->planned, *result)) {
      enter(State::kStopped);  // it waits at the controller until it can be stored
      co_return;
    }
  }
  acknowledge(sequence);
}

void Operation::acknowledge(std::uint32_t sequence) {
  client_.acknowledge(sequence);
  open_touch_.reset();
}

asio::awaitable<bool> Operation::plan() {
  const Recipe& recipe = run_->recipe();
  if (!plans_.contains(recipe.name)) {
    const calib::PlanningProblem problem = planning_problem(cell_, recipe);
    co_await asio::post(asio::bind_executor(planner_.get_executor(), asio::use_awaitable));
    const auto outcome = calib::plan_touches(problem);
    co_await asio::post(asio::bind_executor(executor_, asio::use_awaitable));
    if (const auto* failure = std::get_if<calib::PlanningFailure>(&outcome)) {
      raise({FaultCode::kRecipeUnreachable,
             fmt::format("plane {}: {} of {} touches found; {}", failure->face + 1, failure->found,
                         failure->wanted, failure->reason)},
            Event::kAbortFault);
      co_return false;
    }
    plans_.emplace(recipe.name, std::get<calib::TouchPlan>(outcome));
  }
  run_->set_plan(plans_.at(recipe.name));
  try {
    store_.set_touches_total(run_->id(), run_->touches_total());
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    co_return false;
  }
  publish();
  co_return true;
}

/// The controller's state, told after this call and at rest; nothing when the link or the state of the run is
/// lost.
asio::awaitable<std::optional<cs8::State>> Operation::settled_state() {
  const State state = status_.state;
  const auto asked_at = std::chrono::steady_clock::now();
  while (client_.connected() && status_.state == state) {
    const auto told = client_.latest_state();
    if (told && client_.heard_at() > asked_at && (told->flags & cs8::kSettled) != 0) co_return told;
    co_await wait_for_wake(20ms);
  }
  co_return std::nullopt;
}

/// Where the arm stands, clear of the faces: a search that was broken off left the stylus near one, and the
/// arm goes back along its line first. Nothing when that failed or another state was entered meanwhile.
asio::awaitable<std::optional<calib::JointVector>> Operation::standing_joints() {
  if (standing_) co_return standing_;
  auto told = co_await settled_state();
  if (told && (told->flags & cs8::kRetractDue) != 0) {
    const State state = status_.state;
    const cs8::MoveReply reply = co_await client_.retract(retract_command(cell_));
    take_move(reply);
    if (status_.state != state) co_return std::nullopt;
    told = co_await settled_state();
  }
  if (!told) co_return std::nullopt;
  co_return from_wire(told->joints);
}

asio::awaitable<void> Operation::start_run() {
  standing_.reset();
  const bool planned = co_await plan();
  if (planned && status_.state == State::kStarting) apply(Event::kDone);
}

asio::awaitable<void> Operation::make_next_touch() {
  const calib::PlannedTouch* planned = run_->next();
  if (!planned) {
    apply(Event::kDone);
    co_return;
  }
  const auto from = co_await standing_joints();
  if (!from || status_.state != State::kExecute) co_return;
  const auto via =
      calib::find_transfer(planning_problem(cell_, run_->recipe()), *from, planned->clear_joints);
  if (!via) {
    raise({FaultCode::kNoSafeWay,
           fmt::format("to touch {} on plane {}", run_->touches_done() + 1, planned->face + 1)},
          Event::kAbortFault);
    co_return;
  }
  standing_.reset();
  open_touch_ = OpenTouch{session_, client_.next_sequence(), *planned};
  const cs8::TouchReply reply = co_await client_.touch(touch_command(cell_, *planned, *via));
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    open_touch_.reset();
    const OutcomeFault refused = fault_of(*rejected);
    raise(refused.fault, refused.holds ? Event::kHoldFault : Event::kAbortFault);
  } else if (const auto* result = std::get_if<cs8::TouchResult>(&reply.answer)) {
    take_contact(*planned, reply, *result);
  }  // a lost link has been told by lose()
}

/// A contact counts once it is stored; only then may the controller forget it.
void Operation::take_contact(const calib::PlannedTouch& planned, const cs8::TouchReply& reply,
                             const cs8::TouchResult& result) {
  if (const auto fault = fault_of(result.outcome, result.phase, result.error_number)) {
    acknowledge(reply.sequence);
    raise(fault->fault, fault->holds ? Event::kHoldFault : Event::kAbortFault);
    return;
  }
  if (result.outcome != cs8::Outcome::kContact) {  // stopped, as was asked
    acknowledge(reply.sequence);
    return;
  }
  if (const auto why = implausible(cell_, planned, result)) {
    acknowledge(reply.sequence);
    raise({FaultCode::kImplausibleTouch, *why}, Event::kAbortFault);
    return;
  }
  if (!keep_touch(planned, result)) return;
  acknowledge(reply.sequence);
  standing_ = planned.clear_joints;
  publish();
}

/// Stores and counts a contact; false when it could not be stored, which ends the run.
bool Operation::keep_touch(const calib::PlannedTouch& planned, const cs8::TouchResult& result) {
  try {
    run_->add(store_, {.number = run_->touches_done() + 1,
                       .plane = planned.face + 1,
                       .role = planned.role,
                       .joints = result.contact,
                       .source = result.source,
                       .overtravel_dmm = result.overtravel_dmm,
                       .captured_at = now_text()});
    return true;
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
    return false;
  }
}

void Operation::take_move(const cs8::MoveReply& reply) {
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    raise(fault_of(*rejected).fault, Event::kAbortFault);
  } else if (const auto* result = std::get_if<cs8::MoveResult>(&reply.answer)) {
    client_.acknowledge(reply.sequence);
    if (const auto fault = fault_of(result->outcome, result->phase, result->error_number)) {
      raise(fault->fault, Event::kAbortFault);
    }
  }  // a lost link has been told by lose()
}

asio::awaitable<void> Operation::complete_run() {
  co_await park();
  if (status_.state != State::kCompleting) co_return;
  const calib::IdentificationResult& result = run_->latest();
  if (result.status != calib::IdentificationStatus::kConverged) {
    status_.fault = Fault{FaultCode::kNotIdentifiable, result.message};
  }
  close_run("complete");
  apply(Event::kDone);
}

asio::awaitable<void> Operation::park() {
  const auto from = co_await standing_joints();
  if (!from || status_.state != State::kCompleting) co_return;
  const auto via = calib::find_transfer(planning_problem(cell_, run_->recipe()), *from, cell_.park_joints);
  if (!via) {
    raise({FaultCode::kNoSafeWay, "to the park posture"}, Event::kAbortFault);
    co_return;
  }
  standing_.reset();
  const cs8::MoveReply reply = co_await client_.travel(travel_command(cell_, cell_.park_joints, *via));
  take_move(reply);
}

/// The run is over: its verdict and its latest result are stored with it.
void Operation::close_run(const std::string& outcome) {
  standing_.reset();
  if (!run_open_) return;
  run_open_ = false;
  const Judgement judgement = judge(run_->latest(), cell_.acceptance, run_->complete());
  const bool finished =
      outcome == "complete" && run_->latest().status == calib::IdentificationStatus::kConverged;
  status_.verdict = !finished            ? Verdict::kIncomplete
                    : judgement.accepted ? Verdict::kAccepted
                                         : Verdict::kRejected;
  RunEnd end{.outcome = outcome,
             .verdict = std::string(verdict_name(status_.verdict)),
             .ended_at = now_text(),
             .result_json = result_json()};
  if (status_.fault) {
    end.fault_code = std::string(describe(status_.fault->code).name);
    end.fault_message = status_.fault->message();
  }
  try {
    store_.finish_run(run_->id(), end);
    if (status_.verdict == Verdict::kAccepted) {
      status_.last_accepted_run_id = run_->id();
      status_.last_accepted_at = end.ended_at;
    }
  } catch (const std::exception& error) {
    status_.verdict = Verdict::kIncomplete;  // what is not on the disk is not accepted
    status_.fault = Fault{FaultCode::kStoreFailed, error.what()};
    spdlog::error("run {}: its end could not be stored: {}", run_->id(), error.what());
  }
  spdlog::info("run {} {}: {}, {} of {} touches", run_->id(), outcome, end.verdict, run_->touches_done(),
               run_->touches_total());
}

}  // namespace cell
