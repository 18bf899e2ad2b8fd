#pragma once

#include "sim_controller/val3/files/file_findings.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What a controller refuses in an application whose files are read: fathers that are missing, of another
/// type, beyond their array or in a circle (language reference, 1.8). Libraries are read already.
void check_fathers(const Application& application, Findings& findings);

/// start() and stop() of a project that is opened by itself. One without either can be a library or a type:
/// that is told as a warning.
void check_start_and_stop(const Application& application, Findings& findings);

}  // namespace val3
