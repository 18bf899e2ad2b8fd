#include "config/serial_number.hpp"

namespace cell {

std::optional<std::string> serial_number(const std::optional<JsonValue>& value) {
  if (!value) return std::nullopt;
  std::string serial = value->text();
  if (serial.size() > kSerialNumberSizeMax) {
    value->fail("has " + std::to_string(serial.size()) + " bytes; give a serial number of at most " +
                std::to_string(kSerialNumberSizeMax));
  }
  if (serial.front() == ' ' || serial.back() == ' ')
    value->fail("begins or ends with a space; remove it, a serial number is compared byte for byte");
  return serial;
}

}  // namespace cell
