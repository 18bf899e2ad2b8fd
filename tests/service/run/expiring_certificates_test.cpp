#include "service/run/expiring_certificates.hpp"

#include <gmock/gmock.h>

#include "config/utc_text.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ExpiringCertificates, AreThoseThatEndWithinTheNotice) {
  const auto now = time_from_utc("2026-05-01T12:00:00Z").value();
  Cell cell;
  EXPECT_THAT(expiring_certificates(cell, now), IsEmpty());
  cell.block.certificate = {{"number", "1"}, {"valid_until", "2026-05-31"}};
  cell.probe.certificate = {{"valid_until", "2026-06-01"}};
  EXPECT_THAT(expiring_certificates(cell, now), ElementsAre(ExpiringCertificate{"block", "2026-05-31"}));
  cell.probe.certificate["valid_until"] = "2025-01-01";
  EXPECT_EQ(expiring_certificates(cell, now).size(), 2u) << "one that has ended";
  for (const char* text : {"", "never", "2026-13-01", "2026-5-1", "2026-05-31 or later"}) {
    cell.block.certificate["valid_until"] = text;
    EXPECT_THAT(expiring_certificates(cell, now), ElementsAre(ExpiringCertificate{"probe", "2025-01-01"}))
        << text;
  }
}

}  // namespace
}  // namespace cell
