#include "sim_controller/socket_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "sim_controller/val3_pace.hpp"

namespace sim {
namespace {

using Clock = std::chrono::steady_clock;

/// Between two looks at the sockets while no tick is due.
constexpr std::chrono::milliseconds kSocketLook{4};

/// "Socket\a, Socket\b"
std::string sockets_of(const Val3Channels& channels) {
  std::string all;
  for (int id = 0; id < channels.count(); ++id) {
    if (channels.at(id).is_socket() && !channels.at(id).is_udp())
      all += (all.empty() ? "" : ", ") + channels.at(id).link();
  }
  return all;
}

bool is_of_script_peer(ScriptAct::Kind kind) {
  return kind == ScriptAct::Kind::kConnect || kind == ScriptAct::Kind::kDisconnect ||
         kind == ScriptAct::Kind::kSend || kind == ScriptAct::Kind::kExpectSent;
}

}  // namespace

SocketRun::SocketRun(ScriptedRun& run, std::span<const RunSocket> wanted, std::span<const ScriptStep> steps)
    : run_(run) {
  for (const RunSocket& socket : wanted) add(socket, steps);
  signals_.async_wait([this](const boost::system::error_code& error, int) { is_stopped_ = !error; });
}

void SocketRun::add(const RunSocket& wanted, std::span<const ScriptStep> steps) {
  Val3Channels& channels = run_.channels();
  const auto id = channels.known(wanted.name);
  if (id && channels.at(*id).is_udp())
    throw WrongSocket(
        fmt::format("--socket {}: {} is a UDP socket, and only TCP is served; leave the option out, the "
                    "script can be its peer",
                    wanted.name, channels.at(*id).link()));
  if (id && !channels.at(*id).is_socket())
    throw WrongSocket(
        fmt::format("--socket {}: {} is a serial port, no socket; leave the option out, the script can be "
                    "its peer",
                    wanted.name, channels.at(*id).link()));
  if (!id) {
    const std::string there = sockets_of(channels);
    throw WrongSocket(fmt::format(
        "--socket {}: no sio of the application is linked to it alone; {}", wanted.name,
        there.empty() ? "it has no sockets, leave the option out" : "give one of these links: " + there));
  }
  Val3Channel& channel = channels.at(*id);
  if (std::ranges::count(channels_, *id) != 0)
    throw WrongSocket(
        fmt::format("--socket {}: {} comes twice; leave one of them out", wanted.name, channel.link()));
  for (const ScriptStep& step : steps) {
    if (is_of_script_peer(step.act.kind) && step.act.name == channel.link())
      throw WrongSocket(
          fmt::format("line {} of the script: {} is a real socket by --socket, its peer is not "
                      "the script's; leave out the line or the option",
                      step.line, channel.link()));
  }
  sockets_.push_back(open_socket(io_, channel, wanted, [this](const std::string& text) { run_.tell(text); }));
  channels_.push_back(*id);
}

void SocketRun::exchange() {
  for (std::size_t i = 0; i < sockets_.size(); ++i) {
    sockets_[i]->exchange(Clock::now());
    tell_overruled(i);
  }
}

/// What sioCtrl says of the place, once.
void SocketRun::tell_overruled(std::size_t socket) {
  const Val3Channel& channel = run_.channels().at(channels_[socket]);
  if (!channel.port() && !channel.is_client()) return;
  if (!overruled_.insert(channels_[socket]).second) return;
  run_.tell(channel.link() + ": its place is that of --socket; port and target of sioCtrl change nothing");
}

void SocketRun::run(double until_s, double speed) {
  Val3Pace pace(speed, Clock::now());
  while (!run_.is_over() && run_.seconds() <= until_s) {
    io_.poll();
    if (is_stopped_) {
      run_.tell("ended by a signal");
      break;
    }
    exchange();
    if (pace.tick(run_.is_busy(), run_.seconds(), Clock::now())) {
      run_.step();
    } else {
      io_.run_one_until(std::min(pace.wake_at(), Clock::now() + kSocketLook));
    }
  }
  end_connections();
}

void SocketRun::end_connections() {
  for (const auto& socket : sockets_) socket->end(Clock::now());
  const auto is_open = [](const auto& socket) { return socket->is_open(); };
  while (std::ranges::any_of(sockets_, is_open)) {
    exchange();
    if (std::ranges::any_of(sockets_, is_open)) io_.run_one_for(kSocketLook);
  }
  for (const auto& socket : sockets_) run_.tell(socket->summary());
}

}  // namespace sim
