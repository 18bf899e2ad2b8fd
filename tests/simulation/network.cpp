#include "tests/simulation/network.hpp"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <utility>

namespace simulation {
namespace {

Network* the_network = nullptr;

/// Sent and not yet read; then a sender has to wait.
constexpr std::size_t kUnreadMax = 65'536;

int fails(int error) {
  errno = error;
  return -1;
}

}  // namespace

struct Network::Socket {
  int descriptor = 0;
  Stage stage = Stage::kNew;
  std::uint16_t port = 0;
  bool is_host = false;              // it connected, over the cable
  bool is_client = false;            // it connected, to the host
  bool is_on_cable = false;          // as both ends of a connection are
  int peer = 0;                      // 0: none, or gone
  std::deque<int> waiting;           // of a listener: taken, not accepted
  std::deque<Arrival> under_way;     // to here
  std::vector<std::uint8_t> unread;  // arrived
  bool has_end = false;              // the peer sends no more
  bool sends_no_more = false;
  bool is_cut_off = false;  // half open
  bool waits_to_send = false;
  int error = 0;
  std::optional<Time> connected_at;  // a connection that is being made
};

Network::Network(VirtualClock& clock, std::uint64_t seed) : clock_(clock), chance_(seed) {
  if (the_network != nullptr) throw std::logic_error("two simulated networks at a time");
  the_network = this;
}

Network::~Network() { the_network = nullptr; }

Network* Network::current() { return the_network; }

Network::Socket* Network::find(int descriptor) const {
  const auto found = sockets_.find(descriptor);
  return found == sockets_.end() ? nullptr : found->second.get();
}

// ---- what the network does ----

Time Network::draw_gap() { return std::chrono::microseconds(50 + chance_() % 3000); }

/// Nothing overtakes: what is sent later arrives later, or with it.
void Network::schedule(Socket& to, Arrival arrival) {
  if (to.is_cut_off) return;
  if (!to.under_way.empty()) arrival.due = std::max(arrival.due, to.under_way.back().due);
  to.under_way.push_back(std::move(arrival));
}

void Network::wake(int descriptor) {
  for (auto& [epoll, watched] : epolls_) {
    const auto found = watched.find(descriptor);
    if (found != watched.end()) found->second.is_told = false;
  }
}

void Network::reset(Socket& socket) {
  socket.stage = Stage::kBroken;
  socket.error = ECONNRESET;
  socket.unread.clear();
  socket.under_way.clear();
  if (socket.is_host && on_host_close) on_host_close();
  wake(socket.descriptor);
}

void Network::take(Socket& socket, Arrival arrival) {
  if (arrival.is_reset) return reset(socket);
  if (arrival.is_end) socket.has_end = true;
  if (arrival.is_end && socket.is_host && on_host_close) on_host_close();
  socket.unread.insert(socket.unread.end(), arrival.bytes.begin(), arrival.bytes.end());
  wake(socket.descriptor);
}

bool Network::deliver() {
  bool any = false;
  for (auto& [descriptor, socket] : sockets_) {
    if (socket->connected_at && *socket->connected_at <= clock_.now()) {
      socket->connected_at.reset();
      socket->stage = socket->error == 0 ? Stage::kConnected : Stage::kBroken;
      wake(descriptor);
      any = true;
    }
    while (!socket->under_way.empty() && socket->under_way.front().due <= clock_.now()) {
      Arrival arrival = std::move(socket->under_way.front());
      socket->under_way.pop_front();
      take(*socket, std::move(arrival));
      any = true;
    }
  }
  return any;
}

std::optional<Time> Network::next_due() const {
  std::optional<Time> next;
  const auto consider = [&next](Time due) { next = next ? std::min(*next, due) : due; };
  for (const auto& [descriptor, socket] : sockets_) {
    if (socket->connected_at) consider(*socket->connected_at);
    if (!socket->under_way.empty()) consider(socket->under_way.front().due);
  }
  return next;
}

void Network::cut() {
  for (auto& [descriptor, socket] : sockets_) {
    if (socket->stage != Stage::kConnected || !socket->is_on_cable) continue;
    socket->peer = 0;
    reset(*socket);
  }
}

void Network::half_open() {
  for (auto& [descriptor, socket] : sockets_) {
    if (socket->stage != Stage::kConnected || !socket->is_on_cable) continue;
    socket->is_cut_off = true;
    socket->under_way.clear();
  }
}

void Network::hold_up(Time time) {
  for (auto& [descriptor, socket] : sockets_) {
    if (socket->stage != Stage::kConnected || socket->is_cut_off || !socket->is_on_cable) continue;
    for (Arrival& arrival : socket->under_way) arrival.due += time;
    if (socket->under_way.empty()) socket->under_way.push_back({clock_.now() + time, {}, false, false});
  }
}

// ---- what the programs call ----

int Network::open_socket() {
  auto socket = std::make_unique<Socket>();
  socket->descriptor = next_descriptor_++;
  const int descriptor = socket->descriptor;
  sockets_.emplace(descriptor, std::move(socket));
  return descriptor;
}

int Network::bind(int descriptor, std::uint16_t port) {
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return fails(EBADF);
  socket->port = port != 0 ? port : static_cast<std::uint16_t>(40'000 + descriptor % 10'000);
  return 0;
}

int Network::listen(int descriptor) {
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return fails(EBADF);
  for (const auto& [other_descriptor, other] : sockets_)
    if (other->stage == Stage::kListening && other->port == socket->port) return fails(EADDRINUSE);
  socket->stage = Stage::kListening;
  return 0;
}

int Network::connect(int descriptor, std::uint16_t port) {
  Socket* const host = find(descriptor);
  if (host == nullptr) return fails(EBADF);
  const auto listener = std::ranges::find_if(sockets_, [port](const auto& one) {
    return one.second->stage == Stage::kListening && one.second->port == port;
  });
  host->is_on_cable = is_on_cable(port);
  host->is_host = host->is_on_cable;
  host->is_client = !host->is_on_cable;
  host->port = port;
  host->stage = Stage::kConnecting;
  if (host->is_on_cable && (conditions.swallows || host_is_dead_)) return fails(EINPROGRESS);
  host->connected_at = clock_.now() + 2 * conditions.latency;
  if ((host->is_on_cable && conditions.refuses) || listener == sockets_.end()) {
    host->error = ECONNREFUSED;
    return fails(EINPROGRESS);
  }
  Socket& controller = *find(open_socket());
  controller.stage = Stage::kConnected;
  controller.port = port;
  controller.is_on_cable = host->is_on_cable;
  controller.peer = descriptor;
  host->peer = controller.descriptor;
  listener->second->waiting.push_back(controller.descriptor);
  wake(listener->first);
  return fails(EINPROGRESS);
}

int Network::accept(int descriptor) {
  Socket* const listener = find(descriptor);
  if (listener == nullptr) return fails(EBADF);
  if (listener->waiting.empty()) return fails(EAGAIN);
  const int accepted = listener->waiting.front();
  listener->waiting.pop_front();
  if (on_connection && find(accepted)->is_on_cable) on_connection();
  return accepted;
}

int Network::close(int descriptor) {
  if (epolls_.erase(descriptor) > 0) return 0;
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return fails(EBADF);
  for (const int refused : std::exchange(socket->waiting, {})) close(refused);
  const bool was_up = socket->stage == Stage::kConnected || socket->stage == Stage::kConnecting;
  if (was_up && socket->is_host && on_host_close) on_host_close();
  if (Socket* const peer = find(socket->peer)) {
    // Who closes on unread bytes takes back what the other side has not read yet either.
    const bool resets = !socket->unread.empty();
    peer->peer = 0;
    if (!socket->sends_no_more || resets)
      schedule(*peer, {clock_.now() + conditions.latency, {}, !resets, resets});
  }
  for (auto& [epoll, watched] : epolls_) watched.erase(descriptor);
  sockets_.erase(descriptor);
  return 0;
}

int Network::shutdown_send(int descriptor) {
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return fails(EBADF);
  if (socket->stage != Stage::kConnected) return fails(ENOTCONN);
  socket->sends_no_more = true;
  if (Socket* const peer = find(socket->peer))
    schedule(*peer, {clock_.now() + conditions.latency, {}, true, false});
  return 0;
}

std::int64_t Network::send(int descriptor, std::span<const std::uint8_t> bytes) {
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return fails(EBADF);
  if (socket->stage == Stage::kBroken) return fails(socket->error != 0 ? socket->error : EPIPE);
  if (socket->stage != Stage::kConnected) return fails(ENOTCONN);
  const bool is_of_host = socket->is_on_cable ? socket->is_host : !socket->is_client;
  if (is_of_host && host_is_dead_) return static_cast<std::int64_t>(bytes.size());
  if (socket->sends_no_more) return fails(EPIPE);
  Socket* const peer = find(socket->peer);
  std::size_t waiting = peer ? peer->unread.size() : 0;
  if (peer)
    for (const Arrival& arrival : peer->under_way) waiting += arrival.bytes.size();
  if (waiting >= kUnreadMax) {
    socket->waits_to_send = true;
    return fails(EAGAIN);
  }
  bytes = bytes.first(std::min(bytes.size(), kUnreadMax - waiting));
  if (tap && socket->is_on_cable) tap(socket->is_host, true, bytes);
  if (!peer) return static_cast<std::int64_t>(bytes.size());  // the other side is gone; it will be told
  Time due = clock_.now() + conditions.latency;
  std::span<const std::uint8_t> rest = bytes;
  while (!rest.empty()) {
    const bool is_whole = conditions.piece_max == 0 || !socket->is_on_cable;
    const std::size_t size =
        is_whole ? rest.size() : std::min(rest.size(), 1 + chance_() % conditions.piece_max);
    schedule(*peer, {due, {rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(size)}, false, false});
    rest = rest.subspan(size);
    due += draw_gap();
  }
  return static_cast<std::int64_t>(bytes.size());
}

std::int64_t Network::receive(int descriptor, std::uint8_t* into, std::size_t size) {
  Socket* const socket = find(descriptor);
  if (socket == nullptr) return fails(EBADF);
  if (socket->stage == Stage::kBroken) return fails(socket->error != 0 ? socket->error : ENOTCONN);
  const std::size_t count = std::min(size, socket->unread.size());
  if (count == 0) return socket->has_end ? 0 : fails(EAGAIN);
  const auto end = socket->unread.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(socket->unread.begin(), end, into);
  socket->unread.erase(socket->unread.begin(), end);
  Socket* const sender = find(socket->peer);
  if (sender && std::exchange(sender->waits_to_send, false)) wake(sender->descriptor);
  if (tap && socket->is_on_cable) tap(!socket->is_host, false, {into, count});
  return static_cast<std::int64_t>(count);
}

std::uint16_t Network::port_of(int descriptor) const {
  const Socket* const socket = find(descriptor);
  return socket ? socket->port : std::uint16_t{0};
}

std::size_t Network::available(int descriptor) const {
  const Socket* const socket = find(descriptor);
  return socket ? socket->unread.size() : 0;
}

int Network::take_error(int descriptor) {
  Socket* const socket = find(descriptor);
  return socket ? std::exchange(socket->error, socket->stage == Stage::kBroken ? ENOTCONN : 0) : EBADF;
}

std::uint32_t Network::readiness(int descriptor) const {
  const Socket* const socket = find(descriptor);
  if (socket == nullptr) return EPOLLIN | EPOLLERR;
  switch (socket->stage) {
    case Stage::kNew:
    case Stage::kConnecting:
      return 0;
    case Stage::kListening:
      return socket->waiting.empty() ? 0U : std::uint32_t{EPOLLIN};
    case Stage::kConnected:
      return (!socket->unread.empty() || socket->has_end ? std::uint32_t{EPOLLIN} : 0U) | EPOLLOUT;
    case Stage::kBroken:
      return EPOLLIN | EPOLLOUT | EPOLLERR | EPOLLHUP;
  }
  return 0;
}

// ---- epoll ----

int Network::open_epoll() {
  const int descriptor = next_descriptor_++;
  epolls_.emplace(descriptor, std::map<int, Watched>{});
  return descriptor;
}

int Network::control(int epoll, int operation, int descriptor, const epoll_event* event) {
  const auto found = epolls_.find(epoll);
  if (found == epolls_.end()) return fails(EBADF);
  if (operation == EPOLL_CTL_DEL) {
    found->second.erase(descriptor);
  } else {
    found->second[descriptor] = {event->events, event->data.u64, false};
  }
  return 0;
}

int Network::collect(int epoll, epoll_event* events, int events_max) {
  const auto found = epolls_.find(epoll);
  if (found == epolls_.end()) return fails(EBADF);
  int count = 0;
  for (auto& [descriptor, watched] : found->second) {
    if (watched.is_told || count == events_max) continue;
    const std::uint32_t ready = owns(descriptor) ? readiness(descriptor) : std::uint32_t{EPOLLIN};
    const std::uint32_t told = ready & (watched.interest | EPOLLERR | EPOLLHUP);
    if (told == 0) continue;
    watched.is_told = true;
    events[count].events = told;
    events[count].data.u64 = watched.data;
    ++count;
  }
  return count;
}

}  // namespace simulation
