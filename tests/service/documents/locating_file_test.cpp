#include "service/documents/locating_file.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "config/config_error.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

LocatingRecord two_touches() {
  return {.config_digest = "digest",
          .from_place = std::nullopt,
          .touches = {{{1, -2, 3, -4, 5, 179'999'999}, 0.1 + 0.2, "2026-11-24T08:00:00.000Z"},
                      {{0, 0, 0, 0, 0, -2'147'483'647}, std::nullopt, "2026-11-24T08:01:00.000Z"}}};
}

class LocatingFile : public ::testing::Test {
 protected:
  [[nodiscard]] std::string bytes() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void put(const std::string& bytes) const { std::ofstream(file_) << bytes; }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "locating.json";
};

TEST_F(LocatingFile, GivesBackEveryTouchToTheLastBit) {
  EXPECT_FALSE(read_locating(file_)) << "there is none yet";
  const LocatingRecord written = two_touches();
  write_locating(file_, written);
  const LocatingRecord read = read_locating(file_).value();
  EXPECT_EQ(read.config_digest, written.config_digest);
  EXPECT_EQ(read.from_place, written.from_place);
  ASSERT_EQ(read.touches.size(), written.touches.size());
  for (std::size_t i = 0; i < written.touches.size(); ++i) {
    EXPECT_EQ(read.touches[i].joints, written.touches[i].joints);
    EXPECT_EQ(read.touches[i].moved_m, written.touches[i].moved_m);
    EXPECT_EQ(read.touches[i].touched_at, written.touches[i].touched_at);
  }
}

TEST_F(LocatingFile, IsRefusedOnceAnythingInItHasChanged) {
  write_locating(file_, two_touches());
  std::string changed = bytes();
  changed.replace(changed.find("179999999"), 9, "179999998");
  put(changed);
  EXPECT_THROW(read_locating(file_), ConfigError);
  put(changed.substr(0, changed.size() / 2));
  EXPECT_THROW(read_locating(file_), ConfigError);
  put("");
  EXPECT_THROW(read_locating(file_), ConfigError);
}

}  // namespace
}  // namespace cell
