// Mistakes that are written out, which fail whenever their line is reached.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_controller/val3/files/built_in_io.hpp"
#include "tests/sim_controller/val3/checks/checked_cell.hpp"

namespace val3 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// The cell with an input, an output and arrays.
SmallApplication wired_cell() {
  SmallApplication small = cell();
  for (const auto& [name, link] : std::vector<std::pair<std::string_view, std::string>>{
           {"dIn", "BasicIO-1\\%I3"}, {"dOut", "BasicIO-1\\%Q3"}, {"dBus", "J206\\something"}}) {
    small.global("dio", name);
    small.application.globals.back().values.push_back(stored("link", link));
  }
  small.global("num", "nA", {3}).global("num", "nTable", {2, 4});
  for (std::size_t i = small.application.globals.size() - 2; i < small.application.globals.size(); ++i)
    small.application.globals[i].values.push_back(stored("value", "1"));
  return small;
}

std::vector<std::string> found_by(std::string_view code) {
  return found_in(wired_cell().program("start", code));
}

TEST(ConstantChecks, AnIndexOutsideOfItsArrayIsFound) {
  EXPECT_THAT(found_by("n=nA[3]"), ElementsAre("start.pgx:2 constant-index"));
  EXPECT_THAT(found_by("nA[-1]=n"), ElementsAre("start.pgx:2 constant-index"));
  EXPECT_THAT(found_by("n=nTable[1,4]+nTable[2,0]"),
              ElementsAre("start.pgx:2 constant-index", "start.pgx:2 constant-index"));
  EXPECT_THAT(found_by("n=nA[2.9]+nA[0]+nTable[1,3]+nA[n]"), IsEmpty()) << "the integer part counts";
  EXPECT_THAT(found_by("resize(nA,1,9)\nn=nA[7]"), IsEmpty()) << "its size changes";
  EXPECT_THAT(found_by("append(nA)\nn=nA[-2]"), ElementsAre("start.pgx:3 constant-index"));
}

TEST(ConstantChecks, AnArrayThatIsPassedByReferenceMayGrow) {
  for (const char* grows : {"resize(x_nA,1,9)", "append(x_nA)"}) {
    SmallApplication small = wired_cell();
    small.program("grow", grows, {small.reference("num", "x_nA", 1)});
    small.program("start", "call grow(nA)\nn=nA[3]\nl_n=1\ncall grow(l_n)\nl_n[1]=2\nl_nKept=1\nl_nKept[1]=n",
                  {}, {{"num", "l_n"}, {"num", "l_nKept"}});
    EXPECT_THAT(found_in(std::move(small)), ElementsAre("start.pgx:8 constant-index")) << grows;
  }
}

TEST(ConstantChecks, DataOfALibraryMayBeOfAnotherSizeWhenItIsLoadedAnew) {
  SmallApplication there;
  there.global("num", "nParts", {3}, true);
  there.application.globals.back().values.push_back(stored("value", "1"));
  SmallApplication small = wired_cell();
  small.library("lib", std::make_shared<Application>(std::move(there.application)));
  small.program("start", "n=lib:nParts[5]\nn=lib:nParts[-1]");
  EXPECT_THAT(found_in(std::move(small)), ElementsAre("start.pgx:3 constant-index"));
}

TEST(ConstantChecks, ALocalOutsideOfItsSizeIsFound) {
  SmallApplication small = wired_cell();
  small.program("start", "l_n=1\nl_n[1]=2", {}, {{"num", "l_n"}});
  EXPECT_THAT(found_in(std::move(small)), ElementsAre("start.pgx:3 constant-index"));
}

TEST(ConstantChecks, ADimensionThatIsNotThereIsFound) {
  EXPECT_THAT(found_by("n=size(nA,3)"), ElementsAre("start.pgx:2 constant-index"));
  EXPECT_THAT(found_by("n=size(nA,0)"), ElementsAre("start.pgx:2 constant-index"));
  EXPECT_THAT(found_by("n=size(nA,1)+size(nTable,2)+size(nA)"), IsEmpty());
}

TEST(ConstantChecks, ADivisionByAWrittenZeroIsFound) {
  EXPECT_THAT(found_by("n=1/0"), ElementsAre("start.pgx:2 division-by-zero"));
  EXPECT_THAT(found_by("if n%0>1\nn=0/4\nendIf"), ElementsAre("start.pgx:2 division-by-zero"));
  EXPECT_THAT(found_by("n=1/nOther"), IsEmpty());
}

TEST(ConstantChecks, AnInputThatIsWrittenIsFoundByItsLink) {
  EXPECT_THAT(found_by("dIn=true"), ElementsAre("start.pgx:2 write-to-input"));
  EXPECT_THAT(found_by("n=dioSet(dIn,1)"), ElementsAre("start.pgx:2 write-to-input"));
  EXPECT_THAT(found_by("dOut=dIn\ndBus=true\nb=dIn"), IsEmpty());
  SmallApplication small = wired_cell();
  small.program("start", "dioLink(dIn,dOut)\ndIn=true");
  Findings findings;
  resolve(small.application, findings);
  check(small.application, {}, findings);
  std::erase_if(findings, [](const Finding& one) { return one.rule != "write-to-input"; });
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].severity, Severity::kNote) << "it may be linked to an output by then";
}

TEST(ConstantChecks, AnInputOfTheLibraryIoThatIsWrittenIsFound) {
  SmallApplication small = wired_cell();
  small.application.form = 5;
  small.library("io", built_in_io(small.application));
  small.program("start", "io:bIn3=true\nio:bOut3=true");
  EXPECT_THAT(found_in(std::move(small)), ElementsAre("start.pgx:2 write-to-input"));
}

TEST(ConstantChecks, WorldAndFlangeAreFixed) {
  EXPECT_THAT(found_by("world.trsf.x=5\nflange.trsf={0,0,9,0,0,0}\np.trsf.x=5"),
              ElementsAre("start.pgx:2 fixed-frame", "start.pgx:3 fixed-frame"));
}

TEST(ConstantChecks, ACallOfItselfThatNothingDecidesAboutIsFound) {
  EXPECT_THAT(found_by("n=1\ncall start()"), ElementsAre("start.pgx:3 endless-recursion"));
  SmallApplication small = wired_cell();
  small.program("start", "call deep()");
  small.program("deep", "n=n-1\nif n>0\ncall deep()\nendIf");
  EXPECT_THAT(found_in(small), IsEmpty());
  small.application.programs.pop_back();
  small.program("deep", "if n<0\nreturn\nendIf\nn=n-1\ncall deep()");
  EXPECT_THAT(found_in(small), IsEmpty());
  small.application.programs.pop_back();
  small.program("deep", "do\ncall deep()\nwait(b)\nuntil b");
  EXPECT_THAT(found_in(small), ElementsAre("deep.pgx:3 endless-recursion"));
}

TEST(ConstantChecks, LocalsThatRunMemoryDoesNotHoldAreFound) {
  SmallApplication small = wired_cell();
  small.program("start", "call large()");
  small.program("large", "l_n=1\nn=l_n", {}, {{"num", "l_n"}});
  small.application.programs.back().locals[0].sizes = {100'000};
  EXPECT_THAT(found_in(small), ElementsAre("large.pgx:1 run-memory"));
  small.application.stack_bytes = 1'000'000;
  EXPECT_THAT(found_in(small), IsEmpty());
  small.application.stack_bytes = 0;
  small.application.project = "small.pjx";
  EXPECT_THAT(found_in(std::move(small)), ElementsAre("large.pgx:1 run-memory", "small.pjx:0 run-memory"));
}

/// "warning large.pgx:1", of run memory.
std::vector<std::string> run_memory_in(SmallApplication small) {
  Findings findings = std::move(small.findings);
  resolve(small.application, findings);
  check(small.application, {}, findings);
  std::vector<std::string> all;
  for (const Finding& one : findings)
    if (one.rule == "run-memory")
      all.push_back((one.severity == Severity::kNote      ? "note "
                     : one.severity == Severity::kWarning ? "warning "
                                                          : "error ") +
                    one.at.file + ": " + one.what);
  return all;
}

TEST(ConstantChecks, RunMemoryIsThatOfAnApplicationThatStarts) {
  SmallApplication small = wired_cell();
  small.application.stack_bytes = 0;
  small.application.project = "small.pjx";
  small.program("large", "l_n=1\nn=l_n", {}, {{"num", "l_n"}});
  small.application.programs.back().locals[0].sizes = {100'000};
  EXPECT_THAT(run_memory_in(small), IsEmpty()) << "a library's programs run in its user's memory";
  small.application.programs.back().name = "start";
  EXPECT_THAT(run_memory_in(std::move(small)),
              UnorderedElementsAre(
                  "note small.pjx: stackSize is 0: it is taken as 5000 here",
                  "warning large.pgx: start takes at least 800048 bytes of run memory by itself, and "
                  "stackSize is 5000"));
}

}  // namespace
}  // namespace val3
