#pragma once

#include <memory>

#include "service/http/auth/tokens.hpp"
#include "service/http/routes/metrics.hpp"
#include "service/http/routes/status_feed.hpp"
#include "service/store/answer_store.hpp"
#include "service/store/audit_log.hpp"

namespace cell {

class CellOperation;

/// What handlers use. `operation` must outlive it.
struct Services {
  Services(CellOperation& to_serve, Tokens to_ask_for);

  CellOperation& operation;
  Tokens tokens;
  StatusFeed feed;
  Metrics metrics;
  AnswerStore answers;
  AuditLog audit;
  std::shared_ptr<int> open_streams = std::make_shared<int>(0);  // event streams; a stream may outlive this
};

}  // namespace cell
