// The system calls of sockets, epoll and timers that Asio makes, answered by the simulated network while
// there is one: see virtual_clock.hpp. Linked into the programs of tests/simulation only. Whatever is not
// about a descriptor of that network goes on to the C library.
#include <dlfcn.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/timerfd.h>

#include <cerrno>
#include <cstdarg>
#include <cstring>

#include "tests/simulation/network.hpp"
#include "tests/simulation/waiting_turn.hpp"

namespace simulation {
namespace {

thread_local WaitingTurn* the_turn = nullptr;

Network* network_of(int descriptor) { return Network::owns(descriptor) ? Network::current() : nullptr; }

/// Of a world that has gone: what is left of it may still be closed.
bool is_left_over(int descriptor) { return Network::owns(descriptor) && Network::current() == nullptr; }

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

std::uint16_t port_in(const sockaddr* address) {
  sockaddr_in internet{};
  std::memcpy(&internet, address, sizeof(internet));
  return ntohs(internet.sin_port);
}

int put_address(std::uint16_t port, sockaddr* address, socklen_t* size) {
  sockaddr_in internet{};
  internet.sin_family = AF_INET;
  internet.sin_port = htons(port);
  internet.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::memcpy(address, &internet, std::min<std::size_t>(*size, sizeof(internet)));
  *size = sizeof(internet);
  return 0;
}

ssize_t send_all(Network& network, int descriptor, const msghdr& message) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    const auto* const from = static_cast<const std::uint8_t*>(message.msg_iov[i].iov_base);
    bytes.insert(bytes.end(), from, from + message.msg_iov[i].iov_len);
  }
  return network.send(descriptor, bytes);
}

ssize_t receive_into(Network& network, int descriptor, const msghdr& message) {
  ssize_t all = 0;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    const iovec& part = message.msg_iov[i];
    if (part.iov_len == 0) continue;
    if (all > 0 && network.available(descriptor) == 0) break;
    const auto got = network.receive(descriptor, static_cast<std::uint8_t*>(part.iov_base), part.iov_len);
    if (got <= 0) return all > 0 ? all : got;
    all += got;
  }
  return all;
}

}  // namespace

WaitingTurn::WaitingTurn(std::function<void()> stop) : stop_(std::move(stop)) { the_turn = this; }

WaitingTurn::~WaitingTurn() { the_turn = nullptr; }

void WaitingTurn::on_wait(int timeout_ms) {
  if (timeout_ms >= 0) until_next_timer_ = std::chrono::milliseconds(timeout_ms);
  stop_();
}

}  // namespace simulation

using simulation::Network;
using simulation::network_of;
using simulation::real;

extern "C" {

int socket(int family, int type, int protocol) noexcept {
  if (Network* const network = Network::current(); network && (family == AF_INET))
    return network->open_socket();
  return real<int (*)(int, int, int)>("socket")(family, type, protocol);
}

int bind(int descriptor, const sockaddr* address, socklen_t size) noexcept {
  if (Network* const network = network_of(descriptor))
    return network->bind(descriptor, simulation::port_in(address));
  return real<int (*)(int, const sockaddr*, socklen_t)>("bind")(descriptor, address, size);
}

int listen(int descriptor, int backlog) noexcept {
  if (Network* const network = network_of(descriptor)) return network->listen(descriptor);
  return real<int (*)(int, int)>("listen")(descriptor, backlog);
}

int connect(int descriptor, const sockaddr* address, socklen_t size) {
  if (Network* const network = network_of(descriptor))
    return network->connect(descriptor, simulation::port_in(address));
  return real<int (*)(int, const sockaddr*, socklen_t)>("connect")(descriptor, address, size);
}

int accept(int descriptor, sockaddr* address, socklen_t* size) {
  if (Network* const network = network_of(descriptor)) {
    const int accepted = network->accept(descriptor);
    if (accepted >= 0 && address != nullptr) simulation::put_address(1, address, size);
    return accepted;
  }
  return real<int (*)(int, sockaddr*, socklen_t*)>("accept")(descriptor, address, size);
}

int shutdown(int descriptor, int how) noexcept {
  if (Network* const network = network_of(descriptor))
    return how == SHUT_RD ? 0 : network->shutdown_send(descriptor);
  return real<int (*)(int, int)>("shutdown")(descriptor, how);
}

int close(int descriptor) {
  if (Network* const network = network_of(descriptor)) return network->close(descriptor);
  if (simulation::is_left_over(descriptor)) return 0;
  return real<int (*)(int)>("close")(descriptor);
}

ssize_t sendmsg(int descriptor, const msghdr* message, int flags) {
  if (Network* const network = network_of(descriptor))
    return simulation::send_all(*network, descriptor, *message);
  return real<ssize_t (*)(int, const msghdr*, int)>("sendmsg")(descriptor, message, flags);
}

ssize_t send(int descriptor, const void* bytes, size_t size, int flags) {
  if (Network* const network = network_of(descriptor))
    return network->send(descriptor, {static_cast<const std::uint8_t*>(bytes), size});
  return real<ssize_t (*)(int, const void*, size_t, int)>("send")(descriptor, bytes, size, flags);
}

ssize_t recvmsg(int descriptor, msghdr* message, int flags) {
  if (Network* const network = network_of(descriptor))
    return simulation::receive_into(*network, descriptor, *message);
  return real<ssize_t (*)(int, msghdr*, int)>("recvmsg")(descriptor, message, flags);
}

ssize_t recv(int descriptor, void* bytes, size_t size, int flags) {
  if (Network* const network = network_of(descriptor))
    return network->receive(descriptor, static_cast<std::uint8_t*>(bytes), size);
  return real<ssize_t (*)(int, void*, size_t, int)>("recv")(descriptor, bytes, size, flags);
}

int setsockopt(int descriptor, int level, int name, const void* value, socklen_t size) noexcept {
  if (network_of(descriptor) != nullptr) return 0;
  return real<int (*)(int, int, int, const void*, socklen_t)>("setsockopt")(descriptor, level, name, value,
                                                                            size);
}

int getsockopt(int descriptor, int level, int name, void* value, socklen_t* size) noexcept {
  if (Network* const network = network_of(descriptor)) {
    const int answer = level == SOL_SOCKET && name == SO_ERROR ? network->take_error(descriptor) : 0;
    std::memcpy(value, &answer, std::min<std::size_t>(*size, sizeof(answer)));
    return 0;
  }
  return real<int (*)(int, int, int, void*, socklen_t*)>("getsockopt")(descriptor, level, name, value, size);
}

int getsockname(int descriptor, sockaddr* address, socklen_t* size) noexcept {
  if (Network* const network = network_of(descriptor))
    return simulation::put_address(network->port_of(descriptor), address, size);
  return real<int (*)(int, sockaddr*, socklen_t*)>("getsockname")(descriptor, address, size);
}

int getpeername(int descriptor, sockaddr* address, socklen_t* size) noexcept {
  if (network_of(descriptor) != nullptr) return simulation::put_address(1, address, size);
  return real<int (*)(int, sockaddr*, socklen_t*)>("getpeername")(descriptor, address, size);
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (Network* const network = network_of(descriptor)) {
    if (request == FIONREAD) *static_cast<int*>(argument) = static_cast<int>(network->available(descriptor));
    return 0;
  }
  return real<int (*)(int, unsigned long, void*)>("ioctl")(descriptor, request, argument);
}

// The C library's declaration says that poll() writes there only, and it reads too.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
int poll(pollfd* descriptors, nfds_t count, int timeout_ms) {
  if (count == 1) {
    if (Network* const network = network_of(descriptors[0].fd)) {
      const std::uint32_t ready = network->readiness(descriptors[0].fd);
      const auto wanted = static_cast<std::uint32_t>(descriptors[0].events) | EPOLLERR | EPOLLHUP;
      descriptors[0].revents = static_cast<short>(ready & wanted);  // the bits are those of epoll
      return descriptors[0].revents != 0 ? 1 : 0;
    }
  }
  return real<int (*)(pollfd*, nfds_t, int)>("poll")(descriptors, count, timeout_ms);
}
#pragma GCC diagnostic pop

int timerfd_create(clockid_t clock, int flags) noexcept {
  if (Network::current() != nullptr) {
    errno = ENOSYS;
    return -1;
  }
  return real<int (*)(clockid_t, int)>("timerfd_create")(clock, flags);
}

int epoll_create1(int flags) noexcept {
  if (Network* const network = Network::current()) return network->open_epoll();
  return real<int (*)(int)>("epoll_create1")(flags);
}

int epoll_ctl(int epoll, int operation, int descriptor, epoll_event* event) noexcept {
  if (Network* const network = network_of(epoll))
    return network->control(epoll, operation, descriptor, event);
  if (simulation::is_left_over(epoll)) return 0;
  return real<int (*)(int, int, int, epoll_event*)>("epoll_ctl")(epoll, operation, descriptor, event);
}

int epoll_wait(int epoll, epoll_event* events, int events_max, int timeout_ms) {
  if (Network* const network = network_of(epoll)) {
    const int count = network->collect(epoll, events, events_max);
    if (count == 0 && timeout_ms != 0) {
      if (simulation::the_turn == nullptr) std::abort();  // nobody moves the clock: it would wait for ever
      simulation::the_turn->on_wait(timeout_ms);
    }
    return count;
  }
  return real<int (*)(int, epoll_event*, int, int)>("epoll_wait")(epoll, events, events_max, timeout_ms);
}

}  // extern "C"
