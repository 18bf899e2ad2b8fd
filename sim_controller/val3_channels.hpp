#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sim {

/// A socket or a serial port as a VAL3 program sees it, with its other end in memory: who serves the real one
/// fills and empties it. One peer at a time.
class Val3Channel {
 public:
  explicit Val3Channel(std::string link);

  [[nodiscard]] const std::string& link() const { return link_; }
  /// Else a serial port: always active, and its cable is always there.
  [[nodiscard]] bool is_socket() const { return is_socket_; }
  /// A socket of s8 for datagrams. Its peer in memory is as that of any other.
  [[nodiscard]] bool is_udp() const { return link_.starts_with("UdpSocket\\"); }

  // ---- the program's end ----
  /// Makes it active; true when a peer is there.
  bool connect();
  [[nodiscard]] std::size_t waiting() const { return in_.size(); }
  std::size_t receive(std::span<std::uint8_t> bytes);
  std::size_t send(std::span<const std::uint8_t> bytes);
  /// Drops what was read and ends the connection; false where there was none.
  bool close();
  /// As sioCtrl answers (manual 6, page 64). More than one of `clients` is refused: one peer at a time.
  int set(std::string_view name, std::optional<double> number, std::optional<bool> truth,
          const std::string* text);
  [[nodiscard]] double timeout_s() const { return timeout_s_; }
  [[nodiscard]] std::uint8_t end_of_string() const { return end_of_string_; }

  // ---- the other end ----
  enum class Peer {
    kNone,
    kConnected,
    kGone,  // the other end closed; the program has to close too before another one can connect
  };
  [[nodiscard]] Peer peer() const { return peer_; }
  /// A program has used it: a server listens, a client asks for its connection.
  [[nodiscard]] bool is_active() const { return is_active_; }
  /// Whether the program has asked for a peer since the last call, and there is none: what a client connects
  /// for.
  bool take_request() { return std::exchange(is_requested_, false); }
  [[nodiscard]] bool is_client() const { return !target_.empty(); }
  [[nodiscard]] const std::string& target() const { return target_; }
  [[nodiscard]] std::optional<std::uint16_t> port() const { return port_; }
  [[nodiscard]] bool nagle() const { return nagle_; }

  /// A peer connects. False while there is one, or one that is gone still holds the socket.
  bool accept();
  /// What the peer wrote; returns how many bytes there was room for.
  std::size_t give(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::size_t room() const { return kBufferedMax - in_.size(); }
  /// What the program wrote since.
  std::vector<std::uint8_t> take();
  /// The peer closed. What it wrote before can still be read.
  void leave();

  /// Bytes under way in each direction; what a program writes beyond them is not sent.
  static constexpr std::size_t kBufferedMax = 65'536;

 private:
  std::string link_;
  bool is_socket_ = true;
  bool is_active_ = false;
  bool is_requested_ = false;
  Peer peer_ = Peer::kNone;
  std::deque<std::uint8_t> in_;
  std::vector<std::uint8_t> out_;
  double timeout_s_ = 5.0;  // of a new socket on the pendant
  std::uint8_t end_of_string_ = 13;
  bool nagle_ = true;
  std::string target_;
  std::optional<std::uint16_t> port_;
};

/// All channels of a controller, by link. Any link that is asked for is there.
class Val3Channels {
 public:
  /// Nothing for an empty link, and beyond kChannelsMax.
  std::optional<int> find(std::string_view link);
  /// One that was found before, by its link or by what stands behind its "\"; nothing when there is none, or
  /// several end so.
  [[nodiscard]] std::optional<int> known(std::string_view name) const;
  [[nodiscard]] Val3Channel& at(int id) { return channels_.at(static_cast<std::size_t>(id)); }
  [[nodiscard]] const Val3Channel& at(int id) const { return channels_.at(static_cast<std::size_t>(id)); }
  [[nodiscard]] int count() const { return static_cast<int>(channels_.size()); }

  static constexpr std::size_t kChannelsMax = 1'000;

 private:
  std::deque<Val3Channel> channels_;
  std::map<std::string, int, std::less<>> ids_;
};

}  // namespace sim
