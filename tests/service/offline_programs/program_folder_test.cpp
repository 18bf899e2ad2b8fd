#include "service/offline_programs/program_folder.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string project(const std::string& unit) {
  return "<Project xmlns=\"http://www.staubli.com/robotics/VAL3/Project/3\"><Parameters version=\"s7.7.2\" " +
         unit + "/></Project>";
}

TEST(ProgramFolder, HoldsTheProgramsBesideTheDataFile) {
  const Folder folder;
  folder.write("cell/b.PGX", "B");
  folder.write("cell/a.pgx", "A");
  folder.write("cell/a.txt", "no program");
  folder.write("cell/below/c.pgx", "C");
  folder.write("cell/cell.pjx", project("millimeterUnit=\"true\""));
  const ProgramFolder found = read_program_folder(folder.path() / "cell/cell.dtx");
  ASSERT_EQ(found.programs.size(), 2U);
  EXPECT_EQ(found.programs[0].name, "a.pgx");
  EXPECT_EQ(found.programs[0].bytes, "A");
  EXPECT_EQ(found.programs[1].name, "b.PGX");
  EXPECT_EQ(found.mm_per_unit, 1.0);
  EXPECT_THAT(found.notes, IsEmpty());
}

TEST(ProgramFolder, KnowsTheUnitOfTheProject) {
  const Folder folder;
  const auto data = folder.path() / "cell.dtx";
  EXPECT_THAT(read_program_folder(data).notes,
              ElementsAre(HasSubstr("no project (.pjx) beside the data file")));
  folder.write("cell.pjx", project("millimeterUnit=\"false\""));
  EXPECT_EQ(read_program_folder(data).mm_per_unit, 25.4);
  folder.write("cell.pjx",
               "<project xmlns=\"ProjectNameSpace\"><parameters version=\"s6.8\" "
               "millimeterUnit=\"false\"/></project>");
  EXPECT_EQ(read_program_folder(data).mm_per_unit, 25.4);
  folder.write("other.pjx", project("millimeterUnit=\"true\""));
  EXPECT_THAT(std::string(error_of([&] { read_program_folder(data); }).what()),
              HasSubstr("counts in another unit"));
  folder.write("cell.pjx", project("millimeterUnit=\"ell\""));
  EXPECT_THAT(std::string(error_of([&] { read_program_folder(data); }).what()),
              HasSubstr("cell.pjx:1: millimeterUnit is \"ell\"; write true or false"));
}

TEST(ProgramFolder, TellsOfAProgramThatIsTooLargeToRead) {
  const Folder folder;
  folder.write("large.pgx", std::string(kVal3FileBytesMax + 1, ' '));
  const ProgramFolder found = read_program_folder(folder.path() / "cell.dtx");
  EXPECT_THAT(found.programs, IsEmpty());
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("large.pgx: larger than"), HasSubstr("no project")));
}

}  // namespace
}  // namespace cell
