#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// A script for `cs8sim --run`: what people and the world around a VAL3 application do, and when.
namespace sim {

/// What one line of a script does.
struct ScriptAct {
  enum class Kind {
    kCard,          // name: a card of inputs and outputs that the cell has, from the start
    kInput,         // name: a link; on
    kAnalogue,      // name: a link; number
    kPower,         // on
    kMode,          // number: 1 manual, 2 test, 3 local, 4 remote
    kHold,          // on: the move/hold key
    kEmergency,     // number: 0 acknowledged, 1 released, 2 pressed
    kSpeed,         // number: monitor speed, %
    kKey,           // number: code of a key of the pendant
    kConnect,       // name: a socket; a peer of the script's own connects
    kDisconnect,    // name
    kSend,          // name, text: bytes from that peer
    kSocket,        // name; text: as run_socket_at() takes it. A real socket, from the start
    kExpectOutput,  // name, on
    kExpectNumber,  // name: a variable, "x" or "x[3]"; number
    kExpectSent,    // name, text: what the application has sent to the peer since the last such line
    kExpectTask,    // name, number: as taskStatus
    kPage,          // prints the user page
    kStop,          // the application is stopped at the pendant
    kEnd,           // the run ends
  };
  Kind kind{};
  std::string name;
  std::string text;
  double number = 0.0;
  bool on = false;
};

struct ScriptStep {
  double at_s = 0.0;  // simulated, from the start of the application
  int line = 0;       // of the script
  ScriptAct act;
};

/// Why a script is not taken.
struct ScriptError {
  int line = 0;
  std::string what;  // with the remedy
};

inline constexpr std::size_t kScriptBytesMax = 1U << 20U;
inline constexpr double kScriptSecondsMax = 86'400.0;

/// One step a line: `SECONDS COMMAND ...`, in order of time; `#` begins a comment. See
/// sim_controller/val3/README.md.
std::variant<std::vector<ScriptStep>, ScriptError> parse_script(std::string_view text);

}  // namespace sim
