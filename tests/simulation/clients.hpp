#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/simulation/chance.hpp"
#include "tests/simulation/faults.hpp"
#include "tests/simulation/journal.hpp"
#include "tests/simulation/network.hpp"
#include "tests/simulation/record.hpp"

namespace simulation {

/// Who asks for something at the daemon's HTTP port: supervisors that ask twice with one key, crowds, and
/// those that do not read what they are told. One request a connection; its bytes are real, and so are
/// listener, session and routes at the other end.
class Clients {
 public:
  /// All must outlive it.
  Clients(const VirtualClock& clock, Network& network, Journal& journal, Record& record, std::uint64_t seed)
      : clock_(clock), network_(network), journal_(journal), record_(record), chance_(seed) {}

  /// Does what a fault of the kinds kClients... or kClient... says.
  void begin(const DrawnFault& fault);
  /// Sends and reads what can be sent and read now.
  void go_on();
  /// Whoever is due asks again.
  void ask_again();
  /// When one of them asks again, unasked.
  [[nodiscard]] std::optional<Time> next_due() const;
  /// What is open has not been answered: puts that into the record.
  void end();

 private:
  struct Request {
    std::string line;  // "POST /api/v1/runs"
    std::string key, body;
    bool has_token = false;
  };
  struct Talk {
    int descriptor = 0;
    Request request;
    Time asked_at{};
    std::string unsent, read;
    bool reads = true;
  };

  void ask(const Request& request, int times = 1, bool reads = true);
  void flood(int count);
  void repeat_key(Time again);
  void stop_reading(int count);
  void send(Talk& talk);
  /// True when its answer is whole or will not come any more.
  bool read(Talk& talk);
  void note(const Talk& talk, HttpAnswer::End end);

  const VirtualClock& clock_;
  Network& network_;
  Journal& journal_;
  Record& record_;
  Chance chance_;
  std::vector<Talk> talks_;
  std::multimap<Time, Request> again_;
  int keys_count_ = 0;
  std::vector<std::uint8_t> room_ = std::vector<std::uint8_t>(65'536);
};

}  // namespace simulation
