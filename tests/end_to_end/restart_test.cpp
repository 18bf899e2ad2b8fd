// A daemon that is killed in the middle of a run, and the next one on the same store, while the controller
// lives on.
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <nlohmann/json.hpp>

#include "service/acquisition/cell_operation.hpp"
#include "service/base/context.hpp"
#include "service/documents/json_view.hpp"
#include "service/store/maintenance.hpp"
#include "sim_controller/server.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;

constexpr std::chrono::seconds kRestartPatience{120};
constexpr const char* kFewTouches = "few";
constexpr int kTouchesInAll = 4 * (7 + 1);

/// The simulated controller and daemons on one store, one after the other. Touches repeat exactly, so that
/// two runs can be compared.
class MortalDaemon {
 public:
  MortalDaemon() : cell(shipped_cell("edf")) {
    spdlog::set_level(spdlog::level::off);
    cell.deadlines.heartbeat_timeout = sim::kHeartbeatTimeoutMax;  // the machine may be busy with other tests
    cell::Recipe recipe = cell.recipes.at(kRecipe);
    recipe.name = kFewTouches;
    recipe.fit_per_face = 7;
    recipe.held_out_per_face = 1;
    recipe.candidate_count = 2'000;
    cell.recipes.emplace(recipe.name, recipe);
    sim::Plant plant = sim::make_plant(cell, shipped_truth("edf"));
    plant.touch_noise_m = 0.0;
    sim::ServerOptions options{.controller = {.speed = sim::kSpeedMax}};
    server_.emplace(controller_io_, "127.0.0.1", 0, std::move(plant), std::move(options));
  }
  ~MortalDaemon() { kill(); }

  void launch() {
    io_ = std::make_unique<cell::Context>(1);
    computation_ = std::make_unique<boost::asio::thread_pool>(1);
    store_ = std::make_unique<cell::RunStore>(store_file());
    operation_ = std::make_unique<cell::CellOperation>(
        cell::CellOperation::Threads{io_->get_executor(), computation_->get_executor(),
                                     computation_->get_executor()},
        cell, cell::StoreQueue(*store_, io_->get_executor()), cell::Endpoint{"127.0.0.1", server_->port()},
        "restart", cell::Clocks{std::chrono::system_clock::now, std::chrono::steady_clock::now});
    operation_->launch();
  }
  /// Nothing of the daemon gets to act any more.
  void kill() {
    computation_.reset();     // waits for what it is at, of which nobody hears
    if (io_) io_->give_up();  // its coroutines, while the operation that they refer to is there
    operation_.reset();
    io_.reset();
    store_.reset();
  }
  /// One thing that the daemon does.
  void step() {
    controller_io_.poll();
    io_->run_one_for(std::chrono::milliseconds(2));
    ++steps_;
  }
  void run_until(const std::function<bool(const cell::Status&)>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + kRestartPatience;
    while (!condition(operation_->status())) {
      if (std::chrono::steady_clock::now() >= deadline)
        throw std::runtime_error("waited in vain: " + cell::status_document(operation_->status()));
      step();
    }
  }
  void run_until(State state) {
    run_until([state](const cell::Status& status) { return status.state == state; });
  }
  void command(Command command) {
    if (const auto refusal = operation_->command(command)) throw std::runtime_error(refusal->detail);
  }
  std::variant<cell::Started, cell::CommandRefusal> ask_to_start(const cell::StartRequest& request) {
    std::optional<std::variant<cell::Started, cell::CommandRefusal>> answer;
    boost::asio::co_spawn(
        *io_, operation_->start(request),
        [&](const std::exception_ptr&, const std::variant<cell::Started, cell::CommandRefusal>& given) {
          answer = given;
        });
    while (!answer) step();
    return *answer;
  }
  void start(const std::optional<cell::BlockTemperature>& temperature = {},
             std::optional<cell::StiffnessChoice> stiffness = {}) {
    run_until(State::kIdle);
    if (const auto answer = ask_to_start({.recipe = kFewTouches,
                                          .idempotency_key = {},
                                          .operator_name = {},
                                          .block_temperature = temperature,
                                          .stiffness = stiffness});
        const auto* refusal = std::get_if<cell::CommandRefusal>(&answer)) {
      throw std::runtime_error(refusal->detail);
    }
  }
  void finish() {
    run_until([](const cell::Status& status) {
      return !cell::is_active(status.state) || (status.state == State::kHeld && status.fault);
    });
  }
  /// What the next daemon says of the run before anybody asks it for something, once it has a link.
  cell::Status restart() {
    kill();
    launch();
    run_until([](const cell::Status& status) { return status.controller.connected; });
    const auto asked = steps_;  // what became of the open command is asked for now
    run_until(
        [&](const cell::Status& status) { return steps_ > asked + 50 || status.state != State::kHeld; });
    return operation_->status();
  }

  [[nodiscard]] cell::CellOperation& operation() { return *operation_; }
  [[nodiscard]] cell::RunStore& store() { return *store_; }
  [[nodiscard]] cell::Status status() const { return operation_->status(); }
  [[nodiscard]] std::filesystem::path store_file() const { return folder_ / "touchcal.sqlite"; }

  cell::Cell cell;

 private:
  Folder folder_;
  boost::asio::io_context controller_io_{1};
  std::optional<sim::Server> server_;
  std::unique_ptr<cell::Context> io_;
  std::unique_ptr<boost::asio::thread_pool> computation_;
  std::unique_ptr<cell::RunStore> store_;
  std::unique_ptr<cell::CellOperation> operation_;
  long steps_ = 0;
};

/// A run that nothing interrupted.
struct Unbroken {
  std::vector<cell::StoredTouch> touches;
  std::string result;
};
const Unbroken& unbroken() {
  static const Unbroken run = [] {
    MortalDaemon daemon;
    daemon.launch();
    daemon.start();
    daemon.finish();
    if (daemon.status().state != State::kComplete)
      throw std::runtime_error(cell::status_document(daemon.status()));
    return Unbroken{daemon.store().touches(1), daemon.store().result_json(1).value()};
  }();
  return run;
}

void expect_touches_of_the_unbroken_run(const std::vector<cell::StoredTouch>& touches) {
  ASSERT_LE(touches.size(), unbroken().touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    EXPECT_EQ(touches[i].number, static_cast<int>(i) + 1);
    EXPECT_EQ(touches[i].plane, unbroken().touches[i].plane) << i;
    EXPECT_EQ(touches[i].joints, unbroken().touches[i].joints) << i;
    EXPECT_TRUE(touches[i].first) << "each is made at two speeds";
    EXPECT_EQ(touches[i].first, unbroken().touches[i].first) << i;
  }
}

/// A restarted daemon looks at its reference place once more, which tells more of the noise: the result is of
/// the same touches, weighed a little differently.
void expect_result_of_the_unbroken_run(const std::string& text) {
  const auto result = nlohmann::json::parse(text), whole = nlohmann::json::parse(unbroken().result);
  for (const char* key : {"touch_count", "complete", "converged", "identifiable_count", "rejected_touches"})
    EXPECT_EQ(result.at(key), whole.at(key)) << key;
  EXPECT_EQ(result.at("verdict").at("accepted"), whole.at("verdict").at("accepted"));
  constexpr double kShareOfStd = 0.1;
  for (std::size_t i = 0; i < whole.at("parameters").size(); ++i) {
    const auto& ours = result.at("parameters")[i];
    const auto& theirs = whole.at("parameters")[i];
    ASSERT_EQ(ours.at("status"), theirs.at("status")) << i;
    if (theirs.at("status") != "identified") continue;
    EXPECT_NEAR(ours.at("error").get<double>(), theirs.at("error").get<double>(),
                kShareOfStd * theirs.at("std_uncertainty").get<double>())
        << theirs.at("name");
  }
}

TEST(Restart, ARunThatWasKilledAgainAndAgainEndsAsTheUnbrokenOne) {
  unbroken();  // first: while it is made no other link is kept alive
  MortalDaemon daemon;
  daemon.launch();
  daemon.start();
  for (const int touches : {0, 1, 2, 9, kTouchesInAll - 1}) {
    SCOPED_TRACE("killed after touch " + std::to_string(touches));
    daemon.run_until([&](const cell::Status& status) { return status.touches_done >= touches; });
    const cell::Status held = daemon.restart();
    ASSERT_EQ(held.state, State::kHeld);
    EXPECT_EQ(cell::describe(held.fault.value().code).name, "daemon_restarted");
    EXPECT_EQ(held.run_id, 1);
    EXPECT_GE(held.touches_done, touches);
    EXPECT_LE(held.touches_done, touches + 1);
    EXPECT_EQ(daemon.store().run(1)->outcome, cell::RunOutcome::kRunning);
    expect_touches_of_the_unbroken_run(daemon.store().touches(1));
    daemon.command(Command::kResume);
    daemon.run_until([](const cell::Status& status) {
      return status.state != State::kHeld && status.state != State::kUnholding;
    });
  }
  daemon.finish();
  EXPECT_EQ(daemon.status().state, State::kComplete);
  EXPECT_EQ(daemon.store().touches(1).size(), unbroken().touches.size());
  expect_touches_of_the_unbroken_run(daemon.store().touches(1));
  expect_result_of_the_unbroken_run(daemon.store().result_json(1).value());
  EXPECT_THAT(cell::find_damage(daemon.store_file()), ::testing::IsEmpty());
}

TEST(Restart, WhateverItDidWhenItWasKilledNoAnsweredTouchIsLostOrCountedTwice) {
  unbroken();
  for (int steps = 1; steps <= 13; steps += 3) {
    SCOPED_TRACE("killed " + std::to_string(steps) + " steps after the third touch");
    MortalDaemon daemon;
    daemon.launch();
    daemon.start();
    daemon.run_until([](const cell::Status& status) { return status.touches_done >= 3; });
    for (int step = 0; step < steps; ++step) daemon.step();
    const cell::Status held = daemon.restart();
    ASSERT_EQ(held.state, State::kHeld);
    EXPECT_GE(held.touches_done, 3);
    expect_touches_of_the_unbroken_run(daemon.store().touches(1));
    daemon.command(Command::kResume);
    const int more = held.touches_done + 2;
    daemon.run_until([&](const cell::Status& status) { return status.touches_done >= more || status.fault; });
    EXPECT_FALSE(daemon.status().fault) << daemon.status().fault->message();
    expect_touches_of_the_unbroken_run(daemon.store().touches(1));
  }
}

TEST(Restart, ADaemonThatIsKilledWhileItAsksForTheLastAnswerLeavesItToTheNext) {
  MortalDaemon daemon;
  daemon.launch();
  daemon.start();
  daemon.run_until([](const cell::Status& status) { return status.touches_done >= 2; });
  while (!daemon.store().open_command(1)) daemon.step();
  for (int i = 0; i < 3; ++i) {
    daemon.kill();
    daemon.launch();
    daemon.run_until([](const cell::Status& status) { return status.controller.connected; });
  }
  ASSERT_EQ(daemon.restart().state, State::kHeld);
  EXPECT_GE(daemon.status().touches_done, 2);
  daemon.command(Command::kResume);
  daemon.finish();
  EXPECT_EQ(daemon.status().state, State::kComplete);
  EXPECT_EQ(daemon.store().touches(1).size(), kTouchesInAll);
}

TEST(Restart, ARunKeepsTheTemperatureThatItWasStartedWith) {
  MortalDaemon daemon;
  daemon.launch();
  daemon.start(cell::BlockTemperature{25.0, 0.5, std::chrono::system_clock::now()});
  daemon.run_until([](const cell::Status& status) { return status.touches_done >= 9; });
  const auto planes = [&] { return daemon.operation().run()->problem().artefact.contact_planes; };
  const double warm_m = planes().front().offset_m;
  EXPECT_GT(warm_m, daemon.cell.block.faces.front().plane.offset_m);
  ASSERT_EQ(daemon.restart().state, State::kHeld);
  EXPECT_EQ(planes().front().offset_m, warm_m);
  daemon.command(Command::kResume);
  daemon.run_until([](const cell::Status& status) {
    return status.state != State::kHeld && status.state != State::kUnholding;
  });
  daemon.finish();
  EXPECT_EQ(daemon.status().state, State::kComplete);
  const auto result = nlohmann::json::parse(daemon.store().result_json(1).value());
  EXPECT_EQ(result.at("conditions").at("block_temperature_c"), 25.0);
  EXPECT_NE(daemon.store().result_json(1), unbroken().result);
}

TEST(Restart, ARunKeepsTheChoiceOfStiffnessThatItWasStartedWith) {
  MortalDaemon daemon;
  daemon.launch();
  const auto is_elastic = [&] { return daemon.operation().run()->recipe().identification.stiffness; };
  const bool of_recipe = daemon.cell.recipes.at(kFewTouches).identification.stiffness;
  daemon.start({}, of_recipe ? cell::StiffnessChoice::kOff : cell::StiffnessChoice::kOn);
  daemon.run_until([](const cell::Status& status) { return status.touches_done >= 9; });
  ASSERT_NE(is_elastic(), of_recipe);
  ASSERT_EQ(daemon.restart().state, State::kHeld);
  EXPECT_NE(is_elastic(), of_recipe);
  daemon.command(Command::kResume);
  daemon.run_until([](const cell::Status& status) {
    return status.state != State::kHeld && status.state != State::kUnholding;
  });
  daemon.finish();
  EXPECT_EQ(daemon.status().state, State::kComplete);
  const auto result = nlohmann::json::parse(daemon.store().result_json(1).value());
  EXPECT_EQ(result.at("model").empty(), of_recipe) << result.at("model");
}

TEST(Restart, AnInterruptedRunThatIsStoppedStaysInterruptedAndTheNextOneCanStart) {
  MortalDaemon daemon;
  daemon.launch();
  daemon.start();
  daemon.run_until([](const cell::Status& status) { return status.touches_done >= 2; });
  ASSERT_EQ(daemon.restart().state, State::kHeld);
  EXPECT_TRUE(std::holds_alternative<cell::CommandRefusal>(daemon.ask_to_start({.recipe = kFewTouches})));
  daemon.command(Command::kStop);
  daemon.run_until(State::kStopped);
  EXPECT_EQ(daemon.store().run(1)->outcome, cell::RunOutcome::kInterrupted);
  EXPECT_EQ(daemon.store().run(1)->fault_code, "daemon_restarted");
  daemon.command(Command::kReset);
  daemon.start();
  daemon.run_until([](const cell::Status& status) { return status.run_id == 2 && status.touches_done >= 1; });
}

TEST(Restart, ARunOfARecipeThatIsGoneWaitsForItsFilesOrForAPersonWhoEndsIt) {
  MortalDaemon daemon;
  daemon.launch();
  daemon.start();
  daemon.run_until([](const cell::Status& status) { return status.touches_done >= 1; });
  const int kept = daemon.store().run(1)->touches_done;
  daemon.kill();
  daemon.cell.recipes.erase(kFewTouches);
  daemon.launch();
  daemon.run_until([](const cell::Status& status) { return status.controller.connected; });
  EXPECT_EQ(daemon.status().state, State::kHeld);
  EXPECT_EQ(daemon.status().touches_done, kept);
  EXPECT_THAT(daemon.status().fault->message(), ::testing::HasSubstr(kFewTouches));
  EXPECT_THAT(daemon.operation().exits(), ::testing::Not(::testing::Contains(Command::kResume)));
  EXPECT_EQ(daemon.store().run(1)->outcome, cell::RunOutcome::kRunning);

  daemon.command(Command::kStop);
  daemon.run_until(State::kStopped);
  EXPECT_EQ(daemon.store().run(1)->outcome, cell::RunOutcome::kInterrupted);
  EXPECT_FALSE(daemon.store().result_json(1)) << "of touches that these files say nothing of";
  daemon.command(Command::kReset);
  daemon.run_until(State::kIdle);
}

TEST(Restart, ARunGoesOnOnceItsFilesAreBack) {
  MortalDaemon daemon;
  daemon.launch();
  daemon.start();
  daemon.run_until([](const cell::Status& status) { return status.touches_done >= 1; });
  daemon.kill();
  const cell::Recipe recipe = daemon.cell.recipes.at(kFewTouches);
  daemon.cell.recipes.erase(kFewTouches);
  daemon.launch();
  daemon.run_until([](const cell::Status& status) { return status.controller.connected; });
  ASSERT_EQ(daemon.status().state, State::kHeld);
  daemon.cell.recipes.emplace(kFewTouches, recipe);
  ASSERT_EQ(daemon.restart().state, State::kHeld);
  daemon.command(Command::kResume);
  daemon.finish();
  EXPECT_EQ(daemon.status().state, State::kComplete);
  EXPECT_EQ(daemon.store().runs(10).size(), 1U);
}

}  // namespace
}  // namespace touchcal::testing
