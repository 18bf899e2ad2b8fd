#pragma once

#include <unordered_set>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// Which channels sioCtrl(channel,"timeout",-1) was written for: they do not wait (s7).
class QuietChannels {
 public:
  /// Looks at one expression of a program of `application`.
  void add(const Application& application, const Expression& e);

  /// Some line tells it so; of a channel that is no global, that any line tells any channel.
  [[nodiscard]] bool contains(const Application& application, const Expression& channel) const;
  /// A line tells it so, and none gives it another time-out.
  [[nodiscard]] bool surely_contains(const Application& application, const Expression& channel) const;

 private:
  bool any_ = false;
  std::unordered_set<const Global*> quiet_;
  std::unordered_set<const Global*> with_time_;
};

}  // namespace val3
