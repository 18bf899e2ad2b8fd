#include "service/acquisition/permission_watch.hpp"

#include <gmock/gmock.h>

#include "tests/service/acquisition/scripted_controller.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

cs8::State permitted() {
  cs8::State state = ScriptedController::ready_state();
  state.permit = cs8::PermitState::kGranted;
  return state;
}

TEST(LostPermission, NamesAllThatStandsAgainstMotion) {
  EXPECT_EQ(lost_permission(permitted()), "");
  cs8::State state = permitted();
  state.emergency_stop = 1;
  state.mode = cs8::WorkingMode::kManual;
  state.permit = cs8::PermitState::kNone;
  state.flags = cs8::kHeld;
  const std::string lost = lost_permission(state);
  for (const char* word :
       {"emergency stop", "open cell", "no power", "hold", "references", "manual", "permit"})
    EXPECT_THAT(lost, HasSubstr(word));
}

TEST(PermissionWatch, OneStateIsNotEnoughAndTheAnswerMayComeFirst) {
  PermissionWatch watch;
  const PermissionWatch::TimePoint begin = PermissionWatch::TimePoint{} + 1h;
  cs8::State open = permitted();
  open.flags &= ~static_cast<std::uint32_t>(cs8::kCellClosed);
  watch.on_state(open, begin);
  EXPECT_EQ(watch.told(), "");
  EXPECT_FALSE(watch.fault(begin + 1s));
  watch.on_state(open, begin + 20ms);
  EXPECT_THAT(watch.told(), HasSubstr("open cell"));
  EXPECT_FALSE(watch.fault(begin + PermissionWatch::kAnswerPatience - 1ms));
  EXPECT_EQ(watch.fault(begin + PermissionWatch::kAnswerPatience).value().code, FaultCode::kPermissionLost);
  watch.on_state(permitted(), begin + 600ms);
  EXPECT_FALSE(watch.fault(begin + 1s));
  EXPECT_EQ(watch.told(), "");
}

TEST(PermissionWatch, SilenceIsCountedInHeartbeats) {
  PermissionWatch watch;
  const PermissionWatch::TimePoint now = PermissionWatch::TimePoint{} + 1h;
  for (int i = 1; i < PermissionWatch::kSilentHeartbeatsMax; ++i) watch.on_heartbeat();
  EXPECT_FALSE(watch.fault(now));
  watch.on_state(permitted(), now);
  watch.on_heartbeat();
  EXPECT_FALSE(watch.fault(now));
  for (int i = 1; i < PermissionWatch::kSilentHeartbeatsMax; ++i) watch.on_heartbeat();
  EXPECT_EQ(watch.fault(now).value().code, FaultCode::kStateMissing);
}

}  // namespace
}  // namespace cell
