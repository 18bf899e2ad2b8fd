#include "service/plant/sink_thread.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "service/base/utc_time.hpp"

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
      if (!reader) reader = std::make_unique<OutboxReader>(parts_.store);
      cursor_ = std::max(cursor_, reader->cursor(parts_.name));
      serve(*reader, ending);
    } catch (const std::exception& error) {
      pause(reader.get(), error.what(), ending);
    }
  }
}

void SinkThread::serve(const OutboxReader& reader, std::stop_token ending) {
  tell(&reader, false, parts_.states->of(parts_.name)->trouble);
  const std::unique_ptr<Sink> sink = parts_.connect(ending);
  std::int64_t sent = after_what_it_has(reader, *sink, repeated_from(reader));
  while (!ending.stop_requested()) {
    const std::vector<Fact> facts = reader.next(sent, kBatch);
    if (facts.empty()) {
      sink->rest(kLook, ending);
    } else {
      tell(&reader, true, std::nullopt);  // a side that hangs keeps them waiting
      sent = std::max(sent, sink->deliver(facts, ending));
      if (sent > cursor_) {
        cursor_ = sent;
        parts_.confirmed(sent);
      }
    }
    pause_ = kPauseMin;
    tell(&reader, true, std::nullopt);
  }
}

/// The number behind which facts are sent over a new connection, those that are to come once more among them.
std::int64_t SinkThread::repeated_from(const OutboxReader& reader) const {
  if (parts_.overlap.count() == 0) return cursor_;
  return std::min(cursor_, reader.last_before(format_utc(parts_.clock() - parts_.overlap)));
}

/// What it had confirmed and has lost since comes once more, as far as it is still here.
std::int64_t SinkThread::after_what_it_has(const OutboxReader& reader, const Sink& sink, std::int64_t kept) {
  const std::int64_t has = sink.last_kept().value_or(kept);
  if (has >= kept) return kept;
  cursor_ = has;
  const std::vector<Fact> first = reader.next(has, 1);
  const std::int64_t nowhere = first.empty() ? kept : first.front().seq - 1;
  if (nowhere > has && std::exchange(told_lost_, nowhere) != nowhere)
    throw SinkTrouble(
        fmt::format("it has lost facts {} to {}, which it had confirmed, and they are deleted here; those "
                    "that are still here are sent again",
                    has + 1, nowhere));
  if (nowhere < kept)
    spdlog::warn("{}: it has lost facts {} to {}, which it had confirmed; they are sent again", parts_.name,
                 std::max(has, nowhere) + 1, kept);
  return has;
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
