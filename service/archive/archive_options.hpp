#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace cell {

/// An address of a PostgreSQL: postgresql://[USER@]HOST[:PORT]/DATABASE[?...] without a password, which a
/// command line would show to everybody (a certificate says who the cell is, or ~/.pgpass), and with
/// sslmode=verify-full unless HOST is a loopback address or none (a Unix socket), which
/// neither a service of libpq nor its environment (PGHOST, PGHOSTADDR, PGSERVICE) leads elsewhere. Nothing
/// for another text.
std::optional<std::string> archive_from_url(std::string_view url);

/// The same with bounds for what a server that is silent may take.
std::string with_archive_bounds(const std::string& url);

}  // namespace cell
