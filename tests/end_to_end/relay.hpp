#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>

#include "cs8_protocol/messages.hpp"

namespace touchcal::testing {

/// A cable between the daemon and the simulated controller that tells what goes over it, in both directions
/// and before it is passed on, and that can be pulled. It stops when it goes.
class Relay {
 public:
  /// Listens at once on a free port of loopback; passes on to `controller_port`.
  Relay(boost::asio::io_context& io, std::uint16_t controller_port,
        std::function<void(const cs8::Message&)> watch);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Ends the connection on both sides; the next one is served.
  void pull();

 private:
  class Core;
  std::shared_ptr<Core> core_;
};

}  // namespace touchcal::testing
