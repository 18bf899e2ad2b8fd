#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace sim {

class ServedController;

/// Bounds of the control connections.
inline constexpr std::size_t kControlConnectionsMax = 8;

/// What to do with one line and what to answer, one line too, both without their line break.
using ControlHandler = std::function<std::string(std::string_view)>;

/// A TCP port on which people and tests change what happens at the simulated cell while it runs: lines of
/// JSON, one answer each (config/FILES.md). A line that is too long is answered and ends its connection, one
/// connection too many gets an answer that says so. On the io_context's one thread; lives as long as this
/// object.
class Control {
 public:
  /// Listens at once; port 0 takes a free one. boost::system::system_error when the address cannot be had.
  Control(boost::asio::io_context& io, const std::string& host, std::uint16_t port, ControlHandler handler);
  ~Control();
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  void stop();

 private:
  class Core;
  std::shared_ptr<Core> core_;
};

/// Does what the line says to the simulated controller. Whatever is in the line, this returns an answer.
std::string answer_control_line(ServedController& target, std::string_view line);

}  // namespace sim
