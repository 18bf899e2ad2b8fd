#pragma once

#include <spdlog/fmt/fmt.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>
#include <pqxx/pqxx>
#include <stdexcept>
#include <string>

#include "service/archive/archive_options.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/internal/archive_version.hpp"
#include "service/archive/internal/patience.hpp"

namespace cell {

/// A server that breaks off a statement says so later than it was to.
constexpr std::chrono::milliseconds kServersGrace{1'000};

/// The text of a server ends with its own line break.
inline std::string unreadable(const std::exception& error) {
  const std::string what = error.what();
  return fmt::format("the archive cannot be read: {}", what.substr(0, what.find('\n')));
}

/// Runs `read` in a transaction that only reads, on an archive of this version. No statement takes longer
/// than `patience`, and all of them not much longer (none: however long). Throws std::runtime_error;
/// ArchiveRefused for an archive that does not do.
template <class Read>
auto reading(const std::string& url, const std::optional<std::chrono::milliseconds>& patience,
             const Read& read) try {
  pqxx::connection connection(with_archive_bounds(url));
  std::optional<Patience> bounded;
  if (patience) bounded.emplace(connection, *patience + kServersGrace);
  pqxx::read_transaction transaction(connection);
  if (patience) transaction.exec0(fmt::format("SET LOCAL statement_timeout = {}", patience->count()));
  const int version = archive_version(transaction);
  refuse_newer_archive(version);
  if (version < newest_archive_schema())
    throw ArchiveRefused(fmt::format("the archive is not prepared; {}", kPrepareIt));
  try {
    return read(transaction);
  } catch (const pqxx::syntax_error&) {  // a table or a column that is not there is one
    throw ArchiveRefused(
        fmt::format("the archive was prepared by another version of touchcal; {}", kPrepareIt));
  }
} catch (const pqxx::insufficient_privilege& error) {
  throw ArchiveRefused(unreadable(error));
} catch (const pqxx::failure& error) {
  throw std::runtime_error(unreadable(error));
} catch (const pqxx::conversion_error& error) {  // no pqxx::failure; of a row from before the guards
  throw std::runtime_error(unreadable(error));
}

inline std::optional<std::string> text_or_none(const pqxx::field& field) {
  return field.is_null() ? std::nullopt : std::optional(field.as<std::string>());
}

/// Nothing of a text that is no number, too: any cell may have written it.
inline std::optional<double> number_or_none(const pqxx::field& field) {
  double number = 0.0;
  const char* const end = field.c_str() + field.size();
  const auto [read_to, error] = std::from_chars(field.c_str(), end, number);
  return error == std::errc() && read_to == end && std::isfinite(number) ? std::optional(number)
                                                                         : std::nullopt;
}

}  // namespace cell
