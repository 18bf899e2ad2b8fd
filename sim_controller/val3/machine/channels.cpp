#include "sim_controller/val3/machine/channels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

constexpr std::size_t kReadTextMax = 128;
/// Bytes of one sioGet or sioSet; an array of more is moved in several calls.
constexpr std::size_t kTransferMax = 65536;

int linked(const Sio& channel) {
  if (channel.id < 0) throw RunFailure(kErrorNotLinked, "a socket or serial port that is not linked");
  return channel.id;
}

/// Whether there is something to do now. True: yes. False: the time-out is over, the channel does not wait,
/// or its peer has gone, which no time mends. Else the line waits: Wait.
template <class IsReady>
bool ready(Context& context, int channel, IsReady is_ready) {
  if (is_ready()) {
    Tasks::stop_waiting(context.task);
    return true;
  }
  const double timeout_s = context.system.channel_timeout_s(channel);
  if (timeout_s < 0.0) return false;
  if (context.system.peer_is_gone(channel)) {
    Tasks::stop_waiting(context.task);
    return false;
  }
  constexpr double kForeverSeconds = 1e9;
  const void* who = context.here->code->operations[context.here->next - 1].get();
  if (context.tasks.is_over(context.task, who, timeout_s == 0.0 ? kForeverSeconds : timeout_s)) return false;
  throw Wait{};
}

bool has_input(Context& context, int channel) {
  return context.system.waiting(channel) > 0 ||
         (context.system.connect(channel) && context.system.waiting(channel) > 0);
}

/// Nearest integer modulo 256.
std::uint8_t byte_of(double value) {
  const double rounded = std::fmod(std::round(value), 256.0);
  return static_cast<std::uint8_t>(static_cast<int>(rounded < 0 ? rounded + 256.0 : rounded));
}

/// Bytes that were read, one an element; 0 connected and nothing there, where the channel does not wait.
double get(Context& context, const Sio& sio, const Slice<double>& into) {
  const int channel = linked(sio);
  if (!ready(context, channel, [&] { return has_input(context, channel); }))
    return context.system.channel_timeout_s(channel) < 0.0 && context.system.connect(channel) ? 0.0 : -1.0;
  std::array<std::uint8_t, 1024> bytes{};
  std::size_t got = 0;
  while (got < into.size()) {
    const std::size_t wanted = std::min(bytes.size(), into.size() - got);
    const std::size_t taken = context.system.receive(channel, std::span(bytes).first(wanted));
    for (std::size_t i = 0; i < taken; ++i) into[got + i] = static_cast<double>(bytes[i]);
    got += taken;
    if (taken < wanted) break;
  }
  context.tasks.charge(got);
  return static_cast<double>(got);
}

double set(Context& context, const Sio& sio, const Slice<double>& from) {
  const int channel = linked(sio);
  if (!ready(context, channel, [&] { return context.system.connect(channel); })) return -1.0;
  std::vector<std::uint8_t> bytes(std::min(from.size(), kTransferMax));
  context.tasks.charge(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = byte_of(from[i]);
  return static_cast<double>(context.system.send(channel, bytes));
}

/// As ready(), for what cannot answer -1.
template <class IsReady>
void demand_ready(Context& context, int channel, IsReady is_ready) {
  if (ready(context, channel, is_ready)) return;
  if (context.system.peer_is_gone(channel))
    throw RunFailure(kErrorInputOutput, "the peer of a socket has closed the connection");
  throw RunFailure(kErrorTimeout, "the time-out of a socket or serial port is over");
}

}  // namespace

double read_byte(Context& context, const Sio& sio) {
  const int channel = linked(sio);
  demand_ready(context, channel, [&] { return has_input(context, channel); });
  std::array<std::uint8_t, 1> byte{};
  context.system.receive(channel, byte);
  return static_cast<double>(byte[0]);
}

std::string read_text(Context& context, const Sio& sio) {
  const int channel = linked(sio);
  std::string& text = context.tasks.half_read[channel];
  const std::uint8_t end = context.system.end_of_string(channel);
  for (;;) {
    demand_ready(context, channel, [&] { return has_input(context, channel); });
    std::array<std::uint8_t, 1> byte{};
    context.system.receive(channel, byte);
    if (byte[0] != end) text += static_cast<char>(byte[0]);
    if (byte[0] == end || text.size() >= kReadTextMax) return std::exchange(text, {});
  }
}

void demand_writable(Context& context, const Sio& sio) {
  const int channel = linked(sio);
  // What else the line waits for keeps its time.
  if (context.system.connect(channel)) return;
  demand_ready(context, channel, [&] { return context.system.connect(channel); });
}

void write_byte(Context& context, const Sio& sio, double value) {
  const int channel = linked(sio);
  demand_ready(context, channel, [&] { return context.system.connect(channel); });
  const std::array<std::uint8_t, 1> byte{byte_of(value)};
  if (context.system.send(channel, byte) != byte.size())
    throw RunFailure(kErrorInputOutput, "a byte was not sent");
}

void write_text(Context& context, const Sio& sio, const std::string& text) {
  const int channel = linked(sio);
  demand_ready(context, channel, [&] { return context.system.connect(channel); });
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  bytes.push_back(context.system.end_of_string(channel));
  if (context.system.send(channel, bytes) != bytes.size())
    throw RunFailure(kErrorInputOutput, "a string was not sent");
}

void define_channels(Builtins& list) {
  list.define<double, Sio, Slice<double>>("sioGet", get);
  list.define<double, Sio, Slice<double>>("sioSet", set);
  list.define<double, Sio>("clearBuffer", [](Context& c, const Sio& sio) {
    const int channel = linked(sio);
    c.tasks.half_read.erase(channel);
    return c.system.close(channel) ? 0.0 : -1.0;
  });
  list.define<double, Sio, std::string, double>(
      "sioCtrl", [](Context& c, const Sio& sio, const std::string& name, double value) {
        return static_cast<double>(c.system.set_channel(linked(sio), name, value, {}, nullptr));
      });
  list.define<double, Sio, std::string, bool>(
      "sioCtrl", [](Context& c, const Sio& sio, const std::string& name, bool value) {
        return static_cast<double>(c.system.set_channel(linked(sio), name, {}, value, nullptr));
      });
  list.define<double, Sio, std::string, std::string>(
      "sioCtrl", [](Context& c, const Sio& sio, const std::string& name, const std::string& value) {
        return static_cast<double>(c.system.set_channel(linked(sio), name, {}, {}, &value));
      });
}

}  // namespace val3
