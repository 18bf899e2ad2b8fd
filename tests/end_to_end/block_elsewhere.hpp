#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>
#include <utility>

#include "config/moved_cell.hpp"
#include "service/acquisition/locating.hpp"
#include "tests/end_to_end/pendant.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {

/// A cell whose block stands somewhere else than its file says, and a person who finds it by hand.
class BlockElsewhere : public ::testing::Test {
 protected:
  explicit BlockElsewhere(std::string name = "edf") : name_(std::move(name)), loop_(name_) {}
  void serve_block_at(const Eigen::Isometry3d& place) {
    there_ = cell::with_block_moved(loop_.cell, place);
    plant_ = sim::make_plant(there_, shipped_truth(name_));
    loop_.serve(plant_, {.controller = {.speed = sim::kSpeedMax}, .faults = {}});
  }
  void move_block(const Eigen::Isometry3d& place) {
    loop_.stop_serving();
    loop_.run_until(cell::State::kResetting);
    serve_block_at(place);
    loop_.run_until(cell::State::kIdle);
  }
  void launch() {
    loop_.place_file = folder_ / "place.json";
    loop_.launch();
    loop_.run_until(cell::State::kIdle);
  }
  /// A touch is taken when it is on the disk, which another thread does.
  void touch(Pendant& pendant, const cell::PlaceSpot& spot) {
    const auto before = loop_.status().by_hand;
    pendant.touch(spot.face, spot.point_m);
    loop_.run_until([&before](const cell::Status& status) { return status.by_hand != before; });
  }
  void locate_by_hand() {
    loop_.command(cell::Command::kLocate);
    Pendant pendant(loop_, there_, plant_);
    pendant.take_over();
    for (const cell::PlaceSpot& spot : cell::place_spots(loop_.cell)) {
      const auto before = loop_.status().by_hand;
      ASSERT_TRUE(before);
      EXPECT_EQ(before->plane, spot.face + 1);
      EXPECT_EQ(before->step, cell::HandStep::kTouch);
      touch(pendant, spot);
      ASSERT_TRUE(loop_.status().by_hand);
      EXPECT_FALSE(loop_.status().by_hand->problem) << *loop_.status().by_hand->problem;
      EXPECT_NE(loop_.status().by_hand->words, before->words);
    }
    EXPECT_EQ(loop_.status().by_hand->step, cell::HandStep::kPass);
    pendant.hand_back();
  }
  void go_around() {
    loop_.command(cell::Command::kLocate);
    EXPECT_EQ(loop_.status().state, cell::State::kStarting);
    EXPECT_EQ(loop_.status().by_hand->step, cell::HandStep::kPassing);
    EXPECT_TRUE(loop_.is_refused(cell::Command::kUndo));
    loop_.run_until([](const cell::Status& status) { return !cell::is_active(status.state); });
  }

  const std::string name_;
  LoopbackCell loop_;
  Folder folder_;
  cell::Cell there_;
  sim::Plant plant_;
};

}  // namespace touchcal::testing
