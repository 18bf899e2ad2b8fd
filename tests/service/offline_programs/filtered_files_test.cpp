#include "service/offline_programs/filtered_files.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kListText = "pA offline\n";
const std::string kOriginal =
    new_data(variable("pA", "pointRx", value("key=\"0\" x=\"1\" fatherId=\"world[0]\"")));

/// A data file and its list in a folder, and what a filter made of them.
struct FilterBench {
  Folder folder;
  FilteredFiles files{folder.write("cell.dtx", kOriginal), folder.write("points.list", kListText),
                      folder.path() / "out.dtx"};
  FilteredData data = filtered(kOriginal, kListText, shifted_by({1, 0, 0}));
  void write() const { write_filtered(files, kListText, data); }
  [[nodiscard]] std::string refusal() const {
    try {
      write();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  }
};

TEST(FilteredFiles, AreTheResultAndTheMarkBesideTheOriginal) {
  FilterBench bench;
  std::filesystem::permissions(bench.files.data_file, std::filesystem::perms(0640));
  std::filesystem::permissions(bench.files.list_file, std::filesystem::perms(0644));
  bench.write();
  EXPECT_EQ(bytes_of(bench.files.out_file), bench.data.text);
  EXPECT_EQ(bytes_of(bench.files.data_file), kOriginal);
  EXPECT_EQ(bytes_of(bench.files.list_file), with_filtered_mark(kListText, bench.data.mark));
  EXPECT_EQ(std::filesystem::status(bench.files.out_file).permissions(), std::filesystem::perms(0640));
  EXPECT_EQ(std::filesystem::status(bench.files.list_file).permissions(), std::filesystem::perms(0644));
  const std::string record = bytes_of(bench.folder.path() / "out.dtx.filtered");
  EXPECT_EQ(parse_filter_list("record", record).points.at(0).sha256, bench.data.mark.points.at(0).sha256);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(bench.folder.path()), {}), 4) << "nothing else";
  bench.files.overwrite = true;
  bench.write();
  EXPECT_EQ(bytes_of(bench.folder.path() / "out.dtx.filtered"), record) << "once is enough";
}

TEST(FilteredFiles, DoNotReplaceWhatIsThereUnlessTheyAreTold) {
  FilterBench bench;
  bench.folder.write("out.dtx", "older");
  EXPECT_THAT(bench.refusal(), HasSubstr("out.dtx exists; choose another name or give --force"));
  EXPECT_EQ(bytes_of(bench.files.out_file), "older");
  EXPECT_EQ(bytes_of(bench.files.list_file), kListText) << "nothing is marked that was not written";
  bench.files.overwrite = true;
  bench.write();
  EXPECT_EQ(bytes_of(bench.files.out_file), bench.data.text);
}

TEST(FilteredFiles, NeverReplaceTheOriginalOrTheListByAnyName) {
  FilterBench bench;
  bench.files.overwrite = true;
  bench.files.out_file = bench.folder.path() / "sub/../cell.dtx";
  std::filesystem::create_directory(bench.folder.path() / "sub");
  EXPECT_THAT(bench.refusal(), HasSubstr("is the original, which is never written"));
  bench.files.out_file = bench.folder.path() / "link.dtx";
  std::filesystem::create_symlink("cell.dtx", bench.files.out_file);
  EXPECT_THAT(bench.refusal(), HasSubstr("is the original"));
  bench.files.out_file = bench.files.list_file;
  EXPECT_THAT(bench.refusal(), HasSubstr("is the list"));
  bench.files.out_file = bench.folder.path() / "sub";
  EXPECT_THAT(bench.refusal(), HasSubstr("is no regular file"));
  EXPECT_EQ(bytes_of(bench.files.data_file), kOriginal);
}

// Writing that breaks off at its first, at its second file: what was there stays whole.
TEST(FilteredFiles, LeaveTheOldOnesWhereTheyCannotBeWritten) {
  FilterBench bench;
  bench.files.overwrite = true;
  bench.folder.write("out.dtx", "older");
  std::filesystem::create_directory(bench.folder.path() / "out.dtx.new");
  EXPECT_THROW(bench.write(), std::runtime_error);
  EXPECT_EQ(bytes_of(bench.files.out_file), "older");
  EXPECT_EQ(bytes_of(bench.files.list_file), with_filtered_mark(kListText, bench.data.mark))
      << "a mark without its file harms nothing";
  std::filesystem::create_directory(bench.folder.path() / "points.list.new");
  bench.folder.write("points.list", kListText);
  EXPECT_THROW(bench.write(), std::runtime_error);
  EXPECT_EQ(bytes_of(bench.files.list_file), kListText);
}

TEST(FilteredFiles, MarkTheListItselfWhereItIsALink) {
  FilterBench bench;
  bench.files.list_file = bench.folder.path() / "link.list";
  std::filesystem::create_symlink("points.list", bench.files.list_file);
  bench.write();
  EXPECT_TRUE(std::filesystem::is_symlink(bench.files.list_file));
  EXPECT_THAT(bytes_of(bench.folder.path() / "points.list"), HasSubstr("# filtered "));
}

}  // namespace
}  // namespace cell
