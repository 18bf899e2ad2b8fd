#include "sim_controller/run_script.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "sim_controller/run_socket.hpp"

namespace sim {
namespace {

using Kind = ScriptAct::Kind;

/// What follows a command's name.
enum class Shape {
  kNothing,
  kSwitch,
  kWord,
  kNumber,
  kName,
  kNameSwitch,
  kNameNumber,
  kNameText,
  kNamePlace
};

struct ScriptCommand {
  std::string_view name;
  Kind kind;
  Shape shape;
  std::string_view usage;
};

constexpr std::array kCommands{
    ScriptCommand{"card", Kind::kCard, Shape::kName, "card NAME"},
    ScriptCommand{"input", Kind::kInput, Shape::kNameSwitch, "input LINK on|off"},
    ScriptCommand{"analogue", Kind::kAnalogue, Shape::kNameNumber, "analogue LINK VALUE"},
    ScriptCommand{"power", Kind::kPower, Shape::kSwitch, "power on|off"},
    ScriptCommand{"mode", Kind::kMode, Shape::kWord, "mode manual|test|local|remote"},
    ScriptCommand{"hold", Kind::kHold, Shape::kSwitch, "hold on|off"},
    ScriptCommand{"estop", Kind::kEmergency, Shape::kWord, "estop press|release|acknowledge"},
    ScriptCommand{"speed", Kind::kSpeed, Shape::kNumber, "speed PERCENT"},
    ScriptCommand{"key", Kind::kKey, Shape::kNumber, "key CODE"},
    ScriptCommand{"connect", Kind::kConnect, Shape::kName, "connect SOCKET"},
    ScriptCommand{"disconnect", Kind::kDisconnect, Shape::kName, "disconnect SOCKET"},
    ScriptCommand{"send", Kind::kSend, Shape::kNameText, "send SOCKET \"TEXT\""},
    ScriptCommand{"socket", Kind::kSocket, Shape::kNamePlace, "socket SOCKET PORT|HOST:PORT"},
    ScriptCommand{"expect-output", Kind::kExpectOutput, Shape::kNameSwitch, "expect-output LINK on|off"},
    ScriptCommand{"expect-number", Kind::kExpectNumber, Shape::kNameNumber, "expect-number VARIABLE VALUE"},
    ScriptCommand{"expect-sent", Kind::kExpectSent, Shape::kNameText, "expect-sent SOCKET \"TEXT\""},
    ScriptCommand{"expect-task", Kind::kExpectTask, Shape::kNameNumber, "expect-task NAME STATUS"},
    ScriptCommand{"page", Kind::kPage, Shape::kNothing, "page"},
    ScriptCommand{"stop", Kind::kStop, Shape::kNothing, "stop"},
    ScriptCommand{"end", Kind::kEnd, Shape::kNothing, "end"},
};

struct ScriptWord {
  std::string_view word;
  Kind kind;
  double number;
};
constexpr std::array kWords{
    ScriptWord{"manual", Kind::kMode, 1.0},
    ScriptWord{"test", Kind::kMode, 2.0},
    ScriptWord{"local", Kind::kMode, 3.0},
    ScriptWord{"remote", Kind::kMode, 4.0},
    ScriptWord{"press", Kind::kEmergency, 2.0},
    ScriptWord{"release", Kind::kEmergency, 1.0},
    ScriptWord{"acknowledge", Kind::kEmergency, 0.0},
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// The word in front, which is removed.
std::string_view take_word(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
  const std::string_view word = rest.substr(0, end);
  rest = trimmed(rest.substr(end));
  return word;
}

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// A text in double quotes, with \n \r \t \" \\ and \xHH.
std::optional<std::string> quoted(std::string_view text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') return std::nullopt;
    if (text[i] != '\\') {
      result += text[i];
      continue;
    }
    if (++i == text.size()) return std::nullopt;
    constexpr std::string_view kNames = "nrt\"\\";
    constexpr std::string_view kMeanings = "\n\r\t\"\\";
    if (const std::size_t at = kNames.find(text[i]); at != std::string_view::npos) {
      result += kMeanings[at];
      continue;
    }
    unsigned byte = 0;
    if (text[i] != 'x' || i + 2 >= text.size()) return std::nullopt;
    const auto [end, error] = std::from_chars(text.data() + i + 1, text.data() + i + 3, byte, 16);
    if (error != std::errc{} || end != text.data() + i + 3) return std::nullopt;
    result += static_cast<char>(byte);
    i += 2;
  }
  return result;
}

bool read_switch(std::string_view word, ScriptAct& act) {
  act.on = word == "on";
  return act.on || word == "off";
}

bool read_number(std::string_view word, ScriptAct& act) {
  constexpr double kSpeedMax = 100.0, kKeyMax = 65'535.0;
  const auto number = number_in(word);
  act.number = number.value_or(0.0);
  if (!number) return false;
  if (act.kind == Kind::kSpeed) return *number >= 0.0 && *number <= kSpeedMax;
  if (act.kind == Kind::kKey) return *number >= 0.0 && *number <= kKeyMax && *number == std::floor(*number);
  return true;
}

bool read_word_of(std::string_view word, ScriptAct& act) {
  for (const ScriptWord& known : kWords) {
    if (known.kind != act.kind || known.word != word) continue;
    act.number = known.number;
    return true;
  }
  return false;
}

/// Whether what follows the command is as its shape wants it.
bool read_arguments(Shape shape, std::string_view rest, ScriptAct& act) {
  const bool named = shape == Shape::kName || shape == Shape::kNameSwitch || shape == Shape::kNameNumber ||
                     shape == Shape::kNameText || shape == Shape::kNamePlace;
  if (named) {
    act.name = std::string(take_word(rest));
    if (act.name.empty()) return false;
  }
  switch (shape) {
    case Shape::kNothing:
    case Shape::kName:
      return rest.empty();
    case Shape::kSwitch:
    case Shape::kNameSwitch:
      return read_switch(rest, act);
    case Shape::kWord:
      return read_word_of(rest, act);
    case Shape::kNumber:
    case Shape::kNameNumber:
      return read_number(rest, act);
    case Shape::kNameText: {
      auto text = quoted(rest);
      if (text) act.text = *std::move(text);
      return text.has_value();
    }
    case Shape::kNamePlace:
      act.text = std::string(rest);
      return run_socket_at(act.name, act.text).has_value();
  }
  return false;
}

std::string all_usages() {
  std::string all;
  for (const ScriptCommand& command : kCommands)
    all += (all.empty() ? "" : ", ") + std::string(command.usage);
  return all;
}

std::variant<ScriptStep, ScriptError> parse_step(std::string_view text, int line) {
  ScriptStep step{.line = line};
  const std::string_view time = take_word(text);
  const auto at_s = number_in(time);
  if (!at_s || *at_s < 0.0 || *at_s > kScriptSecondsMax)
    return ScriptError{line,
                       "'" + std::string(time) + "' is no time: a line begins with seconds from 0 to 86400"};
  step.at_s = *at_s;
  const std::string_view name = take_word(text);
  for (const ScriptCommand& command : kCommands) {
    if (command.name != name) continue;
    step.act.kind = command.kind;
    if (command.kind == Kind::kSocket && step.at_s != 0.0)
      return ScriptError{line, "a real socket is there from the start; begin its line with 0"};
    if (command.kind == Kind::kCard && step.at_s != 0.0)
      return ScriptError{line, "a card is there from the start; begin its line with 0"};
    if (read_arguments(command.shape, text, step.act)) return step;
    return ScriptError{line, "write '" + std::string(command.usage) + "'"};
  }
  return ScriptError{line, "'" + std::string(name) + "' is no command; there are: " + all_usages()};
}

}  // namespace

std::variant<std::vector<ScriptStep>, ScriptError> parse_script(std::string_view text) {
  if (text.size() > kScriptBytesMax) return ScriptError{0, "a script of more than 1 MiB; make it shorter"};
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<ScriptStep> steps;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view content = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (content.empty() || content.front() == '#') continue;
    auto step = parse_step(content, line);
    if (auto* error = std::get_if<ScriptError>(&step)) return std::move(*error);
    ScriptStep& read = std::get<ScriptStep>(step);
    if (!steps.empty() && read.at_s < steps.back().at_s)
      return ScriptError{line, "its time is before that of the line above; put the lines in order of time"};
    steps.push_back(std::move(read));
  }
  return steps;
}

}  // namespace sim
