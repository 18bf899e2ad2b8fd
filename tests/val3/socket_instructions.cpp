#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "tests/val3/instructions.hpp"

namespace val3 {
namespace {

Socket& socket_of(Call& c) {
  const auto found = c.cabinet.sockets.find(c.value<Sio>(0).link);
  if (found == c.cabinet.sockets.end())
    throw RuntimeError(kErrorNotLinked, "no socket " + c.value<Sio>(0).link);
  return found->second;
}

std::uint8_t byte_of(double number) {
  if (!(number >= 0 && number <= 255) || number != std::floor(number))
    throw RuntimeError(kErrorParameter, std::to_string(number) + " is no byte");
  return static_cast<std::uint8_t>(number);
}

double number_at(const Place& array, std::size_t index) {
  return std::get<double>(array.element(static_cast<double>(index)).read());
}
void put(const Place& array, std::size_t index, double number) {
  array.element(static_cast<double>(index)).write(number);
}

Value sio_get(Call& c) {
  Socket& socket = socket_of(c);
  // How long it waits does not matter here: a task that waits at all is late.
  if (socket.to_controller.empty() && socket.timeout_s >= 0) throw Blocked{};
  if (socket.to_controller.empty()) return socket.link == Socket::Link::kOpen ? 0.0 : -1.0;
  std::size_t count = 0;
  while (!socket.to_controller.empty() && count < c.places[1].size()) {
    put(c.places[1], count++, socket.to_controller.front());
    socket.to_controller.pop_front();
  }
  return static_cast<double>(count);
}

Value sio_set(Call& c) {
  Socket& socket = socket_of(c);
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < c.places[1].size(); ++i) bytes.push_back(byte_of(number_at(c.places[1], i)));
  if (socket.link != Socket::Link::kOpen || socket.room == 0) return -1.0;
  bytes.resize(std::min(bytes.size(), socket.room));
  if (socket.room != SIZE_MAX) socket.room -= bytes.size();
  socket.to_host.insert(socket.to_host.end(), bytes.begin(), bytes.end());
  return static_cast<double>(bytes.size());
}

Value clear_buffer(Call& c) {
  Socket& socket = socket_of(c);
  socket.to_controller.clear();
  if (socket.link == Socket::Link::kClosedByHost || c.cabinet.clear_buffer_closes)
    socket.link = Socket::Link::kNone;
  return 0.0;
}

Value sio_ctrl(Call& c) {
  Socket& socket = socket_of(c);
  const std::string& name = c.text(1);
  if (const auto refuses = c.cabinet.socket_refuses.find(name); refuses != c.cabinet.socket_refuses.end())
    return refuses->second;
  if (socket.link == Socket::Link::kOpen) return -4.0;  // busy
  const auto set = [&c](auto& setting) {
    const auto* value = std::get_if<std::remove_reference_t<decltype(setting)>>(&c.values.at(2));
    if (value == nullptr) return -2.0;
    setting = *value;
    return 0.0;
  };
  if (name == "timeout") return set(socket.timeout_s);
  if (name == "clients") return set(socket.clients);
  if (name == "nagle") return set(socket.nagle);
  return -1.0;
}

/// A binary format of toBinary and fromBinary.
struct Format {
  std::size_t size = 0;
  bool is_signed = false;
  bool is_float = false;
};

Format format_of(const std::string& text) {
  if (text == "-4l") return {4, true, false};
  if (text == "4l") return {4, false, false};
  if (text == "-2l") return {2, true, false};
  if (text == "2l") return {2, false, false};
  if (text == "1") return {1, false, false};
  if (text == "-1") return {1, true, false};
  if (text == "4.0l") return {4, true, true};
  throw RuntimeError(kErrorParameter, "binary format " + text);
}

/// An integer that does not fit or is none is taken as an error: what a controller makes of it is not known.
std::uint32_t bits_of(double number, const Format& format) {
  if (format.is_float) return std::bit_cast<std::uint32_t>(static_cast<float>(number));
  const double range = std::ldexp(1.0, static_cast<int>(format.size) * 8);
  const double lowest = format.is_signed ? -range / 2 : 0;
  if (!(number >= lowest && number < lowest + range) || number != std::floor(number))
    throw RuntimeError(kErrorParameter, std::to_string(number) + " in a binary format it does not fit");
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(number));
}

double number_of(std::uint32_t bits, const Format& format) {
  if (format.is_float) return static_cast<double>(std::bit_cast<float>(bits));
  const double range = std::ldexp(1.0, static_cast<int>(format.size) * 8);
  return format.is_signed && bits >= range / 2 ? bits - range : bits;
}

std::size_t count_of(double number) {
  if (number < 0 || number != std::floor(number)) throw RuntimeError(kErrorParameter, "a count");
  return static_cast<std::size_t>(number);
}

Value to_binary(Call& c) {
  const Format format = format_of(c.text(2));
  const std::size_t count = count_of(c.number(1));
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t bits = bits_of(number_at(c.places[0], i), format);
    for (std::size_t b = 0; b < format.size; ++b)
      put(c.places[3], i * format.size + b, (bits >> (8 * b)) & 0xFFu);
  }
  return static_cast<double>(count * format.size);
}

Value from_binary(Call& c) {
  const Format format = format_of(c.text(2));
  const std::size_t count = count_of(c.number(1)) / format.size;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < format.size; ++b)
      bits |= static_cast<std::uint32_t>(byte_of(number_at(c.places[0], i * format.size + b))) << (8 * b);
    put(c.places[3], i, number_of(bits, format));
  }
  return static_cast<double>(count);
}

}  // namespace

std::vector<Instruction> socket_instructions() {
  std::vector<Instruction> list;
  list.push_back(instruction("num sioGet(sio, num[]&)", sio_get));
  list.push_back(instruction("num sioSet(sio, num[])", sio_set));
  list.push_back(instruction("void clearBuffer(sio)", clear_buffer));
  list.push_back(instruction("num sioCtrl(sio, string, num|string|bool)", sio_ctrl));
  list.push_back(instruction("num toBinary(num[], num, string, num[]&)", to_binary));
  list.push_back(instruction("num fromBinary(num[], num, string, num[]&)", from_binary));
  list.push_back(instruction("num size(num|bool|string|jointRx|pointRx[])",
                             [](Call& c) -> Value { return static_cast<double>(c.places[0].size()); }));
  return list;
}

}  // namespace val3
