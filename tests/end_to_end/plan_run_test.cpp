// The plan that was shown is the plan that runs.
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <nlohmann/json.hpp>

#include "service/http/routes.hpp"
#include "tests/end_to_end/loopback_cell.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;

TEST(PlanRun, MakesTheTouchesOfThePlanThatWasShownInItsOrder) {
  LoopbackCell loop("demo");
  loop.serve();
  loop.launch();
  loop.run_until(cell::State::kIdle);
  boost::asio::co_spawn(loop.io(), loop.operation().plan_recipe(kShortRecipe), boost::asio::detached);
  while (!loop.operation().planned(kShortRecipe)) loop.io().run_one();

  const cell::Tokens tokens{"operate", "view"};
  const auto send = [&](const std::string& method, const std::string& path, const std::string& body) {
    return cell::route({.method = method,
                        .path = "/api/v1/" + path,
                        .authorization = "Bearer operate",
                        .content_type = "application/json",
                        .body = body},
                       loop.operation(), tokens);
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
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(made[i].at("plane"), plan.at("touches")[i].at("plane")) << i;
    EXPECT_EQ(made[i].value("role", "fit"), plan.at("touches")[i].at("role")) << i;
  }
}

}  // namespace
}  // namespace touchcal::testing
