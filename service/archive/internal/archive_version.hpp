#pragma once

#include <pqxx/transaction_base.hxx>

namespace cell {

/// Of an archive that lacks something.
inline constexpr const char* kPrepareIt = "its owner runs touchcal archive prepare --archive URL";

/// Of the tables; 0 where there are none.
int archive_version(pqxx::transaction_base& transaction);

/// Throws std::runtime_error for one that this program does not know.
void refuse_newer_archive(int version);

}  // namespace cell
