// Arrays of s7: sizes, growing and shrinking, collections.
#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

TEST(Arrays, TellTheirSizesAndWhatIsLeftFromAnElement) {
  expect_values({{"size(n)", 20}, {"size(n[5])", 15}, {"size(j)", 4}});
  expect_errors({{"size(n,2)", kErrorParameter}, {"n[20]", kErrorIndex}, {"n[-1]", kErrorIndexNegative}});
  EXPECT_EQ(evaluated("n[5.9]", "n[5]=3").number, 3) << "the integer part is taken: manual 6, page 21";
}

TEST(Arrays, GrowAndShrink) {
  SmallProject project;
  project.number("n", 3).number("size", 6);
  project.program(
      "start",
      "n[0]=1\nn[1]=2\nn[2]=3\nappend(n)\nsize[0]=size(n)\nn[3]=4\ninsert(n[1])\nsize[1]=n[1]\n"
      "size[2]=n[2]\ndelete(n[0])\nsize[3]=n[0]\nsize[4]=size(n)\nresize(n,1,2)\nsize[5]=size(n)\nn[2]=0");
  Running run(project);
  run.ticks(2);
  const std::vector<double> expected{4, 0, 2, 0, 4, 2};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(run.number("size", i), expected[i]) << i;
  EXPECT_EQ(run.machine().task_status("small~"), kErrorIndex) << "the third element is gone";
  expect_errors({{"size(n)", kErrorRunMemory}}, "resize(n,1,2000000)");
}

TEST(Arrays, OfAUsersTypeGrowAsFarAsTheValuesOfTheirFields) {
  SmallProject type("pair");
  type.file_data("<Data name=\"n\" access=\"public\" xsi:type=\"array\" type=\"num\" size=\"99\"/>").write();
  SmallProject project;
  project.type(type).data("a", "pair", "").number("n", 2);
  project.program("start", "resize(a,1,10000)\nn[0]=size(a)\nresize(a,1,10001)\nn[0]=0");
  Running run(project);
  run.ticks(3);
  EXPECT_EQ(run.number("n", 0), 10'000) << run.log();
  EXPECT_EQ(run.machine().task_status("small~"), kErrorRunMemory) << "100 values each";
}

TEST(Arrays, OfMoreDimensionsStayAsTheyAreWhereAnElementCannotGo) {
  SmallProject project;
  project.file_data("<Data name=\"m\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"2 3\"/>");
  project.program("start", "m[0,1]=1\ndelete(m[0,0])");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorParameter);
  EXPECT_EQ(run.machine().number("m", 0), 0);
  EXPECT_EQ(run.machine().number("m", 1), 1);
}

TEST(Arrays, OfTwoDimensionsAreRowsAfterRows) {
  SmallProject project;
  project.file_data("<Data name=\"m\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"2 3\"/>");
  project.number("n", 4).program("start",
                                 "m[1,2]=5\nn[0]=m[1,2]\nn[1]=size(m,1)\nn[2]=size(m,2)\nn[3]=m[2,0]");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.number("n", 0), 5);
  EXPECT_EQ(run.number("n", 1), 2);
  EXPECT_EQ(run.number("n", 2), 3);
  EXPECT_EQ(run.machine().number("m", 5), 5) << "the last of six";
  EXPECT_EQ(run.machine().task_status("small~"), kErrorIndex);
}

TEST(Arrays, OfTwoDimensionsKeepTheirIndicesWhenOneOfThemChanges) {
  SmallProject project;
  project.file_data("<Data name=\"m\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"2 3\"/>");
  project.number("n", 8).program("start",
                                 "m[0,2]=2\nm[1,0]=3\nm[1,2]=5\nresize(m,2,4)\nn[0]=m[1,2]\nn[1]=m[0,3]\n"
                                 "n[2]=size(m,2)\nresize(m,1,3)\nn[3]=m[1,0]\nn[4]=m[2,0]\nresize(m,2,1)\n"
                                 "n[5]=m[1,0]\nn[6]=size(m,1)\nresize(m,3,1)");
  Running run(project);
  run.ticks(2);
  const std::vector<double> expected{5, 0, 4, 3, 0, 3, 3};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(run.number("n", i), expected[i]) << i;
  EXPECT_EQ(run.machine().task_status("small~"), kErrorParameter) << "it has two dimensions";
}

TEST(Arrays, ACollectionFindsItsElementsByKey) {
  SmallProject project;
  project.file_data(
      "<Data name=\"c\" access=\"private\" xsi:type=\"collection\" type=\"num\">"
      "<Value key=\"one\" value=\"1\"/><Value key=\"two\" value=\"2\"/></Data>");
  project.number("n", 3).data("s", "string", "", 3);
  project.program("start",
                  "n[0]=c[\"two\"]\nc[\"one\"]=7\nn[1]=c[\"one\"]\ns[0]=first(c)\ns[1]=next(c[s[0]])\n"
                  "s[2]=next(c[s[1]])\nn[2]=c[\"none\"]");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.number("n", 0), 2);
  EXPECT_EQ(run.number("n", 1), 7);
  EXPECT_EQ(run.text("s", 0) + "," + run.text("s", 1) + "," + run.text("s", 2), "one,two,");
  EXPECT_EQ(run.machine().task_status("small~"), kErrorIndex);
}

TEST(Arrays, AreFoundByTheirNameAndCopiedAsFarAsTheyFit) {
  const std::string before = "n[4]=7\nn[5]=8\nn[6]=9\n";
  EXPECT_EQ(evaluated("getData(\"n[4]\",n[10])", before).number, 10) << "ten are left behind n[10]";
  EXPECT_EQ(evaluated("getData(\"n[4]\",n[17])*100+n[17]*10+n[18]", before).number, 378) << "of three fit";
  EXPECT_EQ(evaluated("getData(\"n[18]\",n[1])").number, 2) << "two are there";
  expect_values({{"getData(\"none\",n[1])", -1},
                 {"getData(\"lib:n\",n[1])", -2},
                 {"getData(\"n[20]\",n[1])", -3},
                 {"getData(\"n[x]\",n[1])", -3},
                 {"getData(\"n[-1]\",n[1])", -3},
                 {"getData(\"s\",n[1])", -4}});
}

}  // namespace
}  // namespace val3
