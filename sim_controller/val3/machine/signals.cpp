#include "sim_controller/val3/machine/signals.hpp"

#include <cmath>

#include "sim_controller/val3/machine/builtins.hpp"

namespace val3 {
namespace {

void demand_link(const Link& link) {
  if (link.id < 0) throw RunFailure(kErrorNotLinked, "an input or output that is not linked");
}

void demand_done(RunError error) {
  if (error != kErrorNone) throw RunFailure(error, "an input or output that cannot be written");
}

/// More outputs than bits of a number are not set together.
constexpr std::size_t kBitsMax = 53;

double sum_of_bits(Context& context, const Slice<Dio>& signals) {
  double sum = 0.0;
  for (std::size_t i = 0; i < signals.size() && i < kBitsMax; ++i)
    if (read_signal(context, signals[i])) sum += std::ldexp(1.0, static_cast<int>(i));
  return sum;
}

/// Sets the outputs by the number's bits; gives back what was set.
double set_bits(Context& context, const Slice<Dio>& signals, double number) {
  double rest = std::trunc(std::max(0.0, number));
  double set = 0.0;
  for (std::size_t i = 0; i < signals.size() && i < kBitsMax; ++i) {
    const bool on = std::fmod(rest, 2.0) >= 1.0;
    rest = std::floor(rest / 2.0);
    write_signal(context, signals[i], on);
    if (on) set += std::ldexp(1.0, static_cast<int>(i));
  }
  return set;
}

template <class T>
Nothing link(Context&, const Out<T>& target, const Out<T>& source) {
  target.value() = source.value();
  return {};
}

template <class T>
double status_of(Context&, const T& signal) {
  return signal.id < 0 ? -1.0 : 0.0;
}

}  // namespace

bool read_signal(const Context& context, const Dio& signal) {
  demand_link(signal);
  return context.system.digital(signal.id);
}

void write_signal(const Context& context, const Dio& signal, bool on) {
  demand_link(signal);
  demand_done(context.system.set_digital(signal.id, on));
}

double read_analogue(const Context& context, const Aio& signal) {
  demand_link(signal);
  return context.system.analogue(signal.id);
}

void write_analogue(const Context& context, const Aio& signal, double value) {
  demand_link(signal);
  demand_done(context.system.set_analogue(signal.id, value));
}

void define_signals(Builtins& list) {
  list.define<double, Slice<Dio>>("dioGet", sum_of_bits);
  list.define<double, Slice<Dio>, double>("dioSet", set_bits);
  list.define<Nothing, Out<Dio>, Out<Dio>>("dioLink", link<Dio>);
  list.define<Nothing, Out<Aio>, Out<Aio>>("aioLink", link<Aio>);
  list.define<Nothing, Out<Sio>, Out<Sio>>("sioLink", link<Sio>);
  list.define<double, Aio>("aioGet", [](Context& c, const Aio& signal) { return read_analogue(c, signal); });
  list.define<double, Aio, double>("aioSet", [](Context& c, const Aio& signal, double value) {
    write_analogue(c, signal, value);
    return read_analogue(c, signal);
  });
  list.define<double, Dio>("ioStatus", status_of<Dio>);
  list.define<double, Aio>("ioStatus", status_of<Aio>);
  list.define<double, Sio>("ioStatus", status_of<Sio>);
}

}  // namespace val3
