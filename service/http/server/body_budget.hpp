#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace cell {

/// The memory that the bodies of requests may take together while they are received and answered. Of one
/// thread.
class BodyBudget {
 public:
  explicit BodyBudget(std::size_t bytes_max) : bytes_max_(bytes_max) {}
  BodyBudget(const BodyBudget&) = delete;
  BodyBudget& operator=(const BodyBudget&) = delete;

  [[nodiscard]] std::size_t claimed_bytes() const { return claimed_bytes_; }

 private:
  friend class BodyClaim;

  std::size_t bytes_max_;
  std::size_t claimed_bytes_ = 0;
};

/// What one body takes of the budget; given back at its end.
class BodyClaim {
 public:
  explicit BodyClaim(std::shared_ptr<BodyBudget> budget) : budget_(std::move(budget)) {}
  ~BodyClaim() { budget_->claimed_bytes_ -= bytes_; }
  BodyClaim(const BodyClaim&) = delete;
  BodyClaim& operator=(const BodyClaim&) = delete;

  /// The body has so many bytes now. False, and nothing more is claimed, if the budget has no room for them.
  [[nodiscard]] bool grow_to(std::size_t bytes) {
    if (bytes <= bytes_) return true;
    const std::size_t more = bytes - bytes_;
    if (more > budget_->bytes_max_ - budget_->claimed_bytes_) return false;
    budget_->claimed_bytes_ += more;
    bytes_ = bytes;
    return true;
  }

 private:
  std::shared_ptr<BodyBudget> budget_;
  std::size_t bytes_ = 0;
};

}  // namespace cell
