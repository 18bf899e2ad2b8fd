// Power, mode, emergency stop, monitor speed, versions (manual 6, pages 101 to 105).
#include "sim_controller/val3/machine/builtins.hpp"

namespace val3 {

void define_panel(Builtins& list) {
  list.define<Nothing>("enablePower", [](Context& c) {
    c.system.enable_power();
    return Nothing{};
  });
  list.define<Nothing>("disablePower", [](Context& c) {
    if (c.system.is_powered()) c.system.disable_power();
    if (c.system.is_powered()) throw Wait{};
    return Nothing{};
  });
  list.define<bool>("isPowered", [](Context& c) { return c.system.is_powered(); });
  list.define<bool>("isCalibrated", [](Context& c) { return c.system.is_calibrated(); });
  list.define<double>("workingMode", [](Context& c) { return static_cast<double>(c.system.working_mode()); });
  list.define<double, Out<double>>("workingMode", [](Context& c, const Out<double>& status) {
    status.value() = static_cast<double>(c.system.mode_status());
    return static_cast<double>(c.system.working_mode());
  });
  list.define<double>("esStatus", [](Context& c) { return static_cast<double>(c.system.emergency_stop()); });
  list.define<double>("speedScale", [](Context& c) { return c.system.monitor_speed(); });
  list.define<double>("getMonitorSpeed", [](Context& c) { return c.system.monitor_speed(); });
  list.define<double, double>("setMonitorSpeed", [](Context& c, double percent) {
    return static_cast<double>(c.system.set_monitor_speed(percent));
  });
  list.define<std::string, std::string>(
      "getVersion", [](Context& c, const std::string& item) { return c.system.version(item); });
}

}  // namespace val3
