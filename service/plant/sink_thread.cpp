#include "service/plant/sink_thread.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace cell {

namespace {

/// Until the time is over or it is to end.
void wait_or_end(std::stop_token ending, std::chrono::milliseconds time) {
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  ended.wait_for(lock, std::move(ending), time, [] { return false; });
}

}  // namespace

SinkThread::SinkThread(SinkParts parts) : parts_(std::move(parts)) {
  if (!parts_.wait) parts_.wait = wait_or_end;
  parts_.states->set({.sink = parts_.name});
  try {
    const OutboxReader reader(parts_.store);
    cursor_ = reader.cursor(parts_.name);
    tell(&reader, false, logged_trouble_);
  } catch (const std::exception& error) {
    tell(nullptr, false, error.what());
  }
  thread_ = std::jthread([this](std::stop_token ending) { run(std::move(ending)); });
}

void SinkThread::run(std::stop_token ending) {
  std::unique_ptr<OutboxReader> reader;
  while (!ending.stop_requested()) {
    try {
      if (!reader) {
        auto opened = std::make_unique<OutboxReader>(parts_.store);
        kept_ = cursor_ = opened->cursor(parts_.name);
        reader = std::move(opened);
      }
      serve(*reader, ending);
    } catch (const std::exception& error) {
      pause(reader.get(), error.what(), ending);
    }
  }
}

void SinkThread::serve(const OutboxReader& reader, std::stop_token ending) {
  tell(&reader, false, parts_.states->of(parts_.name)->trouble);
  const std::unique_ptr<Sink> sink = parts_.connect(ending);
  may_be_lost_.clear();  // with the connection over which it was confirmed
  if (const auto has = sink->last_kept()) go_back_to(reader, *has);
  std::int64_t sent = kept_;
  while (!ending.stop_requested()) {
    const std::vector<Fact> facts = reader.next(sent, kBatch);
    if (facts.empty()) {
      sink->rest(kLook, ending);
    } else {
      tell(&reader, true, sink->remark());  // a side that hangs keeps them waiting
      const std::int64_t before = sent;
      sent = std::max(sent, sink->deliver(facts, ending));
      cursor_ = std::max(cursor_, sent);
      if (sent > before) may_be_lost_.push_back({now(), sent});
    }
    keep_what_lasts();
    pause_ = kPauseMin;
    tell(&reader, true, sink->remark());
  }
}

std::chrono::steady_clock::time_point SinkThread::now() const {
  return parts_.may_lose.count() == 0 ? std::chrono::steady_clock::time_point{} : parts_.clock();
}

/// By no clock that somebody sets, and not by the time of a fact: what a sink gets now may be a month old.
void SinkThread::keep_what_lasts() {
  const auto by = now() - parts_.may_lose;
  const std::int64_t before = kept_;
  for (; !may_be_lost_.empty() && may_be_lost_.front().at <= by; may_be_lost_.pop_front())
    kept_ = std::max(kept_, may_be_lost_.front().seq);
  if (kept_ > before) parts_.confirmed(kept_);
}

/// What it had confirmed and has lost since comes once more, as far as it is still here. SinkTrouble, once,
/// where some of that is not.
void SinkThread::go_back_to(const OutboxReader& reader, std::int64_t has) {
  if (has >= kept_) return;
  const std::vector<Fact> first = reader.next(has, 1);
  const std::int64_t had = std::exchange(kept_, has);
  cursor_ = has;
  const std::int64_t nowhere = first.empty() ? had : first.front().seq - 1;
  if (nowhere < had)
    spdlog::warn("{}: it has lost facts {} to {}, which it had confirmed; they are sent again", parts_.name,
                 std::max(has, nowhere) + 1, had);
  if (nowhere > has)
    throw SinkTrouble(
        fmt::format("it has lost facts {} to {}, which it had confirmed, and they are deleted here; those "
                    "that are still here are sent again",
                    has + 1, nowhere));
}

void SinkThread::tell(const OutboxReader* reader, bool connected, const std::optional<std::string>& trouble) {
  SinkState state = parts_.states->of(parts_.name).value();
  state.connected = connected;
  state.trouble = trouble;
  try {
    if (reader) {
      Backlog backlog = reader->backlog(cursor_);
      state.behind = backlog.count;
      state.oldest_at = std::move(backlog.oldest_at);
    }
  } catch (const std::exception& error) {
    state.trouble = error.what();
  }
  if (trouble && trouble != logged_trouble_) spdlog::warn("{}: {}", parts_.name, *trouble);
  if (!trouble && connected && logged_trouble_) spdlog::info("{}: connected", parts_.name);
  if (trouble || connected) logged_trouble_ = trouble;
  const bool is_far_behind = state.behind >= kFarBehindFacts;
  if (is_far_behind && !is_far_behind_)
    spdlog::warn("{}: {} facts wait for it; they are kept, and the database grows", parts_.name,
                 state.behind);
  is_far_behind_ = is_far_behind;
  parts_.states->set(std::move(state));
}

void SinkThread::pause(const OutboxReader* reader, const std::string& trouble, std::stop_token ending) {
  // What comes meanwhile is counted.
  for (auto left = pause_; left.count() > 0 && !ending.stop_requested(); left -= kPauseMin) {
    tell(reader, false, trouble);
    parts_.wait(ending, std::min(left, kPauseMin));
  }
  pause_ = std::min(2 * pause_, kPauseMax);
}

}  // namespace cell
