#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/store/outbox.hpp"

namespace cell {

/// So long before it ends a certificate is told of.
inline constexpr std::chrono::days kCertificateNotice{30};

/// When the certificate of an artefact ends.
struct CertificateEnd {
  std::string artefact;                           // "block", "probe"
  std::string valid_until;                        // the last day, YYYY-MM-DD
  std::chrono::system_clock::time_point ends_at;  // the end of that day, UTC
};

/// Of the block and of the probe, where its free texts have `valid_until`, YYYY-MM-DD. Another text there
/// says no time, and nothing is told.
std::vector<CertificateEnd> certificate_ends(const Cell& cell);

/// Those of certificate_ends() that end within kCertificateNotice, or have ended.
std::vector<ExpiringCertificate> expiring_certificates(const Cell& cell,
                                                       std::chrono::system_clock::time_point now);

}  // namespace cell
