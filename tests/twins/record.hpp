#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "cs8_protocol/messages.hpp"

namespace twins {

/// The controller closed the connection.
struct Closed {};
/// What the harness saw happen: a refused connection, a wait that ended without its message.
struct Noted {
  std::string what;
};

struct Entry {
  double at_s = 0.0;  // simulated, from the start
  std::variant<cs8::Message, Closed, Noted> what;
};

/// All that a host sees of a controller in one scenario, and where the arm stands at the end.
struct Record {
  std::vector<Entry> entries;  // without State
  struct SeenState {
    double at_s = 0.0;
    cs8::State state;
  };
  std::vector<SeenState> states;
  std::vector<double> trips_s;       // when an input of the probe left "free"
  cs8::JointsMicrodeg joints{};      // commanded, at the end
  std::vector<std::string> unfired;  // cabinet moments that never came
};

/// One number of a message by its name in PROTOCOL.md.
struct Field {
  std::string name;
  std::int64_t value = 0;
};
std::vector<Field> fields_of(const cs8::Message& message);
/// "3.412 touch_result 2 outcome=1 ..."
std::string text_of(const Entry& entry);

}  // namespace twins
