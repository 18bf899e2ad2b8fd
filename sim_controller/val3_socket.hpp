#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "sim_controller/run_socket.hpp"

namespace sim {

class Val3Channel;

/// A socket that cannot be had: the port is taken, the host has no address. Says which one, and the remedy.
class SocketRefusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A real TCP socket at the other end of a VAL3 application's channel. A program sees its channels change
/// between two ticks and never within one, so that is when bytes go over, without waiting; nothing runs in
/// between.
///
/// A server listens from the first time that the program uses the channel. One client at a time: a second one
/// is turned away while the first is there. When the first has gone and the program has not closed the
/// channel yet, one client waits for that. A client connects when the program uses the channel, and tries
/// again as long as it does.
///
/// A peer that ends its sending has left when the program has read what came before, one tick later: it still
/// gets an answer that the program writes at once. Bytes that the program has not read stay with the peer's
/// TCP beyond Val3Channel::kBufferedMax; of those that a peer does not read there are at most twice as many.
class Val3Socket {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  /// One line for people, of what happens at the socket.
  using Tell = std::function<void(const std::string&)>;

  virtual ~Val3Socket() = default;
  Val3Socket(const Val3Socket&) = delete;
  Val3Socket& operator=(const Val3Socket&) = delete;

  /// Carries what there is, both ways. SocketRefusal when a server cannot listen.
  virtual void exchange(TimePoint now) = 0;
  /// The run is over: nobody connects any more, and the connection ends when what the program wrote has gone
  /// out; exchange() does it, within kEndMax.
  virtual void end(TimePoint now) = 0;
  /// Connections are open, or have not quite ended.
  [[nodiscard]] virtual bool is_open() const = 0;
  /// Where it is and what went over it, in a sentence.
  [[nodiscard]] virtual std::string summary() const = 0;
  /// Of a server the port that it has; of a client that of its peer.
  [[nodiscard]] virtual std::uint16_t port() const = 0;

  /// How long a connection that was closed here is still read, so that the last bytes are not lost to a
  /// reset.
  static constexpr std::chrono::milliseconds kEndMax{500};
  /// From a connection that was refused to the next try.
  static constexpr std::chrono::milliseconds kConnectAgain{100};

 protected:
  Val3Socket() = default;
};

/// Takes the port at once, or looks up the host: SocketRefusal. Channel and io_context outlive the socket; a
/// client's attempts to connect proceed while the io_context runs.
std::unique_ptr<Val3Socket> open_socket(boost::asio::io_context& io, Val3Channel& channel,
                                        const RunSocket& at, Val3Socket::Tell tell);

}  // namespace sim
