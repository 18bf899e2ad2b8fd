// A cell and an archive that know each other by certificates, as integrators.md sets them up.
#include <gmock/gmock.h>

#include <filesystem>
#include <pqxx/pqxx>
#include <string>

#include "service/archive/archive_schema.hpp"
#include "service/archive/archive_sink.hpp"
#include "service/store/run_store.hpp"
#include "tests/service/archive/postgres.hpp"
#include "tests/service/archive/server_files.hpp"
#include "tests/service/mqtt/certificates.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

class ArchiveByCertificate : public ::testing::Test {
 protected:
  ArchiveByCertificate() {
    const std::string owner = server_.url() + "&port=" + std::to_string(port_);
    prepare_archive(owner);
    pqxx::connection connection(owner);
    pqxx::work work(connection);
    for (const char* cell : {"edf", "cell-1"})
      work.exec0("CREATE ROLE \"" + std::string(cell) + "\" LOGIN IN ROLE touchcal_writer");
    work.commit();
    store_.begin_run({.recipe = "edf-25", .started_at = "2026-01-01T00:00:00.000Z"});
  }
  [[nodiscard]] std::string url(const std::string& certificate, const std::string& authority = "ca",
                                const std::string& host = "127.0.0.1") const {
    const std::string in = certificates().string() + "/";
    return "postgresql://edf@" + host + ":" + std::to_string(port_) +
           "/postgres?sslmode=verify-full&sslrootcert=" + in + authority + ".crt&sslcert=" + in +
           certificate + ".crt&sslkey=" + in + certificate + ".key";
  }
  void deliver(const std::string& url, const std::string& cell = "edf") {
    connect_archive(url, cell, file_)->deliver(OutboxReader(file_).next(0, 1000), {});
  }

  int port_ = free_port();
  ServerFiles files_;
  Postgres server_{files_.settings(port_)};
  Folder folder_;
  fs::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

TEST_F(ArchiveByCertificate, ACellIsTheUserOfItsCertificate) {
  EXPECT_NO_THROW(deliver(url("edf")));
  EXPECT_THROW(deliver(url("cell-1")), SinkTrouble) << "the certificate of another cell";
  EXPECT_THROW(deliver(url("foreign")), SinkTrouble) << "one that a stranger has signed";
  EXPECT_THROW(deliver(url("edf"), "cell-1"), SinkTrouble) << "rows in the name of another cell";
}

TEST_F(ArchiveByCertificate, AServerThatIsNotTheArchiveGetsNothing) {
  EXPECT_THROW(deliver(url("edf", "other")), SinkTrouble) << "another authority";
  EXPECT_THROW(deliver(url("edf", "ca", "localhost")), SinkTrouble)
      << "a name that is not in its certificate";
}

TEST_F(ArchiveByCertificate, NothingGoesInTheClear) {
  EXPECT_THROW(deliver("postgresql://edf@127.0.0.1:" + std::to_string(port_) + "/postgres?sslmode=disable"),
               SinkTrouble);
}

}  // namespace
}  // namespace cell
