// The plan that was shown is the plan that runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "service/http/routes/routes.hpp"
#include "tests/end_to_end/loopback_cell.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;

/// How far joints are from where the nominal arm would have them, of an arm that misses by some 10 mm.
constexpr double kReaimedDegMax = 3.0;

TEST(PlanRun, MakesEachTouchOfThePlanThatWasShownOnce) {
  LoopbackCell loop("demo");
  loop.serve();
  loop.launch();
  loop.run_until(cell::State::kIdle);
  boost::asio::co_spawn(loop.io(), loop.operation().plan_recipe(kShortRecipe), boost::asio::detached);
  while (!loop.operation().planned(kShortRecipe)) loop.io().run_one();

  const cell::Tokens tokens{"operate", "view"};
  const auto send = [&](const std::string& method, const std::string& path, const std::string& body) {
    std::optional<cell::HttpResponse> answer;
    cell::HttpRequest request{.method = method,
                              .path = "/api/v1/" + path,
                              .authorization = "Bearer operate",
                              .content_type = "application/json",
                              .body = body};
    boost::asio::co_spawn(
        loop.io(), cell::route(std::move(request), loop.operation(), tokens),
        [&answer](const std::exception_ptr&, cell::HttpResponse made) { answer = std::move(made); });
    while (!answer) loop.io().run_one();
    return *answer;
  };
  const cell::HttpResponse shown = send("POST", "plan", json{{"recipe", kShortRecipe}}.dump());
  ASSERT_EQ(shown.status, 200u) << shown.body;
  const json plan = json::parse(shown.body);

  const cell::HttpResponse started = send("POST", "runs", json{{"plan_id", plan.at("plan_id")}}.dump());
  ASSERT_EQ(started.status, 201u) << started.body;
  loop.run_until_over();
  ASSERT_EQ(loop.status().state, cell::State::kComplete) << loop.fault_name();

  const std::string run = json::parse(started.body).at("id");
  EXPECT_EQ(send("GET", "runs/" + run + "/plan", "").body, shown.body);
  const json made = json::parse(send("GET", "runs/" + run + "/touches", "").body).at("touches");
  ASSERT_EQ(made.size(), plan.at("touches").size());
  // One that cannot be made as it is aimed when its turn comes is put off; none is left out or made twice.
  json due = plan.at("touches");
  for (const json& touch : made) {
    const auto is_it = [&](const json& planned) {
      if (planned.at("plane") != touch.at("plane") || planned.at("role") != touch.value("role", "fit"))
        return false;
      for (std::size_t joint = 0; joint < 6; ++joint) {
        const double aimed_deg = touch.at("joints_deg")[joint], planned_deg = planned.at("joints_deg")[joint];
        if (std::abs(aimed_deg - planned_deg) > kReaimedDegMax) return false;
      }
      return true;
    };
    const auto found = std::ranges::find_if(due, is_it);
    ASSERT_NE(found, due.end()) << "not in the plan: " << touch;
    due.erase(found);
  }
  EXPECT_TRUE(due.empty());
}

}  // namespace
}  // namespace touchcal::testing
