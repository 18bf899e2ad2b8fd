#include "service/run/expiring_certificates.hpp"

#include <map>
#include <string>
#include <utility>

#include "config/utc_text.hpp"
#include "service/base/utc_time.hpp"

namespace cell {

std::vector<ExpiringCertificate> expiring_certificates(const Cell& cell,
                                                       std::chrono::system_clock::time_point now) {
  constexpr std::size_t kDateLength = 10;
  const std::string soon = format_utc(now + kCertificateNotice).substr(0, kDateLength);
  std::vector<ExpiringCertificate> expiring;
  for (const auto& [artefact, certificate] :
       {std::pair("block", &cell.block.certificate), std::pair("probe", &cell.probe.certificate)}) {
    const auto until = certificate->find("valid_until");
    if (until == certificate->end() || !time_from_utc(until->second + "T00:00:00Z")) continue;
    if (until->second <= soon) expiring.push_back({artefact, until->second});
  }
  return expiring;
}

}  // namespace cell
