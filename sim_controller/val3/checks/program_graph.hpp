#pragma once

#include <cstddef>
#include <functional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "sim_controller/val3/checks/quiet_channels.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What a channel that was told not to wait is taken for. Using it lets the other asynchronous tasks have
/// their turns; a synchronous task goes on without a pause.
enum class QuietChannel { kIsAWait, kIsNone };

/// Every program of an application and of its libraries, and which calls which.
class ProgramGraph {
 public:
  struct Node {
    const Application* application = nullptr;
    const Program* program = nullptr;
    std::vector<std::size_t> calls;  // nodes, by `call`
    bool calls_unknown = false;      // a program of a library that is not there
    // In itself or in what it calls, so far as that is known.
    bool waits = false;                        // QuietChannel::kIsNone
    bool waits_or_asks = false;                // QuietChannel::kIsAWait
    bool is_of_synchronous = false;            // some synchronous task reaches it
    std::unordered_set<const Global*> writes;  // by itself, also where it passes them by reference
  };

  explicit ProgramGraph(const Application& application);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Of the program that a line calls or makes a task of; null when it is not there.
  [[nodiscard]] const Node* called(const Application& application, const Line& line) const;
  [[nodiscard]] const Node* node_of(const Program& program) const;
  /// The nodes that `from` reaches by calls, itself first.
  [[nodiscard]] std::vector<const Node*> reached(const Node& from) const;
  /// Some of these programs, or what they call, assigns to it.
  [[nodiscard]] bool writes(const Node& from, const Global& global) const;
  /// Some program assigns to it.
  [[nodiscard]] bool is_written(const Global& global) const { return written_.contains(&global); }
  /// The task may let others run in this line: it waits, or uses a channel, or calls what does or is unknown.
  [[nodiscard]] bool waits(const Application& application, const Line& line, QuietChannel quiet) const;
  /// The same without what it calls.
  [[nodiscard]] bool waits_itself(const Application& application, const Line& line, QuietChannel quiet) const;
  [[nodiscard]] const QuietChannels& quiet_channels() const { return quiet_; }

 private:
  void add(const Application& application, std::unordered_set<const Application*>& seen);
  void fill(Node& node);
  void spread(bool Node::*waits);
  void find_synchronous();

  std::vector<Node> nodes_;
  std::unordered_map<const Program*, std::size_t> places_;
  std::unordered_set<const Global*> written_;
  QuietChannels quiet_;
};

/// The global that a name stands for; null when it stands for something else.
const Global* global_of(const Application& application, const Expression& name);
/// Reads or writes a socket or serial port by `=`.
bool uses_channel(const Line& line);

}  // namespace val3
