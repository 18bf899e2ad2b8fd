#include "service/run/expiring_certificates.hpp"

#include <map>
#include <string>
#include <utility>

#include "config/utc_text.hpp"
#include "service/base/utc_time.hpp"

namespace cell {

std::vector<CertificateEnd> certificate_ends(const Cell& cell) {
  std::vector<CertificateEnd> ends;
  for (const auto& [artefact, certificate] :
       {std::pair("block", &cell.block.certificate), std::pair("probe", &cell.probe.certificate)}) {
    const auto until = certificate->find("valid_until");
    if (until == certificate->end()) continue;
    const auto last_day = time_from_utc(until->second + "T00:00:00Z");
    if (last_day) ends.push_back({artefact, until->second, *last_day + std::chrono::days(1)});
  }
  return ends;
}

std::vector<ExpiringCertificate> expiring_certificates(const Cell& cell,
                                                       std::chrono::system_clock::time_point now) {
  constexpr std::size_t kDateLength = 10;
  const std::string soon = format_utc(now + kCertificateNotice).substr(0, kDateLength);
  std::vector<ExpiringCertificate> expiring;
  for (const CertificateEnd& end : certificate_ends(cell)) {
    if (end.valid_until <= soon) expiring.push_back({end.artefact, end.valid_until});
  }
  return expiring;
}

}  // namespace cell
