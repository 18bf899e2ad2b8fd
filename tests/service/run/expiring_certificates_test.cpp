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

TEST(CertificateEnds, AreTheEndsOfTheLastDays) {
  Cell cell;
  EXPECT_THAT(certificate_ends(cell), IsEmpty());
  cell.probe.certificate = {{"valid_until", "2026-05-31"}};
  cell.block.certificate = {{"valid_until", "by the end of May"}};
  const auto ends = certificate_ends(cell);
  ASSERT_EQ(ends.size(), 1u);
  EXPECT_EQ(ends[0].artefact, "probe");
  EXPECT_EQ(ends[0].valid_until, "2026-05-31");
  EXPECT_EQ(ends[0].ends_at, time_from_utc("2026-06-01T00:00:00Z"));
}

}  // namespace
}  // namespace cell
