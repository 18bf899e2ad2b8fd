#pragma once

#include <memory>

#include "service/http/metrics.hpp"
#include "service/http/status_feed.hpp"
#include "service/http/tokens.hpp"
#include "service/store/answer_store.hpp"
#include "service/store/audit_log.hpp"

namespace cell {

class CellOperation;

/// What answers are made from. `operation` must outlive it.
struct Services {
  Services(CellOperation& to_serve, Tokens to_ask_for);

  CellOperation& operation;
  Tokens tokens;
  StatusFeed feed;
  Metrics metrics;
  AnswerStore answers;
  AuditLog audit;
  std::shared_ptr<int> open_streams = std::make_shared<int>(0);  // of events; a reader may outlive this
};

}  // namespace cell
