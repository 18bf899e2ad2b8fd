#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <memory>

#include "service/daemon/daemon.hpp"

namespace cell {

/// The address that a daemon with these options serves. Throws std::runtime_error that says what to change,
/// for an unknown host and, without TLS, for every address but loopback.
boost::asio::ip::tcp::endpoint listen_address(boost::asio::io_context& context, const DaemonOptions& options);

/// From the files of the options; null without them. Throws std::runtime_error that names the file.
std::shared_ptr<boost::asio::ssl::context> tls_context(const DaemonOptions& options);

}  // namespace cell
