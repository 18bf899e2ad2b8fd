#include "sim_controller/control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <random>

#include "aimed_touch.hpp"
#include "cell_with_stand.hpp"
#include "config/fault_file.hpp"
#include "sim_controller/server.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ::testing::HasSubstr;

constexpr std::chrono::seconds kPatience{10};
const std::string kDone = R"({"ok":true})";

/// Somebody at the control port.
class Person {
 public:
  Person(asio::io_context& io, std::uint16_t port) : socket_(io) {
    socket_.connect({asio::ip::address_v4::loopback(), port});
  }

  asio::awaitable<void> send(std::string bytes) {
    co_await asio::async_write(socket_, asio::buffer(bytes), asio::use_awaitable);
  }
  asio::awaitable<std::string> answer() {
    const std::size_t size =
        co_await asio::async_read_until(socket_, asio::dynamic_buffer(bytes_), '\n', asio::use_awaitable);
    std::string line = bytes_.substr(0, size - 1);
    bytes_.erase(0, size);
    co_return line;
  }
  asio::awaitable<std::string> ask(std::string line) {
    co_await send(line + '\n');
    co_return co_await answer();
  }
  asio::awaitable<bool> ends() {
    try {
      co_await answer();
    } catch (const boost::system::system_error&) {
      co_return true;
    }
    co_return false;
  }

 private:
  tcp::socket socket_;
  std::string bytes_;
};

class ControlTest : public ::testing::Test {
 protected:
  Person person() { return {io_, control_.port()}; }

  void play(std::function<asio::awaitable<void>()> script) {
    std::exception_ptr failure;
    bool done = false;
    asio::co_spawn(io_, std::move(script), [&](std::exception_ptr error) {
      failure = error;
      done = true;
      control_.stop();
      server_.stop();
    });
    io_.run_for(kPatience);
    if (failure) std::rethrow_exception(failure);
    ASSERT_TRUE(done) << "the script waits for an answer that does not come";
    EXPECT_TRUE(io_.stopped()) << "something stayed";
  }

  asio::io_context io_;
  Server server_{io_,
                 "127.0.0.1",
                 0,
                 testing::true_plant("demo"),
                 {.controller = {.speed = kSpeedMax}, .plants = make_plants(testing::cell_with_stand(), {})}};
  Control control_{io_, "127.0.0.1", 0,
                   [this](std::string_view line) { return answer_control_line(server_, line); }};
};

TEST_F(ControlTest, AnswersEachLineInItsOrder) {
  play([this]() -> asio::awaitable<void> {
    Person person = this->person();
    EXPECT_EQ(co_await person.ask(R"({"fault":"drop","on":"touch"})"), kDone);
    EXPECT_EQ(co_await person.ask(R"({"operator":{"confirms":false}})"), kDone);
    EXPECT_THAT(co_await person.ask(R"({"fault":"drop"})"), HasSubstr(R"("ok":false)"));
    EXPECT_EQ(co_await person.ask(R"({"block":"stand"})"), kDone);
    EXPECT_THAT(co_await person.ask(R"({"block":"shelf"})"), HasSubstr("the block has no place"));
    co_await person.send("{\"show\":\"state\"}\nnonsense\n{\"operator\":{}}\n");
    EXPECT_THAT(co_await person.answer(), HasSubstr(R"("mode":"remote")"));
    EXPECT_THAT(co_await person.answer(), HasSubstr("not JSON"));
    EXPECT_EQ(co_await person.answer(), kDone);
  });
}

TEST_F(ControlTest, AFaultGivenHereHappensAtOnce) {
  play([this]() -> asio::awaitable<void> {
    tcp::socket host(io_);
    host.connect({asio::ip::address_v4::loopback(), server_.port()});
    Person person = this->person();
    EXPECT_EQ(co_await person.ask(R"({"fault":"close"})"), kDone);
    char byte = 0;
    boost::system::error_code error;
    co_await host.async_read_some(asio::buffer(&byte, 1), asio::redirect_error(asio::use_awaitable, error));
    EXPECT_EQ(error, asio::error::eof);
  });
}

TEST_F(ControlTest, ALineThatIsTooLongIsAnsweredAndEndsItsConnection) {
  play([this]() -> asio::awaitable<void> {
    Person person = this->person();
    const std::string fits = R"({"show":"state"})";
    EXPECT_THAT(co_await person.ask(fits + std::string(cell::kControlLineMax - fits.size(), ' ')),
                HasSubstr(R"("ok":true)"));
    co_await person.send(std::string(cell::kControlLineMax + 1, ' '));
    EXPECT_THAT(co_await person.answer(), HasSubstr("make it shorter"));
    EXPECT_TRUE(co_await person.ends());
    Person next = this->person();
    EXPECT_EQ(co_await next.ask(R"({"operator":{}})"), kDone);
  });
}

TEST_F(ControlTest, OneConnectionTooManyIsToldSo) {
  play([this]() -> asio::awaitable<void> {
    std::vector<std::unique_ptr<Person>> people;
    for (std::size_t i = 0; i < kControlConnectionsMax; ++i) {
      people.push_back(std::make_unique<Person>(io_, control_.port()));
      EXPECT_EQ(co_await people.back()->ask(R"({"operator":{}})"), kDone);
    }
    Person late = this->person();
    EXPECT_THAT(co_await late.answer(), HasSubstr("too many"));
    EXPECT_TRUE(co_await late.ends());
    EXPECT_EQ(co_await people.front()->ask(R"({"operator":{}})"), kDone);
  });
}

TEST_F(ControlTest, AnyBytesAreSurvived) {
  play([this]() -> asio::awaitable<void> {
    std::mt19937 chance(3);
    for (int i = 0; i < 200; ++i) {
      std::string bytes(chance() % 200, '\0');
      for (char& byte : bytes) {
        do byte = static_cast<char>(chance());
        while (byte == '\n');
      }
      Person person = this->person();
      EXPECT_THAT(co_await person.ask(bytes), HasSubstr(R"("ok":false)"));
      co_await person.send(bytes);  // and goes in the middle of a line
    }
  });
}

}  // namespace
}  // namespace sim
