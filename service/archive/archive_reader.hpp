#pragma once

#include <string>

#include "service/documents/fleet_document.hpp"

namespace cell {

/// Compares every event of every cell with its digest and with the one before, and sees whether the documents
/// that they name are there. `url`: of who may read all. Throws std::runtime_error where the archive cannot
/// be read.
ArchiveDocument look_at_archive(const std::string& url);

/// All cells, by name. Throws std::runtime_error.
FleetDocument fleet_of(const std::string& url);

}  // namespace cell
