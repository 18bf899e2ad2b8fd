#include "sim_controller/val3/machine/run_error.hpp"

#include <algorithm>
#include <array>

namespace val3 {
namespace {

struct ErrorText {
  int number;
  std::string_view text;
};

/// The errors of the language reference, 2.8, in our words: a controller's own texts are its maker's.
constexpr std::array kErrorTexts{
    ErrorText{-1, "there is no such task"},
    ErrorText{0, "stopped without an error"},
    ErrorText{1, "running"},
    ErrorText{10, "division by zero"},
    ErrorText{11, "invalid argument of a calculation"},
    ErrorText{20, "index beyond the size of an array"},
    ErrorText{21, "negative index of an array"},
    ErrorText{29, "invalid name of a task"},
    ErrorText{30, "no task of this name"},
    ErrorText{31, "a task of this name exists already"},
    ErrorText{32, "more than two different periods of synchronous tasks"},
    ErrorText{40, "data memory is exhausted"},
    ErrorText{41, "run memory is exhausted"},
    ErrorText{50, "the name is used already"},
    ErrorText{60, "an instruction took longer than its time-out"},
    ErrorText{61, "fault of the interpreter"},
    ErrorText{70, "invalid parameter of an instruction"},
    ErrorText{80, "data or program of a library that is not loaded"},
    ErrorText{81, "data of another kind of arm"},
    ErrorText{82, "the father is in a library out of sight"},
    ErrorText{90, "no line there to resume at"},
    ErrorText{100, "vel of a motion descriptor is negative or too high"},
    ErrorText{101, "accel of a motion descriptor is negative or too high"},
    ErrorText{102, "decel of a motion descriptor is negative, too high or below vel"},
    ErrorText{103, "tvel of a motion descriptor is negative or too high"},
    ErrorText{104, "rvel of a motion descriptor is negative or too high"},
    ErrorText{105, "reach of a motion descriptor is negative"},
    ErrorText{106, "leave of a motion descriptor is negative"},
    ErrorText{122, "an input cannot be written"},
    ErrorText{123, "an input, output or channel that is not linked"},
    ErrorText{124, "a protected input or output of the system"},
    ErrorText{125, "an input, output or channel does not answer"},
    ErrorText{150, "an earlier move could not be completed"},
    ErrorText{153, "the move is not supported"},
    ErrorText{154, "invalid point or motion descriptor of a move"},
    ErrorText{160, "the coordinates of flange were changed"},
    ErrorText{161, "the coordinates of world were changed"},
    ErrorText{162, "a point without a frame"},
    ErrorText{163, "a frame without a father"},
    ErrorText{164, "a tool without a father"},
    ErrorText{165, "a global variable is linked to a local one"},
    ErrorText{170, "an invalid chain of moving frames"},
    ErrorText{171, "the frame does not move"},
    ErrorText{200, "an Ethernet connection failed"},
    ErrorText{250, "no licence, or its time is over"},
    ErrorText{270, "invalid path of a file"},
    ErrorText{271, "a file cannot be read"},
    ErrorText{290, "invalid number of a trajectory"},
    ErrorText{999, "the cause is in the log of events"},
};

}  // namespace

std::string_view run_error_text(int number) {
  const auto found = std::ranges::find(kErrorTexts, number, &ErrorText::number);
  return found == kErrorTexts.end() ? "unknown error" : found->text;
}

}  // namespace val3
