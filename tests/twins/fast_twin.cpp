#include <algorithm>
#include <utility>

#include "sim_controller/controller.hpp"
#include "tests/sim_controller/aimed_touch.hpp"
#include "tests/twins/twin.hpp"

namespace twins {
namespace {

constexpr std::chrono::milliseconds kTick{4};

/// The C++ twin: its steps, as the server takes them.
class FastTwin final : public Twin {
 public:
  explicit FastTwin(const Scenario& scenario)
      : state_(sim::make_controller(plant(), {.seed = scenario.seed, .duties = {.powers_up = false}}, now_)) {
    state_.plan = sim::FaultPlan(scenario.faults);
  }

  void tick() override {
    now_ += kTick;
    happen(sim::Tick{});
  }
  bool connect() override {
    if (is_connected_) return false;
    is_connected_ = true;
    happen(sim::ConnectionOpened{});
    return true;
  }
  void disconnect() override {
    if (!std::exchange(is_connected_, false)) return;
    happen(sim::ConnectionClosed{});
    sent_.clear();
  }
  bool is_connected() override { return is_connected_; }
  void give(const cs8::Message& message) override { happen(message); }
  std::vector<cs8::Message> take() override { return std::exchange(sent_, {}); }

  [[nodiscard]] double clock_s() const override {
    return std::chrono::duration<double>(now_.time_since_epoch()).count() - kStartSeconds;
  }
  sim::Cabinet& cabinet() override { return state_.cabinet; }
  sim::Operator& person() override { return state_.person; }
  sim::FaultPlan& plan() override { return state_.plan; }

 private:
  void happen(const sim::Event& event) {
    sim::Replies replies = sim::step(plant(), state_, event, now_);
    if (!is_connected_) return;
    std::move(replies.messages.begin(), replies.messages.end(), std::back_inserter(sent_));
    if (!replies.close) return;
    is_connected_ = false;
    sim::step(plant(), state_, sim::ConnectionClosed{}, now_);
  }

  sim::TimePoint now_{std::chrono::seconds(static_cast<int>(kStartSeconds))};
  sim::ControllerState state_;
  std::vector<cs8::Message> sent_;
  bool is_connected_ = false;
};

}  // namespace

const sim::Plant& plant() {
  static const sim::Plant plant = sim::testing::true_plant("demo");
  return plant;
}

std::unique_ptr<Twin> make_fast_twin(const Scenario& scenario) {
  return std::make_unique<FastTwin>(scenario);
}

}  // namespace twins
