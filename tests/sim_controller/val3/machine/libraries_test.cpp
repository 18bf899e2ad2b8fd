// Libraries that are loaded, or not, while an application runs.
#include "sim_controller/val3/machine/libraries.hpp"

#include <gtest/gtest.h>

#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "tests/sim_controller/val3/files/project_folder.hpp"
#include "tests/val3/controller.hpp"

namespace val3 {
namespace {

std::string public_number(const std::string& name, const std::string& value) {
  return "<Data name=\"" + name +
         "\" access=\"public\" xsi:type=\"array\" type=\"num\" size=\"1\"><Value key=\"0\" value=\"" + value +
         "\"/></Data>\n";
}

/// A folder with an application, its library `one` (nPub 1, add() adds 1) and `two` (nPub 100, adds 100).
class LibrariesOf : public ::testing::Test {
 protected:
  LibrariesOf() {
    library("one", "1", "nPub=nPub+1\n");
    library("two", "100", "nPub=nPub+100\n");
  }
  void library(const std::string& name, const std::string& value, const std::string& code,
               const std::string& program = "add") {
    folder.project(name, "<Programs><Program file=\"" + program +
                             ".pgx\"/></Programs>\n<Database><Data file=\"" + name + ".dtx\"/></Database>\n");
    folder.data(name + "/" + name + ".dtx", public_number("nPub", value));
    folder.write(name + "/" + program + ".pgx",
                 "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
                 "<Programs xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\">\n<Program name=\"" +
                     program + "\" access=\"public\">\n<Code><![CDATA[begin\n" + code +
                     "end]]></Code></Program></Programs>\n");
  }
  /// `start` begins in line 4; n[8] and s[4] are its variables.
  void application(const std::string& start, bool autoload) {
    folder.small(
        "<Data name=\"n\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"8\"/>\n"
        "<Data name=\"s\" access=\"private\" xsi:type=\"array\" type=\"string\" size=\"4\"/>\n",
        std::string("<Libraries><Library alias=\"lib\" path=\"Disk://one/one.pjx\" autoload=\"") +
            (autoload ? "true" : "false") + "\"/></Libraries>\n");
    folder.program("app/start.pgx", start);
  }
  void run(const std::string& start, bool autoload = false) {
    application(start + "n[7]=1\nwait(false)\n", autoload);
    controller = std::make_unique<Controller>(
        folder.path() / "app" / "app.pjx", cabinet, [] {}, MachineLimits{});
    controller->machine().start();
    for (int i = 0; i < 20; ++i) controller->tick();
  }
  [[nodiscard]] double number(std::size_t index) { return controller->machine().number("n", index); }
  [[nodiscard]] std::string text(std::size_t index) { return controller->machine().text("s", index); }
  [[nodiscard]] int status() { return controller->machine().task_status("app~"); }
  /// What the machine does not simulate of an application, "start.pgx:5".
  std::vector<std::string> refused(const std::string& start) {
    application(start, true);
    ReadApplication read = folder.read();
    resolve(read.application, read.findings);
    Findings findings;
    const Machine machine(read.application, cabinet, findings);
    std::vector<std::string> places;
    for (const Finding& one : findings) places.push_back(one.at.file + ":" + std::to_string(one.at.line));
    return places;
  }

  ProjectFolder folder;
  Cabinet cabinet;
  std::unique_ptr<Controller> controller;
};

TEST_F(LibrariesOf, OneThatIsNotLoadedIsError80UntilItIs) {
  run("n[0]=1\nlib:nPub=5\nn[0]=2\n");
  EXPECT_EQ(status(), kErrorNoLibrary);
  EXPECT_EQ(number(0), 1);
  run("n[0]=1\ncall lib:add()\nn[0]=2\n");
  EXPECT_EQ(status(), kErrorNoLibrary);
  run("n[0]=lib:libLoad(\"one\")\nn[1]=lib:nPub\ncall lib:add()\nn[2]=lib:nPub\ns[0]=lib:libPath()\n");
  EXPECT_EQ(status(), 1);
  EXPECT_EQ(number(0), 0);
  EXPECT_EQ(number(1), 1);
  EXPECT_EQ(number(2), 2);
  EXPECT_EQ(text(0), "one");
}

TEST_F(LibrariesOf, OneWithAutoloadIsThereFromTheStart) {
  run("call lib:add()\nn[0]=lib:nPub\ns[0]=lib:libPath()\ns[1]=libPath()\n", true);
  EXPECT_EQ(number(0), 2);
  EXPECT_EQ(text(0), "Disk://one/one.pjx");
  EXPECT_EQ(text(1), "Disk://app");
}

TEST_F(LibrariesOf, AnotherProjectTakesTheAliasAndLoadingAgainGivesItsDataBack) {
  run("call lib:add()\nn[0]=lib:nPub\nn[1]=lib:libLoad(\"two\")\ncall lib:add()\nn[2]=lib:nPub\n"
      "n[3]=lib:libLoad(\"one\")\nn[4]=lib:nPub\n",
      true);
  EXPECT_EQ(number(0), 2);
  EXPECT_EQ(number(1), 0);
  EXPECT_EQ(number(2), 200);
  EXPECT_EQ(number(3), 0);
  EXPECT_EQ(number(4), 1) << "loading initialises its globals";
}

TEST_F(LibrariesOf, WhatWasSavedIsThereWhenItIsLoadedAgain) {
  run("lib:nPub=7\nn[0]=lib:libSave()\nlib:nPub=8\nn[1]=lib:libLoad(\"one\")\nn[2]=lib:nPub\n", true);
  EXPECT_EQ(number(0), 0);
  EXPECT_EQ(number(1), 0);
  EXPECT_EQ(number(2), 7);
  run("n[0]=lib:libSave()\n");
  EXPECT_EQ(number(0), 10) << "it is not loaded";
}

TEST_F(LibrariesOf, OneThatIsNotThereOrHasAnotherInterfaceSaysSo) {
  library("other", "3", "", "sub");
  run("n[0]=lib:libLoad(\"nowhere\")\nn[1]=lib:nPub\nn[2]=lib:libLoad(\"other\")\nn[3]=lib:nPub\n"
      "if lib:libExist(\"sub()\")\nn[4]=1\nendIf\nif lib:libExist(\"add()\")\nn[4]=2\nendIf\ncall "
      "lib:add()\n",
      true);
  EXPECT_EQ(number(0), 39);
  EXPECT_EQ(number(1), 1) << "the one before stays";
  EXPECT_EQ(number(2), 11);
  EXPECT_EQ(number(3), 3);
  EXPECT_EQ(number(4), 1);
  EXPECT_EQ(status(), kErrorNoLibrary);
}

TEST_F(LibrariesOf, OneThatIsLoadedAgainHasTheSizesOfItsFiles) {
  run("append(lib:nPub)\nappend(lib:nPub)\nn[0]=size(lib:nPub)\nn[1]=lib:libLoad(\"one\")\nn[2]=size(lib:"
      "nPub)\n",
      true);
  EXPECT_EQ(number(0), 3);
  EXPECT_EQ(number(1), 0);
  EXPECT_EQ(number(2), 1);
}

TEST_F(LibrariesOf, ACollectionOfOneThatIsLoadedAgainHasItsKeys) {
  folder.data("one/one.dtx", public_number("nPub", "1") +
                                 "<Data name=\"cPub\" access=\"public\" xsi:type=\"collection\" type=\"num\">"
                                 "<Value key=\"a\" value=\"5\"/><Value key=\"b\" value=\"6\"/></Data>\n");
  run("append(lib:cPub)\nlib:cPub[\"b\"]=7\nn[0]=lib:libLoad(\"one\")\nn[1]=lib:cPub[\"a\"]\nn[2]=lib:cPub["
      "\"b\"]\n"
      "n[3]=size(lib:cPub)\n",
      true);
  EXPECT_EQ(number(0), 0);
  EXPECT_EQ(number(1), 5);
  EXPECT_EQ(number(2), 6);
  EXPECT_EQ(number(3), 2);
}

TEST_F(LibrariesOf, OneInWhichATaskIsIsNotReplaced) {
  library("one", "1", "wait(nPub>5)\n");
  run("taskCreate \"t\",10,lib:add()\ndelay(0)\nn[0]=lib:libLoad(\"two\")\nlib:nPub=9\ndelay(0)\ndelay(0)\n"
      "n[1]=lib:libLoad(\"two\")\n",
      true);
  EXPECT_EQ(number(0), 13);
  EXPECT_EQ(number(1), 0);
}

TEST_F(LibrariesOf, OneThatIsNotSimulatedFailsWhereItIsLoadedWithItsPlace) {
  library("two", "1", "nPub=alterEnd()\n");
  run("n[0]=1\nn[1]=lib:libLoad(\"two\")\nn[0]=2\n", true);
  EXPECT_EQ(status(), kErrorInterpreter);
  EXPECT_EQ(number(0), 1);
  ASSERT_EQ(controller->machine().tasks().size(), 1U);
  const std::string error = controller->machine().tasks()[0].error;
  EXPECT_NE(error.find("add.pgx:5: alterEnd"), std::string::npos) << error;
}

TEST_F(LibrariesOf, ASecondStartFindsLibrariesAsTheProjectDeclaresThem) {
  run("n[1]=n[1]+1\nn[n[1]+1]=lib:nPub\nn[0]=lib:libLoad(\"two\")\n", true);
  controller->machine().start();
  for (int i = 0; i < 5; ++i) controller->tick();
  EXPECT_EQ(number(1), 2);
  EXPECT_EQ(number(2), 1);
  EXPECT_EQ(number(3), 1);
}

TEST_F(LibrariesOf, WhatIsNotSimulatedIsRefusedWithItsLine) {
  EXPECT_EQ(refused("n[0]=lib:libLoad(s[0])\n"), std::vector<std::string>{"start.pgx:5"});
  EXPECT_EQ(refused("n[0]=1\nn[0]=libSave(\"copy\")\n"), std::vector<std::string>{"start.pgx:6"});
  EXPECT_EQ(refused("n[0]=libDelete(\"one\")\n"), std::vector<std::string>{"start.pgx:5"});
  folder.write("shut/shut.zip", "PK");
  EXPECT_EQ(refused("n[0]=lib:libLoad(\"shut/shut\",\"pw\")\n"), std::vector<std::string>{"start.pgx:5"});
}

}  // namespace
}  // namespace val3
