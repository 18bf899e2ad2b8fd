#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "service/run/status.hpp"

namespace cell {

struct CellFigures;

/// Metrics in the Prometheus text format (GET /metrics): names begin with touchcal_, base units. Only the
/// core of prometheus-cpp: its own HTTP server would be a second port without our access rules.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// `method` and `route` as declared, which bounds the number of labels; their text must outlive this. Both
  /// empty for a refusal.
  void count_request(std::string_view method, std::string_view route, unsigned status);
  /// An answer that could not be made: a database that is damaged. Those of status 500 are counted by
  /// themselves. From any thread.
  void count_internal_error();
  /// Call it at each change of the status: counts touches, and faults by code.
  void follow(const Status& status);
  /// What is stored, as it was read last: no call of this class reads it itself.
  void take(const CellFigures& figures);
  /// The present metrics; `now` is that of the cell's clock.
  [[nodiscard]] std::string text(const Status& status, std::chrono::system_clock::time_point now);

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace cell
