#pragma once

#include <memory>

#include "sim_controller/val3/program/application.hpp"

/// The library `io` of s5 and s6: the controller's inputs and outputs stand in it under their own names
/// (language reference, 1.7). s7 has none; there the data of an application are linked.
namespace val3 {

/// The one that a controller has by itself, for an application that has no project `io` beside it: the
/// signals of a CS8C (library as shipped with s6.8); each bIn0 to bIn999 and bOut0 to bOut999 that `user`
/// names, as boards of the cell have them; and a channel for each name that it gives to an instruction of
/// sockets and serial ports, sets to a string or sets a string to, whose names are the cell's. `user` has its
/// data and programs; nothing is resolved.
std::shared_ptr<Application> built_in_io(const Application& user);

/// The entries of a project `io` are the signals and channels of their names: files of s5 and s6 store no
/// link.
void link_to_signals(Application& io);

}  // namespace val3
