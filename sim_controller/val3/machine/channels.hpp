#pragma once

#include <cstdint>
#include <string>

#include "sim_controller/val3/machine/nodes.hpp"

/// Reading and writing sockets and serial ports (manual 6, pages 61 to 64). What has to wait throws Wait.
namespace val3 {

/// `number = sio`: one byte. RunFailure 60 when the channel's time-out is over, 125 when its peer has closed:
/// no manual numbers them, but a read at a closed connection does not wait.
double read_byte(Context& context, const Sio& channel);
/// `string = sio`: up to the end-of-string byte, which is not kept, or 128 bytes.
std::string read_text(Context& context, const Sio& channel);
/// Wait, or RunFailure 60 or 125, until a byte or a string can be written.
void demand_writable(Context& context, const Sio& channel);
void write_byte(Context& context, const Sio& channel, double value);
/// With the end-of-string byte behind it.
void write_text(Context& context, const Sio& channel, const std::string& text);

}  // namespace val3
