#pragma once

#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>

namespace cell {

/// TLS 1.2 or newer with this certificate (PEM, its chain behind it) and its key. Throws std::runtime_error
/// that names the file and what is wrong with it.
std::shared_ptr<boost::asio::ssl::context> make_tls_context(const std::filesystem::path& certificate,
                                                            const std::filesystem::path& key);

}  // namespace cell
