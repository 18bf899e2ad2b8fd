#pragma once

#include <chrono>
#include <vector>

#include "config/cell.hpp"
#include "service/store/outbox.hpp"

namespace cell {

/// So long before it ends a certificate is told of.
inline constexpr std::chrono::days kCertificateNotice{30};

/// The certificates of the block and of the probe that end within kCertificateNotice, or have ended: those
/// whose free texts have `valid_until`, YYYY-MM-DD. Another text there says no time, and nothing is told.
std::vector<ExpiringCertificate> expiring_certificates(const Cell& cell,
                                                       std::chrono::system_clock::time_point now);

}  // namespace cell
