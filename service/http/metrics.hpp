#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "service/acquisition/status.hpp"

namespace cell {

/// What a monitoring system scrapes (GET /metrics): Prometheus text, names that begin with touchcal_, base
/// units. Of prometheus-cpp the core only: its own HTTP server would be a second port without our access
/// rules.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// `method` and `route` as they are declared (their text must stay), so that there are as many labels as
  /// routes; both empty for a refusal.
  void count_request(std::string_view method, std::string_view route, unsigned status);
  /// At each change of the status: counts touches, and faults by their code.
  void follow(const Status& status);
  /// The figures now.
  [[nodiscard]] std::string text(const Status& status);

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace cell
