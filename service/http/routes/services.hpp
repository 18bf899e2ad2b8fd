#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "service/http/auth/tokens.hpp"
#include "service/http/auth/user_keeper.hpp"
#include "service/http/routes/metrics.hpp"
#include "service/http/routes/reads.hpp"
#include "service/http/routes/status_feed.hpp"
#include "service/store/answer_store.hpp"
#include "service/store/audit_log.hpp"
#include "service/store/model_store.hpp"
#include "service/store/run_copy.hpp"

namespace cell {

class CellOperation;

/// All cells of the plant's archive, as documents. Each throws std::runtime_error where the archive cannot be
/// read. Without values: no archive is configured.
struct FleetView {
  std::function<std::string()> cells;             // touchcal/fleet/1
  std::function<std::string(int months)> trends;  // touchcal/fleet-trends/1
};

/// What handlers use, on the thread that serves. `operation` must outlive it.
struct Services {
  /// `store_file`: where the operation has another thread; see Reads.
  Services(CellOperation& to_serve, Tokens to_ask_for,
           const std::optional<std::filesystem::path>& store_file = {});

  CellOperation& operation;  // asked on its own thread: Route::ask
  Tokens tokens;
  StatusFeed feed;
  Metrics metrics;
  Reads reads;
  AnswerStore answers;  // these three on the thread that writes
  AuditLog audit;
  ModelStore models;
  RunImports imports;                                            // likewise
  UserKeeper users;                                              // likewise
  UserBook user_book;                                            // of it, as it counts now
  FleetView fleet;                                               // on the thread that asks the archive
  std::shared_ptr<int> open_streams = std::make_shared<int>(0);  // event streams; a stream may outlive this
};

}  // namespace cell
