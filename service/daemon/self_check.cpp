#include "service/daemon/self_check.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <functional>

#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "service/base/state_directory.hpp"
#include "service/daemon/listen_address.hpp"
#include "service/http/auth/operator_tokens.hpp"
#include "service/http/auth/token_file.hpp"
#include "service/store/maintenance.hpp"

namespace cell {

namespace asio = boost::asio;
namespace fs = std::filesystem;

namespace {

void check_state(const fs::path& directory) {
  const fs::path existing = demand_state_directory(directory);
  if (::access(existing.c_str(), W_OK | X_OK) != 0) {
    throw std::runtime_error(
        fmt::format("--state {}: {} cannot be written; change its rights or name another", directory.string(),
                    existing.string()));
  }
}

void check_address(const DaemonOptions& options) {
  asio::io_context context(1);
  const asio::ip::tcp::endpoint address = listen_address(context, options);
  boost::system::error_code failure;
  asio::ip::tcp::acceptor acceptor(context);
  acceptor.open(address.protocol(), failure);
  if (!failure) acceptor.set_option(asio::socket_base::reuse_address(true), failure);
  if (!failure) acceptor.bind(address, failure);
  // In use, most likely by the daemon that this check runs beside.
  if (!failure || failure == asio::error::address_in_use) return;
  throw std::runtime_error(
      fmt::format("--listen {}: {}; give another address", endpoint_text(options.listen), failure.message()));
}

}  // namespace

SelfCheck check_daemon(const fs::path& cell_file, const DaemonOptions& options) {
  SelfCheck check;
  try {
    const Cell cell = read_cell(cell_file);
    demand_revolute(cell);
    check.cell_name = cell.name;
  } catch (const ConfigError& error) {
    check.bad_files.emplace_back(error.what());
  }
  const std::initializer_list<std::function<void()>> others{
      [&] { check_state(options.state_directory); },
      [&] { refuse_lost_store(options.state_directory); },
      [&] { read_token(options.state_directory / kOperateTokenFile); },
      [&] { read_token(options.state_directory / kViewTokenFile); },
      [&] { read_operator_tokens(options.state_directory); },
      [&] { check_address(options); },
      [&] { tls_context(options); }};
  for (const auto& part : others) {
    try {
      part();
    } catch (const std::runtime_error& error) {
      check.troubles.emplace_back(error.what());
    }
  }
  return check;
}

}  // namespace cell
