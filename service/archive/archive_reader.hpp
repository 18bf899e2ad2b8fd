#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "service/documents/fleet_document.hpp"
#include "service/documents/run_document.hpp"

namespace cell {

struct ArchiveLook {
  bool touches = true;                     // false: of a head office that does not get them
  std::optional<ArchiveDocument> earlier;  // what was found before: what was there must be there still
};

/// Compares every event of every cell with its digest and with the one before, every document with its
/// digest, and what the newest set of touches of each run names with what is there: its documents, and its
/// touches by number and, of sets that say it, by digest. `url`: of who may read all. Throws
/// std::runtime_error where the archive cannot be read.
ArchiveDocument look_at_archive(const std::string& url, const ArchiveLook& how = {});

/// What one cell told, newest first: at most `limit` facts, those before number `before` where it is given.
/// Throws std::runtime_error.
HistoryDocument history_of(const std::string& url, const std::string& cell, int limit,
                           std::optional<std::int64_t> before = {});

/// The runs of one cell as its facts tell them (archived_runs), newest first: at most `limit`, those before
/// run `before` where it is given. Throws std::runtime_error, also where a query takes longer than
/// `patience`.
RunsDocument runs_of_cell(const std::string& url, const std::string& cell, int limit,
                          std::optional<std::int64_t> before = {},
                          const std::optional<std::chrono::milliseconds>& patience = {});

}  // namespace cell
