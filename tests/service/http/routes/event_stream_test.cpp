#include "service/http/routes/internal/event_stream.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <nlohmann/json.hpp>

#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

struct SentEvent {
  std::string name, id;
  json data;
};

std::vector<SentEvent> parsed(const std::string& text) {
  std::vector<SentEvent> events;
  std::size_t at = 0;
  for (std::size_t end; (end = text.find("\n\n", at)) != text.npos; at = end + 2) {
    const std::string block = "\n" + text.substr(at, end - at) + "\n";
    const auto field = [&](const std::string& name) {
      const std::size_t begin = block.find("\n" + name + ": ");
      if (begin == block.npos) return std::string();
      const std::size_t from = begin + name.size() + 3;
      return block.substr(from, block.find('\n', from) - from);
    };
    if (!field("event").empty()) events.push_back({field("event"), field("id"), json::parse(field("data"))});
  }
  EXPECT_EQ(at, text.size()) << "half an event";
  return events;
}

class EventStreams : public ::testing::Test {
 protected:
  EventStreams() {
    services_.feed.follow([](const Status&) {});
  }
  /// A change of the status.
  void change() {
    ASSERT_FALSE(quiet_.operation().command(resetting_ ? Command::kStop : Command::kReset));
    resetting_ = !resetting_;
  }
  std::uint64_t sequence() { return quiet_.operation().sequence(); }
  std::string id_of(std::uint64_t sequence) { return "instance-" + std::to_string(sequence); }

  RunLookUp look_up() {
    return [this](std::int64_t run) -> boost::asio::awaitable<std::optional<StoredRun>> {
      co_return quiet_.store().run(run);
    };
  }
  /// A disk that answers when the timer is cancelled.
  static boost::asio::awaitable<std::optional<StoredRun>> read_late(RunStore& store, std::int64_t run,
                                                                    boost::asio::steady_timer& disk) {
    boost::system::error_code cancelled;
    co_await disk.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, cancelled));
    co_return store.run(run);
  }
  /// Until the stream has something to tell, or has waited as long as it may.
  void wait_for(EventStream& stream) {
    bool is_over = false;
    boost::asio::co_spawn(quiet_.context(), stream.wait(),
                          [&](const std::exception_ptr&) { is_over = true; });
    quiet_.context().restart();
    while (!is_over) quiet_.context().run_one();
  }
  static HttpRequest local(std::optional<std::string> last_event_id = std::nullopt) {
    return {.last_event_id = std::move(last_event_id), .from_loopback = true};
  }
  static HttpRequest with(const std::string& token) { return {.authorization = "Bearer " + token}; }

  QuietCell quiet_;
  Services services_{quiet_.operation(), kTokens};
  bool resetting_ = false;
};

TEST_F(EventStreams, BeginWithTheWholeStatusAndGoOnWithEachChangeOnce) {
  EventStream stream(services_, {}, local());
  const auto first = parsed(stream.due());
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].name, "status");
  EXPECT_EQ(first[0].id, id_of(sequence()));
  EXPECT_EQ(stream.due(), "");
  std::vector<std::uint64_t> wanted;
  std::vector<std::uint64_t> seen;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i <= round; ++i) {
      change();
      wanted.push_back(sequence());
    }
    for (const SentEvent& event : parsed(stream.due())) {
      EXPECT_EQ(event.name, "status");
      EXPECT_EQ(event.id, id_of(event.data.at("sequence").get<std::uint64_t>()));
      seen.push_back(event.data.at("sequence"));
    }
  }
  EXPECT_EQ(seen, wanted);
}

TEST_F(EventStreams, GoOnWhereAReaderLeftOff) {
  std::string last;
  {
    EventStream stream(services_, {}, local());
    change();
    last = parsed(stream.due()).back().id;
  }
  change();
  change();
  EventStream again(services_, {}, local(last));
  const auto missed = parsed(again.due());
  ASSERT_EQ(missed.size(), 2u);
  EXPECT_EQ(missed[0].id, id_of(sequence() - 1));
  EXPECT_EQ(missed[1].id, id_of(sequence()));
  EXPECT_EQ(missed[1].name, "status");
}

TEST_F(EventStreams, TellAReaderThatItHasToBeginAgain) {
  const std::string begin = id_of(sequence());
  for (std::size_t i = 0; i <= kChangesKept; ++i) change();
  for (const std::string& unknown :
       {begin, std::string("other-1"), id_of(sequence() + 1), std::string("instance-"), std::string("x"),
        std::string("instance-1x")}) {
    EventStream stream(services_, {}, local(unknown));
    const auto events = parsed(stream.due());
    ASSERT_EQ(events.size(), 1u) << unknown;
    EXPECT_EQ(events[0].name, "reset") << unknown;
    EXPECT_EQ(events[0].data.at("sequence"), sequence()) << unknown;
  }
  EventStream slow(services_, {}, local());
  slow.due();
  for (std::size_t i = 0; i <= kChangesKept; ++i) change();
  EXPECT_EQ(parsed(slow.due()).at(0).name, "reset") << "a reader that fell behind";
}

TEST_F(EventStreams, OfARunEndWithItsDocument) {
  const std::int64_t run = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  EventStream stream(services_, run, local(), look_up());
  stream.due();
  change();
  EXPECT_EQ(stream.due(), "") << "what happens outside of the run is not told";
  EXPECT_FALSE(stream.ended());
  quiet_.store().finish_run(
      run, {.outcome = RunOutcome::kStopped, .verdict = Verdict::kIncomplete, .ended_at = "end"});
  EXPECT_EQ(stream.due(), "") << "that it is over is read elsewhere";
  boost::asio::co_spawn(quiet_.context(), stream.wait(), boost::asio::detached);
  quiet_.context().poll();
  const auto events = parsed(stream.due());
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].name, "run");
  EXPECT_EQ(events[0].data.at("outcome"), "stopped");
  EXPECT_TRUE(stream.ended());
  EXPECT_TRUE(EventStream::is_over(events[0].id));
  EXPECT_FALSE(EventStream::is_over(id_of(1)));
}

TEST_F(EventStreams, OfARunShowThatTheyLiveWhileItsEndIsReadFromASlowDisk) {
  boost::asio::steady_timer disk(quiet_.context(), boost::asio::steady_timer::time_point::max());
  const std::int64_t run = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  int look_ups = 0;
  const RunLookUp slow = [&](std::int64_t of) {
    ++look_ups;
    return read_late(quiet_.store(), of, disk);
  };
  EventStream stream(services_, run, local(), slow, std::chrono::milliseconds(1));
  EXPECT_NE(stream.due(), "");
  for (int i = 0; i < 3; ++i) {
    wait_for(stream);
    EXPECT_EQ(stream.due(), "") << "which is told as a comment";
    EXPECT_FALSE(stream.ended());
  }
  EXPECT_EQ(look_ups, 1) << "the disk is asked once";
  quiet_.store().finish_run(
      run, {.outcome = RunOutcome::kStopped, .verdict = Verdict::kIncomplete, .ended_at = "end"});
  disk.cancel();
  wait_for(stream);
  ASSERT_EQ(parsed(stream.due()).size(), 1u);
  EXPECT_TRUE(stream.ended());
}

TEST_F(EventStreams, WhoseClientHasGoneCountAsOpenUntilTheDiskAnswers) {
  boost::asio::steady_timer disk(quiet_.context(), boost::asio::steady_timer::time_point::max());
  const std::int64_t run = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  const RunLookUp slow = [&](std::int64_t of) { return read_late(quiet_.store(), of, disk); };
  {
    EventStream stream(services_, run, local(), slow, std::chrono::milliseconds(1));
    wait_for(stream);
  }
  EXPECT_EQ(EventStream::open_count(services_), 1) << "else a disk that hangs had one look-up more for each";
  disk.cancel();
  quiet_.context().restart();
  quiet_.context().poll();
  EXPECT_EQ(EventStream::open_count(services_), 0);
}

TEST_F(EventStreams, EndWithTheirTokenAndOthersGoOn) {
  EventStream anna(services_, {}, with(kTokens.operators[0].token));
  EventStream bert(services_, {}, with(kTokens.operators[1].token));
  EventStream viewer(services_, {}, with(kTokens.view));
  EventStream nobody(services_, {}, local());
  HttpRequest over_loopback = with(kTokens.operators[0].token);
  over_loopback.from_loopback = true;
  EventStream anna_here(services_, {}, over_loopback);
  EXPECT_NE(anna.due(), "");
  services_.tokens.operators.erase(services_.tokens.operators.begin());
  change();
  for (EventStream* of_anna : {&anna, &anna_here}) {
    EXPECT_EQ(of_anna->due(), "") << "not even what changed before";
    EXPECT_TRUE(of_anna->ended());
  }
  services_.tokens.view = std::string(64, 'f');
  EXPECT_EQ(viewer.due(), "");
  EXPECT_TRUE(viewer.ended());
  for (EventStream* other : {&bert, &nobody}) {
    EXPECT_NE(other->due(), "");
    EXPECT_FALSE(other->ended());
  }
}

TEST_F(EventStreams, WhoseTokenGoesWhileTheyWriteDoNotWait) {
  EventStream stream(services_, {}, with(kTokens.view));
  services_.tokens.view.clear();
  boost::asio::co_spawn(quiet_.context(), stream.wait(), boost::asio::detached);
  quiet_.context().poll();
  EXPECT_EQ(services_.feed.waiting_count(), 0U);
  EXPECT_EQ(stream.due(), "");
}

TEST_F(EventStreams, AreCountedWhileTheyAreOpen) {
  {
    const EventStream first(services_, {}, local());
    const EventStream second(services_, {}, local());
    EXPECT_EQ(EventStream::open_count(services_), 2);
  }
  EXPECT_EQ(EventStream::open_count(services_), 0);
}

}  // namespace
}  // namespace cell
