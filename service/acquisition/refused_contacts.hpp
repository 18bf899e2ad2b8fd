#pragma once

#include <boost/asio/awaitable.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/base/clocks.hpp"

namespace cell {

/// Which command an answer is of.
struct AnsweredCommand {
  std::uint32_t session = 0;  // of the controller's application
  std::uint32_t sequence = 0;
};

/// What the controller measured and the daemon does not take: it is evidence of what went wrong, so that it
/// is on the disk, with the reason, before the controller forgets it (store/refused_result.hpp).
class RefusedContacts {
 public:
  /// Both must outlive it.
  RefusedContacts(StoreQueue& store, ControllerSession& session, Clocks clocks)
      : store_(store), session_(session), clocks_(std::move(clocks)) {}

  /// Stores the contact in an answer, if it has one, then lets the controller forget the answer: one of an
  /// earlier session it has forgotten with that. `run_id`: with which run it is kept; nothing where this
  /// daemon has none, then the store says (run_of_answer()), and with an empty store the log alone has it.
  /// Why it could not be stored, nothing when it is done: a controller in the same session has it still.
  boost::asio::awaitable<std::optional<std::string>> settle(std::optional<std::int64_t> run_id,
                                                            AnsweredCommand command, cs8::TouchResult result,
                                                            std::string reason);

 private:
  StoreQueue& store_;
  ControllerSession& session_;
  Clocks clocks_;
};

}  // namespace cell
