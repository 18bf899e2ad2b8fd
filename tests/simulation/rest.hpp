#pragma once

#include <optional>
#include <string_view>

#include "service/acquisition/cell_operation.hpp"
#include "tests/simulation/record.hpp"

namespace simulation {

/// Follows a cell in which something went wrong until it comes to rest: nothing changes any more, and
/// whatever goes on waits for a person. Writes down how it stands there and what was told on the way.
class RestWatch {
 public:
  /// `rest` must outlive it.
  explicit RestWatch(RestRecord& rest) : rest_(rest) {}

  /// A sight of the watcher.
  void see(std::string_view sight);
  void on_struck(Time now, const cs8::State& told);
  void on_write() { rest_.next_writes += counts_next() ? 1 : 0; }
  /// At any time; `operation` is null while there is no daemon.
  void look(Time now, const cell::CellOperation* operation, const cs8::State& told);
  /// It is at rest, or does not come to rest in a time that nobody would wait for.
  [[nodiscard]] bool is_over() const { return is_over_; }

 private:
  /// What a person sees of the cell.
  struct View {
    cell::State state{};
    std::optional<std::int64_t> run;
    std::optional<cell::FaultCode> fault, warning;
    std::optional<std::string> waiting_for;
    int touches_done = 0;
    bool operator==(const View&) const = default;
  };

  [[nodiscard]] bool counts_next() const;
  void look_at_arm(Time now, const cs8::State& told);
  void note_view(Time now, const View& view);
  void note_rest(Time now, const cell::CellOperation& operation, const cs8::State& told);

  RestRecord& rest_;
  View view_;
  cs8::JointsMicrodeg joints_{};
  Time quiet_since_{0};
  bool is_over_ = false;
};

}  // namespace simulation
