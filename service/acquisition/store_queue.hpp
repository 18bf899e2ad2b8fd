#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "service/acquisition/late_warning.hpp"
#include "service/base/run_on.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// The store as the control thread sees it: what is to be written or read is done on the store's own thread,
/// in the order in which it was asked for. So a slow disk makes the run wait, and neither the link nor a
/// stop. What is asked for must refer to nothing that the control thread may change meanwhile: it holds
/// values.
class StoreQueue {
 public:
  /// At most so many are waited for by nobody. What comes on top is left out and logged: the disk has stood
  /// still for minutes then.
  static constexpr int kBehindMax = 64;

  /// `store` must outlive the executor's work. A test gives its one executor.
  StoreQueue(RunStore& store, boost::asio::any_io_executor executor)
      : store_(store),
        executor_(std::move(executor)),
        faults_(std::make_shared<FaultLog>(store.database())) {}

  /// After so long the status warns of a disk that is waited for (FaultCode::kStoreSlow), until it is done.
  static constexpr std::chrono::seconds kUntoldMax{5};
  /// Warns so from now on; call it before the first work. Both are of the caller's thread.
  void tell_when_slow(PublishedStatus& status, std::unique_ptr<Alarm> alarm) {
    late_ = std::make_shared<LateWarning>(FaultCode::kStoreSlow, kUntoldMax, status, std::move(alarm));
  }

  /// Returns what `work(store)` returned or threw, when it is done. Each run has one loop, which waits: no
  /// bound is needed.
  template <std::invocable<RunStore&> Work>
  boost::asio::awaitable<std::invoke_result_t<Work, RunStore&>> run(Work work) {
    auto done = run_on(executor_, [&store = store_, waits = count_one(), work = std::move(work)]() mutable {
      const auto until_done = std::move(waits);
      return work(store);
    });
    return late_ ? late_->told_when_late("the disk has not taken what is to be stored", std::move(done))
                 : std::move(done);
  }
  /// The same for what only writes: why it failed, nothing when it is done.
  boost::asio::awaitable<std::optional<std::string>> write(std::function<void(RunStore&)> work);
  /// A write that is under way.
  class Begun {
   public:
    Begun() = default;

   private:
    friend class StoreQueue;
    /// Why it failed; of the store's thread.
    std::shared_ptr<std::optional<std::string>> failure_ = std::make_shared<std::optional<std::string>>();
  };
  /// Begins a write and returns at once, so that something is computed meanwhile; finish() has to follow.
  /// What it refers to must live until then.
  Begun begin(std::function<void(RunStore&)> work);
  /// Waits for a write that was begun: why it failed, nothing when it is done. `behind` is done on the same
  /// way, unless the write failed; what it throws is logged, so it says itself that it was done.
  boost::asio::awaitable<std::optional<std::string>> finish(Begun begun,
                                                            std::function<void(RunStore&)> behind = {});
  /// Begins a write for which no coroutine waits: `then` is called on `caller` with why it failed, nothing
  /// when it is done. The caller keeps to one at a time.
  void write_then(std::function<void(RunStore&)> work, boost::asio::any_io_executor caller,
                  std::function<void(std::optional<std::string>)> then);
  /// Nobody waits for it; what it throws is logged. False when it was left out.
  bool behind(std::function<void(RunStore&)> work);

  /// Nobody waits for a fault either. One that cannot be stored is stored behind a later write that works.
  void append_fault(StoredFault fault);

  /// How much was asked for and is not done; of any thread, and also when the queue has gone.
  [[nodiscard]] std::shared_ptr<const std::atomic<int>> waiting_count() const { return waiting_count_; }

  /// For the thread that owns everything before the store's own begins, and in tests of one thread.
  [[nodiscard]] RunStore& store() { return store_; }
  [[nodiscard]] const RunStore& store() const { return store_; }

 private:
  /// Counts as waiting until its last copy has gone.
  [[nodiscard]] std::shared_ptr<void> count_one() const;

  RunStore& store_;
  boost::asio::any_io_executor executor_;
  std::shared_ptr<FaultLog> faults_;  // of the store's thread
  std::shared_ptr<LateWarning> late_;
  std::shared_ptr<std::atomic<int>> behind_count_ = std::make_shared<std::atomic<int>>(0);
  std::shared_ptr<std::atomic<int>> waiting_count_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace cell
