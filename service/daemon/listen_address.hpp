#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <memory>

#include "service/daemon/daemon.hpp"

namespace cell {

/// Where a daemon with these options serves. Throws std::runtime_error that says what to change: a name that
/// is none, and every address but loopback where there is no TLS.
boost::asio::ip::tcp::endpoint listen_address(boost::asio::io_context& context, const DaemonOptions& options);

/// Of the options' files; null without them. Throws std::runtime_error that names the file.
std::shared_ptr<boost::asio::ssl::context> tls_context(const DaemonOptions& options);

}  // namespace cell
