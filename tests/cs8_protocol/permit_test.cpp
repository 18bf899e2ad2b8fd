#include <gmock/gmock.h>

#include "tests/cs8_protocol/fake_controller.hpp"

/// Begin and what becomes of it: whatever the controller answers or leaves out, begin() ends and says which.
namespace cs8 {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr std::uint32_t kRun = 31;
constexpr milliseconds kConfirmWithin{5000};

constexpr Permit kAwaitedPermit{.run = kRun, .state = PermitState::kAwaited};
constexpr Permit kGrantedPermit{.run = kRun, .state = PermitState::kGranted};

class PermitTest : public WithFakeController {
 protected:
  Client make_asking_client(ClientOptions options = patient()) {
    return Client(io_.get_executor(), options,
                  {.on_state = {},
                   .on_permit =
                       [this](const Permit& permit) {
                         told_.push_back(permit.state);
                         if (on_permit_) on_permit_(permit);
                       },
                   .on_loss = [this](const LinkError& error) { losses_.push_back(error); }});
  }

  /// What begin() gives when the controller, after Begin, does `script`.
  PermitReply begin_while(const Script& script, ClientOptions options = patient(),
                          milliseconds confirm_within = kConfirmWithin) {
    Client client = make_asking_client(options);
    PermitReply reply;
    controller_does({[&](Peer& peer) -> asio::awaitable<void> {
      co_await peer.shake_hands(welcome());
      const Begin begin = co_await peer.receive<Begin>();
      EXPECT_EQ(begin.run, kRun);
      EXPECT_EQ(begin.confirm_within_ms, static_cast<std::uint32_t>(confirm_within.count()));
      co_await script(peer);
    }});
    run([&]() -> asio::awaitable<void> {
      const ConnectReply connected = co_await client.connect(endpoint(), expected());
      EXPECT_TRUE(std::holds_alternative<Welcome>(connected));
      EXPECT_FALSE(client.latest_permit());
      reply = co_await client.begin(kRun, confirm_within);
      EXPECT_EQ(client.connected(), std::holds_alternative<Permit>(reply));
      client.close();
    });
    return reply;
  }

  LinkError error_of(const PermitReply& reply) {
    if (const auto* error = std::get_if<LinkError>(&reply)) return *error;
    ADD_FAILURE() << "there is a permit";
    return {};
  }

  Permit permit_of(const PermitReply& reply) {
    if (const auto* permit = std::get_if<Permit>(&reply)) return *permit;
    ADD_FAILURE() << std::get<LinkError>(reply).text;
    return {};
  }

  static Script answer(std::vector<Permit> permits) {
    return [permits = std::move(permits)](Peer& peer) -> asio::awaitable<void> {
      for (const Permit& permit : permits) peer.send(0, permit);
      co_await peer.until_closed();
    };
  }

  std::function<void(const Permit&)> on_permit_;
  std::vector<PermitState> told_;
};

TEST_F(PermitTest, AConfirmedBeginIsGranted) {
  const Permit permit = permit_of(begin_while(answer({kAwaitedPermit, kGrantedPermit})));
  EXPECT_EQ(permit.state, PermitState::kGranted);
  EXPECT_EQ(told_, (std::vector{PermitState::kAwaited, PermitState::kGranted}));
  EXPECT_TRUE(losses_.empty());
}

TEST_F(PermitTest, ARefusedBeginSaysWhy) {
  const Permit refused{.run = kRun,
                       .state = PermitState::kNone,
                       .reason = PermitReason::kRefused,
                       .detail = static_cast<std::int32_t>(RejectReason::kTouchTestMissing)};
  const Permit permit = permit_of(begin_while(answer({refused})));
  EXPECT_EQ(permit.reason, PermitReason::kRefused);
  EXPECT_EQ(permit.detail, refused.detail);
}

TEST_F(PermitTest, NobodyConfirmsInTime) {
  const Permit late{.run = kRun, .state = PermitState::kNone, .reason = PermitReason::kNotConfirmed};
  EXPECT_EQ(permit_of(begin_while(answer({kAwaitedPermit, late}))).reason, PermitReason::kNotConfirmed);
}

TEST_F(PermitTest, AnEarlierPermitThatEndsMeanwhileIsNotTakenForTheAnswer) {
  const Permit lost{.run = kRun, .state = PermitState::kNone, .reason = PermitReason::kPermissionLost};
  const Permit permit = permit_of(begin_while(answer({lost, kAwaitedPermit, kGrantedPermit})));
  EXPECT_EQ(permit.state, PermitState::kGranted);
}

TEST_F(PermitTest, ABeginThatIsNotAnsweredEndsTheConnectionAtItsDeadline) {
  ClientOptions options = patient();
  options.answer_deadline = milliseconds(40);
  const LinkError error = error_of(begin_while(answer({}), options));
  EXPECT_EQ(error.kind, LinkErrorKind::kUnanswered);
  EXPECT_THAT(error.text, HasSubstr("begin of run 31 was not answered"));
  EXPECT_EQ(losses_.size(), 1u);
}

TEST_F(PermitTest, AConfirmationThatIsNeverDecidedEndsTheConnectionAtItsDeadline) {
  ClientOptions options = patient();
  options.result_margin = milliseconds(20);
  const auto start = std::chrono::steady_clock::now();
  const LinkError error = error_of(begin_while(answer({kAwaitedPermit}), options, milliseconds(40)));
  EXPECT_EQ(error.kind, LinkErrorKind::kUnanswered);
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(60));
}

TEST_F(PermitTest, AConnectionLostWhileTheConfirmationIsAwaitedEndsBegin) {
  const LinkError error = error_of(begin_while([](Peer& peer) -> asio::awaitable<void> {
    peer.send(0, kAwaitedPermit);
    co_return;
  }));
  EXPECT_EQ(error.kind, LinkErrorKind::kPeerClosed);
  EXPECT_EQ(losses_.size(), 1u);
}

TEST_F(PermitTest, AGrantBeforeTheBeginWasTakenEndsTheConnection) {
  EXPECT_EQ(error_of(begin_while(answer({kGrantedPermit}))).kind, LinkErrorKind::kProtocol);
}

TEST_F(PermitTest, APermitOfAnotherRunEndsTheConnection) {
  Permit other = kAwaitedPermit;
  ++other.run;
  const LinkError error = error_of(begin_while(answer({other})));
  EXPECT_EQ(error.kind, LinkErrorKind::kProtocol);
  EXPECT_THAT(error.text, HasSubstr("permit"));
}

TEST_F(PermitTest, APermitNobodyAskedForEndsTheConnection) {
  Client client = make_asking_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    peer.send(0, Permit{});
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    const ConnectReply connected = co_await client.connect(endpoint(), expected());
    EXPECT_TRUE(std::holds_alternative<Welcome>(connected));
  });
  ASSERT_EQ(losses_.size(), 1u);
  EXPECT_EQ(losses_.front().kind, LinkErrorKind::kProtocol);
  EXPECT_TRUE(told_.empty());
}

TEST_F(PermitTest, APermitOfAnEarlierConnectionEndsTheNextOne) {
  Client client = make_asking_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
                     co_await peer.shake_hands(welcome());
                     co_await peer.receive<Begin>();
                     peer.send(0, kAwaitedPermit);
                     peer.send(0, kGrantedPermit);
                     co_await peer.until_closed();
                   },
                   [&](Peer& peer) -> asio::awaitable<void> {
                     co_await peer.shake_hands(welcome());
                     peer.send(0, kGrantedPermit);
                     co_await peer.until_closed();
                   }});
  run([&]() -> asio::awaitable<void> {
    const ConnectReply first = co_await client.connect(endpoint(), expected());
    EXPECT_TRUE(std::holds_alternative<Welcome>(first));
    const PermitReply granted = co_await client.begin(kRun, kConfirmWithin);
    permit_of(granted);
    const ConnectReply second = co_await client.connect(endpoint(), expected());
    EXPECT_TRUE(std::holds_alternative<Welcome>(second));
    EXPECT_FALSE(client.latest_permit());
  });
  ASSERT_EQ(losses_.size(), 1u);
  EXPECT_EQ(losses_.front().kind, LinkErrorKind::kProtocol);
}

TEST_F(PermitTest, AWithdrawnPermitIsToldAndNotGrantedAgainUnasked) {
  const Permit lost{.run = kRun, .state = PermitState::kNone, .reason = PermitReason::kPermissionLost};
  Client client = make_asking_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Begin>();
    for (const Permit& permit : {kAwaitedPermit, kGrantedPermit, lost, kGrantedPermit}) peer.send(0, permit);
    co_await peer.until_closed();
  }});
  std::optional<Permit> when_lost;
  on_permit_ = [&](const Permit& permit) {
    if (permit.state == PermitState::kNone) when_lost = client.latest_permit();
  };
  run([&]() -> asio::awaitable<void> {
    const ConnectReply connected = co_await client.connect(endpoint(), expected());
    EXPECT_TRUE(std::holds_alternative<Welcome>(connected));
    const PermitReply reply = co_await client.begin(kRun, kConfirmWithin);
    EXPECT_EQ(permit_of(reply).state, PermitState::kGranted);
  });
  ASSERT_TRUE(when_lost);
  EXPECT_EQ(when_lost->reason, PermitReason::kPermissionLost);
  ASSERT_EQ(losses_.size(), 1u) << "the second grant";
  EXPECT_EQ(losses_.front().kind, LinkErrorKind::kProtocol);
}

TEST_F(PermitTest, FinishAndStopAreSentWhileTheConfirmationIsAwaited) {
  Client client = make_asking_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Begin>();
    peer.send(0, kAwaitedPermit);
    co_await peer.receive<Stop>();
    co_await peer.receive<Finish>();
    peer.send(0, Permit{.run = kRun, .state = PermitState::kNone, .reason = PermitReason::kFinished});
    co_await peer.until_closed();
  }});
  on_permit_ = [&](const Permit& permit) {
    if (permit.state != PermitState::kAwaited) return;
    client.stop();
    client.finish();
  };
  run([&]() -> asio::awaitable<void> {
    const ConnectReply connected = co_await client.connect(endpoint(), expected());
    EXPECT_TRUE(std::holds_alternative<Welcome>(connected));
    const PermitReply reply = co_await client.begin(kRun, kConfirmWithin);
    EXPECT_EQ(permit_of(reply).reason, PermitReason::kFinished);
    client.close();
  });
  EXPECT_TRUE(losses_.empty());
}

TEST_F(PermitTest, BeginWithoutAConnectionSaysSo) {
  Client client = make_asking_client();
  run([&]() -> asio::awaitable<void> {
    client.finish();
    const PermitReply reply = co_await client.begin(kRun, kConfirmWithin);
    EXPECT_EQ(error_of(reply).kind, LinkErrorKind::kNotConnected);
  });
}

}  // namespace
}  // namespace cs8
