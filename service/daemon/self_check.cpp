#include "service/daemon/self_check.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "service/base/state_directory.hpp"
#include "service/daemon/listen_address.hpp"
#include "service/documents/block_pose_file.hpp"
#include "service/documents/locating_file.hpp"
#include "service/http/auth/operator_tokens.hpp"
#include "service/http/auth/token_file.hpp"
#include "service/http/auth/user_keeper.hpp"
#include "service/store/maintenance.hpp"

namespace cell {

namespace asio = boost::asio;
namespace fs = std::filesystem;

namespace {

/// Root may look at the directory of a service that runs as another user.
void check_owner(const fs::path& directory, SelfCheck& check) {
  try {
    demand_own_directory(directory);
  } catch (const std::runtime_error& error) {
    if (::geteuid() != 0) throw;
    check.remarks.emplace_back(error.what());
  }
}

void check_state(const fs::path& directory) {
  const fs::path existing = demand_state_directory(directory);
  demand_closed_directory(directory);
  if (::access(existing.c_str(), W_OK | X_OK) != 0) {
    throw std::runtime_error(
        fmt::format("--state {}: {} cannot be written; change its rights or name another", directory.string(),
                    existing.string()));
  }
}

/// Rows of a database that are damaged and told one by one; the rest is counted.
constexpr std::size_t kDamageToldMax = 10;

void remark_damage(const fs::path& file, const std::vector<std::string>& damage, SelfCheck& check) {
  if (damage.empty()) return;
  for (std::size_t i = 0; i < std::min(damage.size(), kDamageToldMax); ++i)
    check.remarks.push_back(fmt::format("{}: {}", file.string(), damage[i]));
  const std::size_t untold = damage.size() - std::min(damage.size(), kDamageToldMax);
  check.remarks.push_back(
      fmt::format("{}: damaged{}: a daemon starts and does not tell what is damaged; restore the last backup "
                  "(touchcald --verify lists all damage)",
                  file.string(), untold > 0 ? fmt::format(", also in {} more places", untold) : ""));
}

/// One that is missing or empty is new, or lost: refuse_lost_store() tells which.
void check_store(const fs::path& file, SelfCheck& check) {
  std::error_code missing;
  const auto bytes = fs::file_size(file, missing);
  if (missing || bytes == 0) return;
  try {
    const StoreLook look = look_without_trace(file);
    if (look.unusable)
      check.bad_files.push_back(
          fmt::format("{}: {}; restore the last backup (touchcald --verify lists all damage)", file.string(),
                      *look.unusable));
    remark_damage(file, look.damage, check);
    if (!look.is_whole)
      check.not_looked_at =
          fmt::format("the rows of {} ({} MB), which touchcald --verify checks", file.string(), bytes >> 20);
  } catch (const StoreLogNotRead& unread) {
    check.remarks.emplace_back(unread.what());
    check.not_looked_at = fmt::format("{}, which touchcald --verify checks", file.string());
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

/// What is there of a dialogue that finds the block is discarded where it is damaged; that keeps no daemon
/// from starting.
void check_locating(const fs::path& file, SelfCheck& check) {
  try {
    read_locating(file);
  } catch (const ConfigError& error) {
    check.remarks.push_back(fmt::format("{}; its touches by hand will be made again", error.what()));
  }
}

/// A broker that will not take the cell keeps no daemon from starting: what it does not hear is kept for it.
void check_mqtt(const DaemonOptions& options, SelfCheck& check) {
  if (!options.mqtt || check.cell_name.empty()) return;
  try {
    demand_mqtt_files(*options.mqtt, check.cell_name);
  } catch (const std::runtime_error& error) {
    check.remarks.emplace_back(error.what());
  }
}

/// What `read` refuses with an Error is a bad file, whatever the error's words say of the start.
template <class Error>
std::function<void()> bad_file_at(std::function<void()> read, SelfCheck& check) {
  return [read = std::move(read), &check] {
    try {
      read();
    } catch (const TokenUnreadable&) {
      throw;  // nobody knows what it holds
    } catch (const Error& error) {
      check.bad_files.emplace_back(error.what());
    }
  };
}

}  // namespace

SelfCheck check_daemon(const fs::path& cell_file, const DaemonOptions& options) {
  SelfCheck check;
  const fs::path& state = options.state_directory;
  const auto read_cell_of_daemon = [&] {
    const Cell cell = read_cell(cell_file);
    demand_revolute(cell);
    check.cell_name = cell.name;
  };
  const std::initializer_list<std::function<void()>> parts{
      read_cell_of_daemon,
      [&] { check_state(state); },
      [&] { check_owner(state, check); },
      bad_file_at<std::runtime_error>([&] { refuse_lost_store(state); }, check),
      [&] { check_store(state / kStoreFile, check); },
      [&] { read_block_pose(state / kBlockPoseFile); },
      [&] { check_locating(state / kLocatingFile, check); },
      bad_file_at<NoToken>([&] { read_token(state / kOperateTokenFile); }, check),
      bad_file_at<NoToken>([&] { read_token(state / kViewTokenFile); }, check),
      bad_file_at<std::runtime_error>([&] { read_operator_tokens(state); }, check),
      bad_file_at<std::runtime_error>([&] { read_user_file(state / kUserFile); }, check),
      [&] { check_address(options); },
      [&] { tls_context(options); },
      [&] { check_mqtt(options, check); }};
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
