// A head office and a plant that know each other by certificates, as integrators.md sets them up: the head
// office's server asks the plant's over TLS, in the name of its certificate.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <pqxx/pqxx>
#include <string>

#include "service/archive/archive_reader.hpp"
#include "service/archive/archive_schema.hpp"
#include "service/archive/archive_sink.hpp"
#include "service/store/run_store.hpp"
#include "tests/service/archive/postgres.hpp"
#include "tests/service/archive/server_files.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class HeadOfficeByCertificate : public ::testing::Test {
 protected:
  HeadOfficeByCertificate() {
    prepare_archive(plant_url());
    prepare_archive(head_.url());
    pqxx::connection connection(plant_url());
    pqxx::work work(connection);
    work.exec0("CREATE ROLE edf LOGIN IN ROLE touchcal_writer");
    work.commit();
  }
  [[nodiscard]] std::string plant_url(const std::string& user = "postgres") const {
    return plant_.url(user) + "&port=" + std::to_string(port_);
  }
  /// The plant as the head office's server reaches it, with files that this server may read.
  [[nodiscard]] std::string from(const std::string& certificate, const std::string& authority = "ca",
                                 const std::string& host = "127.0.0.1") const {
    return "postgresql://touchcal_replica@" + host + ":" + std::to_string(port_) +
           "/postgres?sslmode=verify-full&sslrootcert=" + head_files_.path(authority + ".crt") +
           "&sslcert=" + head_files_.path(certificate + ".crt") +
           "&sslkey=" + head_files_.path(certificate + ".key");
  }
  /// Its exit code; what it says on standard error is in `said_`.
  int set_up(const std::string& from) {
    const std::string said = (folder_.path() / "said").string();
    const std::string call = std::string(TOUCHCAL_SOURCE_DIR) +
                             "/service/package/plant/head-office --archive '" + plant_url() + "' --head '" +
                             head_.url() + "' --name north --from '" + from + "' >/dev/null 2>" + said;
    const int status = std::system(call.c_str());
    std::ifstream file(said);
    said_.assign(std::istreambuf_iterator<char>(file), {});
    return WEXITSTATUS(status);
  }
  void archive_a_run() {
    store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:00:00.000Z"});
    const std::vector<Fact> all = OutboxReader(file_).next(0, 1000);
    connect_archive(plant_url("postgres"), "edf", file_)->deliver(all, {});
  }
  bool arrives(std::int64_t wanted) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    pqxx::connection connection(head_.url());
    // Who asks without a pause takes the processor from what is waited for.
    for (;;) {
      pqxx::work read(connection);
      read.exec1("SELECT pg_sleep(0.05)");
      if (read.exec1("SELECT count(*) FROM event")[0].as<std::int64_t>() == wanted) return true;
      if (std::chrono::steady_clock::now() > until) return false;
    }
  }

  int port_ = free_port();
  ServerFiles plant_files_{"hostssl all touchcal_replica 127.0.0.1/32 cert clientcert=verify-full\n"};
  ServerFiles head_files_{"", {"touchcal_replica", "cell-1"}};
  Postgres plant_{[this] {
    std::vector<std::string> settings = plant_files_.settings(port_);
    settings.emplace_back("wal_level=logical");
    return settings;
  }()};
  Postgres head_;
  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
  std::string said_;
};

TEST_F(HeadOfficeByCertificate, GetsWhatHappensOverTls) {
  archive_a_run();
  ASSERT_EQ(set_up(from("touchcal_replica")), 0) << said_;
  EXPECT_TRUE(arrives(1)) << "what was there";
  archive_a_run();
  EXPECT_TRUE(arrives(2));
  EXPECT_THAT(look_at_archive(head_.url()).damage, IsEmpty());
  pqxx::connection connection(plant_url());
  pqxx::work work(connection);
  EXPECT_EQ(
      work.exec1("SELECT bool_and(ssl) FROM pg_stat_ssl JOIN pg_stat_replication USING (pid)")[0].as<bool>(),
      true);
}

TEST_F(HeadOfficeByCertificate, IsNotLetInByAnotherCertificateAndAsksNoOtherServer) {
  EXPECT_EQ(set_up(from("cell-1")), 4);
  EXPECT_THAT(said_, HasSubstr("certificate authentication failed"));
  EXPECT_EQ(set_up(from("touchcal_replica", "other")), 4) << "a plant of another authority";
  EXPECT_THAT(said_, HasSubstr("certificate verify failed"));
  EXPECT_EQ(set_up(from("touchcal_replica", "ca", "localhost")), 4);
  EXPECT_THAT(said_, HasSubstr("does not match host name"));
  ASSERT_EQ(set_up(from("touchcal_replica")), 0) << "with the right ones it goes on: " << said_;
  archive_a_run();
  EXPECT_TRUE(arrives(1));
}

}  // namespace
}  // namespace cell
