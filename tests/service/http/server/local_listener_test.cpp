#include "service/http/server/local_listener.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <thread>

#include "service/http/routes/api.hpp"
#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

namespace asio = boost::asio;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class LocalListenerTest : public ::testing::Test {
 protected:
  LocalListenerTest() {
    listener_.launch();
    server_ = std::thread([this] { quiet_.context().run(); });
  }
  ~LocalListenerTest() override {
    quiet_.context().stop();
    server_.join();
  }

  /// The whole answer; the daemon ends the connection.
  [[nodiscard]] std::string ask(const std::string& request_line, const std::string& lines = "") const {
    asio::io_context context;
    asio::local::stream_protocol::socket socket(context);
    socket.connect(asio::local::stream_protocol::endpoint(file_.string()));
    asio::write(socket, asio::buffer(request_line + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" +
                                     lines + "\r\n"));
    std::string answer;
    boost::system::error_code end;
    asio::read(socket, asio::dynamic_buffer(answer), end);
    return answer;
  }

  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcald.sock";
  QuietCell quiet_;
  Api api_{quiet_.context().get_executor(), quiet_.operation(), kTokens};
  LocalListener listener_{quiet_.context().get_executor(), file_, api_};
  std::thread server_;
};

TEST_F(LocalListenerTest, ServesTheSameRoutesWithTheRightsOfLoopback) {
  EXPECT_THAT(ask("GET /api/v1/status"), HasSubstr("\"state\":\"STOPPED\""));
  EXPECT_THAT(ask("POST /api/v1/cell/stop"), StartsWith("HTTP/1.1 401"))
      << "operating needs the token here too";
  EXPECT_THAT(ask("POST /api/v1/cell/stop", "Authorization: Bearer " + kTokens.operate + "\r\n"),
              StartsWith("HTTP/1.1 202"));
}

TEST_F(LocalListenerTest, TheSocketIsForItsOwnerOnly) {
  struct stat state {};
  ASSERT_EQ(::stat(file_.c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 0777U, 0600U);
}

TEST(LocalListenerFile, ASocketThatWasLeftBehindIsReplacedAndNothingElseIs) {
  const Folder folder;
  QuietCell quiet;
  Api api(quiet.context().get_executor(), quiet.operation(), kTokens);
  const std::filesystem::path file = folder.path() / "s";
  { asio::local::stream_protocol::acceptor left_behind(quiet.context(), file.string()); }
  ASSERT_TRUE(std::filesystem::exists(file));
  LocalListener(quiet.context().get_executor(), file, api).close();
  EXPECT_FALSE(std::filesystem::exists(file)) << "it goes with its listener";
  const std::filesystem::path text = folder.write("text", "mine");
  EXPECT_THROW(LocalListener(quiet.context().get_executor(), text, api), boost::system::system_error);
  EXPECT_EQ(bytes_of(text), "mine");
  EXPECT_THROW(LocalListener(quiet.context().get_executor(), folder.path() / std::string(200, 'x'), api),
               boost::system::system_error);
}

}  // namespace
}  // namespace cell
