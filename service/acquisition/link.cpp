// How an Operation meets its controller: finding it, settling what an ended run left open, learning where the
// arm stands. Each co_await stands alone in its statement, see drive.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "service/acquisition/operation.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// Pauses between attempts to connect: growing, so that a controller that is off is not hammered.
constexpr auto kFirstPause = 100ms;
constexpr auto kLongestPause = 2000ms;

/// An arm that rests says so within this time.
constexpr auto kSettleMax = 10s;

/// "touchcal 1.2.3, VAL3 s7.7.2"
std::string application_text(const cs8::Welcome& welcome) {
  const auto parts = [](std::uint32_t version) {
    return fmt::format("{}.{}.{}", version / 10'000, version / 100 % 100, version % 100);
  };
  return fmt::format("{} {}, VAL3 s{}", cs8::text_of(welcome.application), parts(welcome.application_version),
                     parts(welcome.language_version));
}

/// The addresses behind a name, or why there are none.
struct LookUp {
  explicit LookUp(const asio::any_io_executor& executor) : resolver(executor), waited(executor) {}
  asio::ip::tcp::resolver resolver;
  asio::steady_timer waited;
  boost::system::error_code failure = asio::error::timed_out;
  asio::ip::tcp::resolver::results_type found;
};

/// A look-up cannot be broken off: the answer to one that takes too long comes to nobody.
asio::awaitable<std::shared_ptr<LookUp>> look_up(asio::any_io_executor executor, Endpoint endpoint,
                                                 std::chrono::milliseconds at_most) {
  auto look = std::make_shared<LookUp>(executor);
  look->waited.expires_after(at_most);
  look->resolver.async_resolve(endpoint.host, std::to_string(endpoint.port),
                               [look](const boost::system::error_code& failure, const auto& found) {
                                 look->failure = failure;
                                 look->found = found;
                                 look->waited.cancel();
                               });
  boost::system::error_code ignored;
  co_await look->waited.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  co_return look;
}

}  // namespace

asio::awaitable<void> Operation::reset() {
  if (!client_.connected()) {
    co_await connect();
    co_return;
  }
  if (open_touch_ || unsettled_sequence_ != 0) {
    co_await settle_open_command(open_touch_ ? open_touch_->sequence : unsettled_sequence_);
  } else if (unmet_preconditions().empty()) {
    apply(Event::kDone);
  } else {
    co_await wait_for_wake(1h);  // each state of the controller wakes
  }
}

/// Tries until there is a link or the state changes. Nothing moves by it.
asio::awaitable<void> Operation::connect() {
  const State state = status_.state;
  const bool waits_for_reset = state == State::kAborted || state == State::kStopped;
  for (auto pause = std::chrono::milliseconds(kFirstPause); status_.state == state && !shutting_down_;
       pause = std::min(2 * pause, std::chrono::milliseconds(kLongestPause))) {
    const auto look = co_await look_up(executor_, endpoint_, cell_.deadlines.connect);
    const auto found = look->found;
    cs8::ConnectReply reply = cs8::LinkError{cs8::LinkErrorKind::kUnreachable,
                                             fmt::format("{}: {}", endpoint_.host, look->failure.message())};
    const cs8::ExpectedController expected{.arm = cell_.arm.name,
                                           .lower_limits = to_wire(cell_.arm.joint_ranges.lower),
                                           .upper_limits = to_wire(cell_.arm.joint_ranges.upper)};
    for (const auto& address : found) {
      reply = co_await client_.connect(address.endpoint(), expected);
      if (std::holds_alternative<cs8::Welcome>(reply)) break;
    }
    if (const auto* welcome = std::get_if<cs8::Welcome>(&reply)) {
      session_ = welcome->session;
      controller_application_ = application_text(*welcome);
      overruns_.reset();
      // A fault that ended a run stays until somebody has read it.
      if (status_.fault && is_link_fault(status_.fault->code) && state != State::kAborted)
        status_.fault.reset();
      if (state == State::kHeld && interrupted_ && !status_.fault)
        status_.fault = Fault{FaultCode::kDaemonRestarted, {}};
      publish();
      unsettled_sequence_ = welcome->open_sequence;
      if (unsettled_sequence_ != 0 && !waits_for_reset) co_await settle_open_command(unsettled_sequence_);
      co_return;
    }
    const Fault fault = link_fault(std::get<cs8::LinkError>(reply));
    const bool keeps_fault = waits_for_reset && status_.fault;
    if (!keeps_fault && (!status_.fault || status_.fault->message() != fault.message()))
      raise(fault, link_down());
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
  if (result && ours &&
      judge_touch(cell_, open_touch_->planned, *result, {}).next == TouchJudgement::Next::kKeep) {
    spdlog::info("run {}: touch {} had been made when the run ended", run_->id(), run_->touches_done() + 1);
    if (!keep_late_touch(open_touch_->planned, *result)) {
      if (!run_open_) enter(State::kStopped);  // it waits at the controller until it can be stored
      co_return;
    }
  }
  acknowledge(sequence);
}

void Operation::acknowledge(std::uint32_t sequence) {
  client_.acknowledge(sequence);
  if (unsettled_sequence_ == sequence) unsettled_sequence_ = 0;
  open_touch_.reset();
}

/// The controller's state, told after this call and at rest; nothing when the link is lost, another state was
/// entered or the arm does not come to rest.
asio::awaitable<std::optional<cs8::State>> Operation::settled_state() {
  const State state = status_.state;
  const auto asked_at = std::chrono::steady_clock::now();
  while (client_.connected() && status_.state == state) {
    const auto told = client_.latest_state();
    if (told && told_at_ > asked_at && (told->flags & cs8::kSettled) != 0) co_return told;
    if (std::chrono::steady_clock::now() > asked_at + kSettleMax) {
      raise({FaultCode::kMotionError, "the arm does not come to rest"}, Event::kAbortFault);
    }
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

/// Before the daemon ends: a stop may have left the stylus at a face, where nobody would know of it. What
/// goes wrong on this way leaves the arm where it is.
asio::awaitable<void> Operation::leave_face() {
  const auto told = co_await settled_state();
  if (!told || (told->flags & cs8::kRetractDue) == 0) co_return;
  const cs8::MoveReply reply = co_await client_.retract(retract_command(cell_));
  const auto* result = std::get_if<cs8::MoveResult>(&reply.answer);
  if (result) client_.acknowledge(reply.sequence);
  const bool arrived = result && result->outcome == cs8::Outcome::kArrived;
  spdlog::log(arrived ? spdlog::level::info : spdlog::level::warn, "the arm {} the face before the end",
              arrived ? "left" : "did not leave");
}

}  // namespace cell
