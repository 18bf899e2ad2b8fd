#include "service/daemon/self_check.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <functional>
#include <system_error>

#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "service/base/state_directory.hpp"
#include "service/daemon/listen_address.hpp"
#include "service/documents/block_pose_file.hpp"
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

/// One that is missing or empty is new, or lost: refuse_lost_store() tells which.
void check_store(const fs::path& file, SelfCheck& check) {
  std::error_code missing;
  const auto bytes = fs::file_size(file, missing);
  if (missing || bytes == 0) return;
  try {
    if (const auto damage = find_damage_without_trace(file))
      check.bad_files.push_back(fmt::format(
          "{}: {}; restore the last backup (touchcald --verify lists all damage)", file.string(), *damage));
  } catch (const StoreLogNotRead& unread) {
    check.remarks.emplace_back(unread.what());
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
  const fs::path& state = options.state_directory;
  const std::initializer_list<std::function<void()>> parts{[&] {
                                                             const Cell cell = read_cell(cell_file);
                                                             demand_revolute(cell);
                                                             check.cell_name = cell.name;
                                                           },
                                                           [&] { check_state(state); },
                                                           [&] { refuse_lost_store(state); },
                                                           [&] { check_store(state / kStoreFile, check); },
                                                           [&] { read_block_pose(state / kBlockPoseFile); },
                                                           [&] { read_token(state / kOperateTokenFile); },
                                                           [&] { read_token(state / kViewTokenFile); },
                                                           [&] { read_operator_tokens(state); },
                                                           [&] { check_address(options); },
                                                           [&] { tls_context(options); }};
  for (const auto& part : parts) {
    try {
      part();
    } catch (const ConfigError& error) {
      check.bad_files.emplace_back(error.what());
    } catch (const std::runtime_error& error) {
      check.troubles.emplace_back(error.what());
    }
  }
  return check;
}

}  // namespace cell
