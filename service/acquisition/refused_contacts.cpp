// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/refused_contacts.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "service/base/utc_time.hpp"
#include "service/store/refused_result.hpp"

namespace cell {

boost::asio::awaitable<std::optional<std::string>> RefusedContacts::settle(std::optional<std::int64_t> run_id,
                                                                           AnsweredCommand command,
                                                                           cs8::TouchResult result,
                                                                           std::string reason) {
  if (result.outcome == cs8::Outcome::kContact) {
    const RefusedResult refused{.session = command.session,
                                .sequence = command.sequence,
                                .joints = result.contact,
                                .reason = std::move(reason),
                                .at = format_utc(clocks_.system())};
    const auto write = [&run_id, refused](RunStore& store) {
      if (!run_id) run_id = run_of_answer(store, refused.session, refused.sequence);
      if (run_id && !keep_refused(store, *run_id, refused))
        spdlog::error("run {}: a refused result is not kept: {} of it are, or it is not in the store",
                      *run_id, kRefusedKept);
    };
    const auto failure = co_await store_.write(write);
    if (failure) co_return failure;
  }
  if (command.session == session_.number()) session_.discard(run_id, command.sequence, result);
  co_return std::nullopt;
}

}  // namespace cell
