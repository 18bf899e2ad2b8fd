#pragma once

#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>

namespace cell {

/// TLS 1.2 or newer with this certificate (PEM, followed by its chain) and its key. Throws std::runtime_error
/// that names the file and its error.
std::shared_ptr<boost::asio::ssl::context> make_tls_context(const std::filesystem::path& certificate,
                                                            const std::filesystem::path& key);

}  // namespace cell
