#pragma once

#include <boost/asio/awaitable.hpp>

#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/wake.hpp"

namespace cell {

/// The way back from a face where a stop or an abort has left the arm, in RESETTING. Only a person's reset
/// asks for it: the start of a daemon and a link that is found again pass RESETTING too, and move nothing. It
/// has a permit for itself, so that the key at the cell comes first.
class WayBack {
 public:
  /// All must outlive it.
  WayBack(ControllerSession& session, PublishedStatus& status, Wake& wake);

  /// A person gave reset. It counts until another state is entered or the way back begins.
  void ask() { is_asked_ = true; }
  [[nodiscard]] bool is_asked() const { return is_asked_; }
  void on_entered(State state);

  /// From the request for the permit until the arm is back; a stop then goes through STOPPING.
  [[nodiscard]] bool is_under_way() const { return is_under_way_; }
  /// Obtains the permit, takes the arm back and returns the permit; RESETTING stays. Where that fails, a
  /// fault or a command has entered another state. A permit that a person makes needless by jogging is asked
  /// for no longer.
  boost::asio::awaitable<void> make();

 private:
  ControllerSession& session_;
  PublishedStatus& status_;
  Wake& wake_;
  bool is_asked_ = false;
  bool is_under_way_ = false;
};

}  // namespace cell
