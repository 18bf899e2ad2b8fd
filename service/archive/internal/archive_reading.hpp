#pragma once

#include <spdlog/fmt/fmt.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <pqxx/pqxx>
#include <stdexcept>
#include <string>

#include "service/archive/archive_options.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/internal/archive_version.hpp"

namespace cell {

/// Runs `read` in a transaction that only reads, on an archive of this version.
template <class Read>
auto reading(const std::string& url, const Read& read) try {
  pqxx::connection connection(with_archive_bounds(url));
  pqxx::read_transaction transaction(connection);
  const int version = archive_version(transaction);
  refuse_newer_archive(version);
  if (version < newest_archive_schema())
    throw std::runtime_error(
        "the archive is not prepared; its owner runs touchcal archive prepare --archive URL");
  return read(transaction);
} catch (const pqxx::failure& error) {
  const std::string what = error.what();  // the text of a server ends with its own line break
  throw std::runtime_error(fmt::format("the archive cannot be read: {}", what.substr(0, what.find('\n'))));
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
