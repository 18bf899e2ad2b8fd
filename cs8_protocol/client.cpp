#include "cs8_protocol/client.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <limits>
#include <stdexcept>
#include <utility>

#include "cs8_protocol/link.hpp"

namespace cs8 {

// ---- calls that wait ----

Link::Waiting::Waiting(Link& on_link, std::uint32_t of_sequence, MessageType wants)
    : Pending{asio::steady_timer(on_link.executor_), "command " + std::to_string(of_sequence)},
      link(on_link),
      sequence(of_sequence),
      wanted(wants) {
  if (link.waiting_ != nullptr)
    throw std::logic_error("cs8::Client: a second call while one waits for its answer");
  link.waiting_ = this;
}

Link::Waiting::~Waiting() {
  link.waiting_ = nullptr;
  if (!done) link.fail(LinkErrorKind::kClosed, "a call that waited for the controller's answer was given up");
}

bool Link::Waiting::takes(const Answer& offered) const {
  const MessageType type = std::visit([](const auto& body) { return body.kType; }, offered);
  if (type == wanted) return true;
  const bool is_query = wanted == MessageType::kResultUnknown;
  return is_query ? type != MessageType::kRejected : type == MessageType::kRejected;
}

Link::Asking::Asking(Link& on_link, std::uint32_t for_run)
    : Pending{asio::steady_timer(on_link.executor_), "begin of run " + std::to_string(for_run)},
      link(on_link),
      run(for_run) {
  if (link.asking_ != nullptr) throw std::logic_error("cs8::Client: a second begin() while one waits");
  link.asking_ = this;
}

Link::Asking::~Asking() {
  link.asking_ = nullptr;
  if (!done) link.fail(LinkErrorKind::kClosed, "a call that waited for the confirmation was given up");
}

asio::awaitable<void> Link::wait(Pending& pending, Clock::time_point accept_by, Clock::time_point answer_by) {
  while (!pending.done && !error_) {
    auto deadline = pending.accepted ? answer_by : std::min(accept_by, answer_by);
    if (pending.settle_by) deadline = std::min(deadline, *pending.settle_by);
    if (Clock::now() >= deadline) {
      fail(LinkErrorKind::kUnanswered,
           pending.what + (pending.accepted ? " was accepted, but no result came within its deadline"
                                            : " was not answered within its deadline"));
      co_await asio::post(executor_, asio::use_awaitable);  // the loss is told before the call ends
      co_return;
    }
    pending.alarm.expires_at(deadline);
    boost::system::error_code woken;
    co_await pending.alarm.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
}

template <class Result, class Command>
asio::awaitable<Reply<Result>> Link::command(std::shared_ptr<Link> link, const Command& body) {
  std::uint32_t sequence = 0;
  if (link && link->is_up() && link->waiting_ == nullptr) {
    if (link->last_sequence_ == std::numeric_limits<std::uint32_t>::max()) {
      link->fail(LinkErrorKind::kProtocol,
                 "the controller's session has no number left for a command: start its application again");
    } else {
      sequence = ++link->last_sequence_;
      link->send(Message{sequence, body});
    }
  }
  return answer_to<Result>(std::move(link), sequence, std::chrono::milliseconds(body.deadline_ms));
}

template <class Result>
asio::awaitable<Reply<Result>> Link::answer_to(std::shared_ptr<Link> link, std::uint32_t sequence,
                                               std::chrono::milliseconds deadline) {
  Reply<Result> reply;
  if (sequence == 0 && (!link || !link->is_up())) {
    reply.answer = not_connected(link.get());
    co_return reply;
  }
  Waiting waiting(*link, sequence, Result::kType);  // throws when a call waits already
  reply.sequence = sequence;
  const auto now = Clock::now();
  co_await link->wait(waiting, now + link->options_.answer_deadline,
                      now + deadline + link->options_.result_margin);
  if (!waiting.answer) {
    reply.answer = *link->error_;
  } else if (const auto* rejected = std::get_if<Rejected>(&*waiting.answer)) {
    reply.answer = *rejected;
  } else {
    reply.answer = std::get<Result>(*waiting.answer);
  }
  co_return reply;
}

asio::awaitable<QueryReply> Link::query(std::shared_ptr<Link> link, std::uint32_t sequence,
                                        std::chrono::milliseconds deadline) {
  if (!link || !link->is_up()) co_return not_connected(link.get());
  Waiting waiting(*link, sequence, MessageType::kResultUnknown);
  const ResultQuery question{sequence};
  link->send(Message{0, question});
  const auto now = Clock::now();
  co_await link->wait(waiting, now + link->options_.answer_deadline, now + deadline);
  if (!waiting.answer) co_return *link->error_;
  if (const auto* touch = std::get_if<TouchResult>(&*waiting.answer)) co_return *touch;
  if (const auto* move = std::get_if<MoveResult>(&*waiting.answer)) co_return *move;
  co_return std::get<ResultUnknown>(*waiting.answer);
}

asio::awaitable<PermitReply> Link::begin(std::shared_ptr<Link> link, std::uint32_t run,
                                         std::chrono::milliseconds confirm_within) {
  if (!link || !link->is_up()) co_return not_connected(link.get());
  Asking asking(*link, run);
  link->runs_begun_.insert(run);
  const Begin question{run, static_cast<std::uint32_t>(confirm_within.count())};
  link->send(Message{0, question});
  const auto now = Clock::now();
  co_await link->wait(asking, now + link->options_.answer_deadline,
                      now + confirm_within + link->options_.result_margin);
  if (!asking.done) co_return *link->error_;
  co_return asking.decision;
}

LinkError Link::not_connected(const Link* link) {
  const std::string why = link != nullptr && link->error_ ? ": " + link->error_->text : std::string();
  return {LinkErrorKind::kNotConnected, "not connected to the controller" + why};
}

// ---- the client ----

Client::Client(asio::any_io_executor executor, ClientOptions options, ClientHooks hooks)
    : executor_(std::move(executor)), options_(options), hooks_(std::move(hooks)) {}

Client::~Client() { close(); }

asio::awaitable<ConnectReply> Client::connect(tcp::endpoint endpoint, ExpectedController expected) {
  close();
  link_ = std::make_shared<Link>(executor_, options_, hooks_);
  return Link::open(link_, std::move(endpoint), std::move(expected));
}

void Client::close() {
  if (link_) link_->close();
}

bool Client::connected() const { return link_ && link_->is_held_up(); }

std::optional<State> Client::latest_state() const { return link_ ? link_->latest_state() : std::nullopt; }

std::optional<Clock::time_point> Client::heard_at() const { return link_ ? link_->heard_at() : std::nullopt; }

std::uint32_t Client::next_sequence() const { return connected() ? link_->last_sequence() + 1 : 0; }

asio::awaitable<TouchReply> Client::touch(Touch command) {
  return Link::command<TouchResult>(link_, command);
}

asio::awaitable<MoveReply> Client::travel(Travel command) {
  return Link::command<MoveResult>(link_, command);
}

asio::awaitable<MoveReply> Client::retract(Retract command) {
  return Link::command<MoveResult>(link_, command);
}

asio::awaitable<QueryReply> Client::query(std::uint32_t sequence, std::chrono::milliseconds deadline) {
  return Link::query(link_, sequence, deadline);
}

asio::awaitable<PermitReply> Client::begin(std::uint32_t run, std::chrono::milliseconds confirm_within) {
  return Link::begin(link_, run, confirm_within);
}

void Client::finish() {
  if (connected()) link_->send(Message{0, Finish{}});
}

std::optional<Permit> Client::latest_permit() const { return link_ ? link_->latest_permit() : std::nullopt; }

void Client::stop() {
  if (connected()) link_->stop();
}

void Client::acknowledge(std::uint32_t sequence) {
  if (connected()) link_->send(Message{0, ResultAcknowledge{sequence}});
}

}  // namespace cs8
