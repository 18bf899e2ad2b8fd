#include "tests/twins/known_differences.hpp"

#include <algorithm>
#include <array>

namespace twins {
namespace {

constexpr std::array kKnown{
    KnownDifference{
        "", "welcome.session",
        "counts the starts of an application; the application begins where the clock is, behind a loading",
        "PROTOCOL.md 4, welcome"},
    KnownDifference{"", "state.session", "as in Welcome", "PROTOCOL.md 4, state"},
    KnownDifference{"", "welcome.search_length_max_dmm",
                    "each controller has its own limit; a person sets the application's",
                    "PROTOCOL.md 4, welcome"},
    KnownDifference{"", "welcome.search_speed_max_um_s",
                    "as the length: kSearchSpeed of the application is below what the overtravel allows",
                    "PROTOCOL.md 4, welcome"},
    KnownDifference{"field: search too fast", "rejected.detail", "the limit of Welcome",
                    "PROTOCOL.md 9, search_too_fast"},
    KnownDifference{"field: a search too long", "rejected.detail", "the limit of Welcome",
                    "PROTOCOL.md 9, search_too_long"},
    KnownDifference{"probe_bounces", "touch_result.edges",
                    "a program sees an input each 4 ms, and bounces are shorter; FastIO counts none",
                    "manual 6, page 111"},
    KnownDifference{"collision", "touch_result.outcome",
                    "a VAL3 program cannot tell it from power taken away", "PROTOCOL.md 10, collision"},
    KnownDifference{"collision", "permit.reason", "as the outcome", "PROTOCOL.md 7, 5"},
    KnownDifference{"motion_error", "touch_result.error_number",
                    "the error of a move comes with the next move, which never comes: 60",
                    "manual 6, page 150"},
    KnownDifference{"motion_error", "move_result.error_number", "as in a touch", "manual 6, page 150"},
    KnownDifference{"overruns", "state.overruns",
                    "a counted fault of the C++ twin only; a VAL3 application counts its own",
                    "PROTOCOL.md 4, state"},
    KnownDifference{"probe_touched in the", "touch_result.contact",
                    "tripped at an instant and not at a face: where the arm is then its descriptor decides",
                    "manual 6, page 155"},
    KnownDifference{"touch_stylus in the", "touch_result.contact", "as probe_touched", "manual 6, page 155"},
    KnownDifference{"contact_short in the", "touch_result.contact", "as probe_touched", "manual 6, page 155"},
    KnownDifference{"loop_cut in the", "touch_result.contact", "as probe_touched", "manual 6, page 155"},
    KnownDifference{"deadline of", "touch_result.place",
                    "strikes at an instant and not at a place: where the arm is then its descriptor decides",
                    "manual 6, page 155"},
    KnownDifference{"silence in the travel", "touch_result.place",
                    "half a second behind the place at which it begins", "manual 6, page 155"},
    KnownDifference{"silence in the travel", "place", "half a second behind the place at which it begins",
                    "manual 6, page 155"},
    KnownDifference{"silence behind the", "place", "as in the travel", "manual 6, page 155"},
    KnownDifference{"silence in the retract", "place", "as in the travel", "manual 6, page 155"},
    KnownDifference{"collision", "move_result.outcome", "as in a touch", "PROTOCOL.md 10, collision"},
    KnownDifference{"probe_dead", "touch_result.outcome", "the arm goes on into the block: a collision",
                    "PROTOCOL.md 10, collision"},
    KnownDifference{"probe_dead", "permit.reason", "as the outcome", "PROTOCOL.md 7, 5"},
    KnownDifference{"probe_dead", "swapped", "which of both comes first is open", "PROTOCOL.md 7, 5"},
    KnownDifference{"motion_error in the back-off", "touch_result.search_speed_um_s",
                    "an arm that stands near its target has arrived; the next move brings the error, and "
                    "with it a search has begun",
                    "manual 6, page 150"},
    KnownDifference{"jog_home", "order",
                    "nobody jogs an arm home in an instant in which its command still brakes: the C++ twin "
                    "sees the act, the application where the arm stands in manual mode when nothing runs",
                    "PROTOCOL.md 8"},
    KnownDifference{"jog_home", "state.phase", "as the order of messages", "PROTOCOL.md 8"},
    KnownDifference{"jog_home", "state.active_sequence", "as the order of messages", "PROTOCOL.md 8"},
    KnownDifference{"jog_home in the search", "state.settled", "as the order of messages", "PROTOCOL.md 8"},
    KnownDifference{"motion_error", "time.touch_result",
                    "an arm that stands before its target is given 2 s: error 60",
                    "PROTOCOL.md 4, error_number"},
    KnownDifference{"motion_error in a retract", "time.move_result", "as in a touch",
                    "PROTOCOL.md 4, error_number"},
    KnownDifference{
        "drop at hello", "time.closed",
        "the bytes behind a Fault are read for up to 500 ms; of the C++ twin that is the server's",
        "PROTOCOL.md 5"},
    KnownDifference{"before Hello", "time.closed", "as drop at hello", "PROTOCOL.md 5"},
    KnownDifference{"a message of the controller's", "time.closed", "as drop at hello", "PROTOCOL.md 5"},
};

/// What acts on frames acts in the servers, which carry them to and from both twins by the same Connection,
/// alter_message() and alter_frame(); end_to_end_test and link_faults_test have them.
constexpr std::string_view kOfFrames = "acts on frames and sockets in the server";
constexpr std::string_view kOfSent =
    "alters what was sent behind the controller's back, by the same function for both";
constexpr std::array kLeftOut{
    LeftOut{"go_silent", kOfFrames},       LeftOut{"stop_states", kOfFrames},
    LeftOut{"garbage", kOfFrames},         LeftOut{"refuse", kOfFrames},
    LeftOut{"close_mid_frame", kOfFrames}, LeftOut{"byte_by_byte", kOfFrames},
    LeftOut{"merge", kOfFrames},           LeftOut{"wrong_version", kOfFrames},
    LeftOut{"unknown_type", kOfFrames},    LeftOut{"bad_length", kOfFrames},
    LeftOut{"bad_value", kOfFrames},       LeftOut{"wrong_session", kOfSent},
    LeftOut{"wrong_arm", kOfSent},         LeftOut{"wrong_application", kOfSent},
    LeftOut{"wrong_limits", kOfSent},      LeftOut{"stale_result", kOfSent},
    LeftOut{"wrong_joints", kOfSent},
};

}  // namespace

std::span<const KnownDifference> known_differences() { return kKnown; }

const KnownDifference* known(const Scenario& scenario, const Difference& found) {
  const auto* it = std::ranges::find_if(kKnown, [&](const KnownDifference& known) {
    return scenario.name.find(known.scenario) != std::string::npos && found.where.starts_with(known.where);
  });
  return it == kKnown.end() ? nullptr : &*it;
}

std::span<const LeftOut> left_out() { return kLeftOut; }

}  // namespace twins
