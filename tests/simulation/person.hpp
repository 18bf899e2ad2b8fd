#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/acquisition/cell_operation.hpp"
#include "sim_controller/server.hpp"
#include "tests/simulation/chance.hpp"
#include "tests/simulation/journal.hpp"

namespace simulation {

/// Begun by one person at most, so that each world ends.
inline constexpr int kRunsMax = 3;

/// Who stands at the cell and reads the page: takes away what keeps the arm from moving, some time after it
/// came, and gives the command that the state asks for. What he does unasked at the cabinet (power, touch
/// test, confirmation) is the simulated operator's.
class Person {
 public:
  /// All must outlive it. `start` asks for a run.
  Person(std::uint64_t seed, sim::Server& controller, Journal& journal, std::function<void()> start)
      : chance_(seed), controller_(controller), journal_(journal), start_(std::move(start)) {}

  /// Looks at the page and at the cell; to be called at next_look().
  void look(cell::CellOperation& operation, Time now);
  [[nodiscard]] Time next_look() const { return next_look_; }
  /// Nobody serves the page.
  void wait(Time now) { next_look_ = now + std::chrono::seconds(1); }
  /// The last run that he wanted is over.
  [[nodiscard]] bool is_done() const { return is_done_; }
  void on_started() {
    ++started_count_;
    given_.push_back(cell::Command::kStart);
  }
  /// From now on he does what the next step of a fault says, in its order, and nothing of his own.
  void go_by_words() { goes_by_words_ = true; }
  /// The commands that he gave; a start counts when it was taken, whoever gave it.
  [[nodiscard]] const std::vector<cell::Command>& given() const { return given_; }

 private:
  void act(const std::string& line);
  /// Takes away one thing that keeps the arm from moving; false when there is none.
  bool mend_one(cell::State state);
  void answer_hold(cell::CellOperation& operation);
  void act_by_words(std::string_view text);
  void answer_by_words(cell::CellOperation& operation);
  void command(cell::CellOperation& operation, cell::Command command);
  void go_on(cell::CellOperation& operation);

  Chance chance_;
  sim::Server& controller_;
  Journal& journal_;
  std::function<void()> start_;
  Time next_look_{0};
  std::optional<Time> mends_at_;
  std::optional<cell::State> seen_;  // at the last look
  std::optional<Time> answers_at_;
  int started_count_ = 0;
  int holds_count_ = 0;            // of this run
  bool switched_on_ = false;       // the power, since it was there
  bool looked_at_stylus_ = false;  // last, since it was free
  bool is_done_ = false;
  bool goes_by_words_ = false;
  std::vector<cell::Command> given_;
};

/// The commands that a text of the fault table names as "touchcal ...", in their order.
std::vector<cell::Command> commands_named(std::string_view text);

}  // namespace simulation
