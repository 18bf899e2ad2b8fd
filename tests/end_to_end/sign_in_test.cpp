// People who sign in at the real daemon: made by the command line, through a restart, and at once nobody when
// they are removed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/ip/tcp.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/service/raw_http.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SignIn : public ::testing::Test {
 protected:
  SignIn() { start(); }

  void start() {
    daemon_ = std::make_unique<Process>(
        std::vector<std::string>{"touchcald", "--cell",
                                 std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json", "--state",
                                 state(), "--listen", "127.0.0.1:0", "--controller", "127.0.0.1:9"},
        folder_ / "touchcald.err");
    address_ = daemon_->wait_for_address();
  }
  void end() {
    daemon_->signal(SIGTERM);
    EXPECT_EQ(daemon_->wait().exit_code, cell::kExitDone);
  }
  [[nodiscard]] std::string state() const { return (folder_ / "state").string(); }

  Finished touchcal(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "touchcal");
    arguments.insert(arguments.end(), {"--state", state()});
    return Process(arguments, folder_ / "call.err").wait();
  }
  /// A user by the command line, the secret on standard input.
  std::string add(const std::string& name, const std::string& role, const std::string& secret) const {
    const std::string command = "printf '%s\\n' '" + secret + "' | " + TOUCHCAL_PROGRAMS_DIR +
                                "/touchcal users add '" + name + "' --role " + role + " --state " + state() +
                                " 2>&1";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
    std::string text;
    for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) text += static_cast<char>(c);
    return text;
  }
  cell::RawClient client() const {
    const auto port =
        static_cast<boost::asio::ip::port_type>(std::stoi(address_.substr(address_.rfind(':') + 1)));
    return cell::RawClient({boost::asio::ip::address_v4::loopback(), port});
  }
  cell::RawAnswer ask(const std::string& method, const std::string& path, const std::string& token,
                      const std::string& body = {}) const {
    cell::RawClient one = client();
    one.send(method + " " + path + " HTTP/1.1\r\nHost: " + address_ +
             (token.empty() ? "" : "\r\nAuthorization: Bearer " + token) +
             (body.empty()
                  ? ""
                  : "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size())) +
             "\r\n\r\n" + body);
    return one.receive();
  }
  std::string sign_in(const std::string& name, const std::string& secret) const {
    const auto answer = ask("POST", "/api/v1/sign-in", "", json{{"name", name}, {"secret", secret}}.dump());
    EXPECT_EQ(answer.status, 201U) << answer.body;
    return json::parse(answer.body).value("token", "");
  }
  json session(const std::string& token) const {
    return json::parse(ask("GET", "/api/v1/session", token).body);
  }

  Folder folder_;
  std::unique_ptr<Process> daemon_;
  std::string address_;
};

TEST_F(SignIn, UsersAreMadeListedAndRemovedByTheCommandLine) {
  EXPECT_THAT(touchcal({"users"}).out, HasSubstr("nobody can sign in"));
  const std::string made = add("Jürgen O'\\''Hara", "engineer", "correct horse");
  EXPECT_THAT(made, AllOf(HasSubstr("Jürgen O'Hara"), HasSubstr("engineer"), Not(HasSubstr("horse"))));
  EXPECT_THAT(add("otto", "operate", "12345"), HasSubstr("6 to 128"));
  EXPECT_THAT(add("otto", "operate", "271828"), HasSubstr("otto"));
  const json users = json::parse(touchcal({"users", "--json"}).out).at("users");
  ASSERT_EQ(users.size(), 2U);
  EXPECT_EQ(users[1].at("role"), "operate");
  EXPECT_EQ(touchcal({"users", "remove", "Jürgen O'Hara"}).exit_code, cell::kExitDone);
  EXPECT_THAT(touchcal({"users"}).out, AllOf(Not(HasSubstr("Hara")), HasSubstr("otto")));
  EXPECT_THAT(touchcal({"users", "remove", "cora"}).err, HasSubstr("there is no user 'cora'"));
  EXPECT_EQ(touchcal({"users", "add", "cora"}).exit_code, cell::kExitUsage) << "without a role";
  EXPECT_EQ(touchcal({"users", "remove"}).exit_code, cell::kExitUsage) << "without a name";
  end();
}

TEST_F(SignIn, ASessionGoesOnAfterARestartAndTheAuditHasItsPerson) {
  add("otto", "operate", "271828");
  const std::string otto = sign_in("otto", "271828");
  ASSERT_EQ(ask("POST", "/api/v1/cell/acknowledge", otto, "{}").status, 202U);
  end();
  start();
  EXPECT_EQ(session(otto).at("name"), "otto");
  EXPECT_EQ(ask("POST", "/api/v1/cell/stop", otto, "{}").status, 202U);
  EXPECT_EQ(ask("POST", "/api/v1/models/rollback", otto, "{}").status, 403U);
  EXPECT_THAT(touchcal({"audit"}).out, HasSubstr(" otto "));
  end();
}

TEST_F(SignIn, AStreamOfEventsEndsWithItsPerson) {
  add("vera", "view", "271828");
  const std::string vera = sign_in("vera", "271828");
  cell::RawClient reader = client();
  reader.send("GET /api/v1/events HTTP/1.1\r\nHost: " + address_ + "\r\nAuthorization: Bearer " + vera +
              "\r\n\r\n");
  ASSERT_EQ(reader.receive(true).status, 200U);
  EXPECT_EQ(touchcal({"users", "remove", "vera"}).exit_code, cell::kExitDone);
  reader.receive_until("no event ends so");
  EXPECT_TRUE(reader.closed());
  EXPECT_EQ(session(vera).at("role"), "none");
  end();
}

TEST_F(SignIn, ARemovalThatTheDiskDidNotTakeIsDoneWithAWarning) {
  add("otto", "operate", "271828");
  const std::string otto = sign_in("otto", "271828");
  const std::filesystem::path users = state() + "/users.json";
  std::filesystem::remove(users);
  std::filesystem::create_directories(users / "in the way");  // no file can take its place
  const Finished removed = touchcal({"users", "remove", "otto", "--json"});
  EXPECT_EQ(removed.exit_code, cell::kExitDone) << removed.err;
  EXPECT_EQ(json::parse(removed.out).at("type"), "urn:touchcal:problem:not-kept");
  EXPECT_THAT(removed.err, AllOf(HasSubstr("warning: it counts from now on"), HasSubstr("free space")));
  EXPECT_EQ(session(otto).at("role"), "none");
  EXPECT_EQ(touchcal({"users", "remove", "otto"}).exit_code, cell::kExitUsage) << "nobody is left";
  end();
}

TEST_F(SignIn, ADamagedFileOfUsersKeepsTheDaemonFromStartingAndSaysWhy) {
  end();
  std::FILE* file = std::fopen((state() + "/users.json").c_str(), "w");
  std::fputs("{\"schema\":\"touchcal/users-file/1\",\"users\":7,\"sessions\":[]}", file);
  std::fclose(file);
  std::filesystem::permissions(state() + "/users.json", std::filesystem::perms(0600));
  Process again({"touchcald", "--cell", std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json",
                 "--state", state(), "--listen", "127.0.0.1:0", "--controller", "127.0.0.1:9"},
                folder_ / "again.err");
  const Finished finished = again.wait();
  EXPECT_NE(finished.exit_code, cell::kExitDone);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("users.json"), HasSubstr("/users"), HasSubstr("remove the file")));
}

}  // namespace
}  // namespace touchcal::testing
