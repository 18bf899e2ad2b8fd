#include "service/http/server/tls.hpp"

#include <gmock/gmock.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <boost/asio/ssl/stream.hpp>
#include <thread>

#include "service/http/routes/api.hpp"
#include "service/http/server/listener.hpp"
#include "tests/service/quiet_cell.hpp"
#include "tests/service/raw_http.hpp"

namespace cell {
namespace {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using ::testing::HasSubstr;

/// A key and a certificate that it signs itself, as PEM files.
struct OwnCertificate {
  explicit OwnCertificate(const Folder& folder)
      : certificate_file(folder.path() / "cert.pem"), key_file(folder.path() / "key.pem") {
    const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
    const std::unique_ptr<X509, decltype(&X509_free)> certificate(X509_new(), &X509_free);
    X509_set_version(certificate.get(), 2);
    ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate.get()), 0);
    X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600);
    X509_set_pubkey(certificate.get(), key.get());
    X509_sign(certificate.get(), key.get(), EVP_sha256());
    write(certificate_file, [&](std::FILE* file) { PEM_write_X509(file, certificate.get()); });
    write(key_file, [&](std::FILE* file) {
      PEM_write_PrivateKey(file, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
    });
  }
  template <class Writer>
  static void write(const std::filesystem::path& path, Writer&& writer) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    writer(file);
    std::fclose(file);
  }
  std::filesystem::path certificate_file, key_file;
};

class TlsTest : public ::testing::Test {
 protected:
  TlsTest() {
    listener_.launch();
    server_ = std::thread([this] { quiet_.context().run(); });
  }
  ~TlsTest() override {
    quiet_.context().stop();
    server_.join();
  }
  /// What the daemon answers over TLS of at most this version; empty when there is no handshake.
  std::string answer_over(int version_max) {
    asio::io_context context;
    ssl::context tls(ssl::context::tls_client);
    SSL_CTX_set_security_level(tls.native_handle(), 0);  // a client of old may ask for old versions
    SSL_CTX_set_max_proto_version(tls.native_handle(), version_max);
    ssl::stream<asio::ip::tcp::socket> stream(context, tls);
    stream.next_layer().connect(listener_.address());
    boost::system::error_code failure;
    stream.handshake(ssl::stream_base::client, failure);
    if (failure) return {};
    const std::string request =
        "GET /healthz HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(listener_.address().port()) +
        "\r\nOrigin: https://127.0.0.1:" + std::to_string(listener_.address().port()) +
        "\r\nConnection: close\r\n\r\n";
    asio::write(stream, asio::buffer(request));
    std::string answer;
    asio::read(stream, asio::dynamic_buffer(answer), failure);
    EXPECT_EQ(failure, asio::error::eof) << "the end is told, not cut: " << failure.message();
    return answer;
  }

  Folder folder_;
  OwnCertificate own_{folder_};
  QuietCell quiet_;
  Api api_{quiet_.context().get_executor(), quiet_.operation(),
           Tokens{std::string(64, 'a'), std::string(64, 'b')}};
  HttpListener listener_{quiet_.context().get_executor(),
                         {asio::ip::address_v4::loopback(), 0},
                         api_,
                         HttpLimits{},
                         make_tls_context(own_.certificate_file, own_.key_file)};
  std::thread server_;
};

TEST_F(TlsTest, AnswersOverTls12And13AndNothingOlder) {
  EXPECT_THAT(answer_over(TLS1_3_VERSION), HasSubstr("200 OK"));
  EXPECT_THAT(answer_over(TLS1_2_VERSION), HasSubstr("200 OK"));
  EXPECT_EQ(answer_over(TLS1_1_VERSION), "");
}

TEST_F(TlsTest, WithoutTlsThereIsNoAnswer) {
  RawClient client(listener_.address());
  client.send("GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  EXPECT_EQ(client.receive_until("\r\n\r\n").find("HTTP/"), std::string::npos);
  EXPECT_THAT(answer_over(TLS1_3_VERSION), HasSubstr("200 OK")) << "others are served";
}

TEST(TlsFiles, ThatAreNoneAreNamed) {
  const Folder folder;
  const OwnCertificate own(folder);
  const auto refusal = [](const std::filesystem::path& certificate, const std::filesystem::path& key) {
    try {
      make_tls_context(certificate, key);
      return std::string("taken");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refusal(own.certificate_file, own.key_file), "taken");
  EXPECT_THAT(refusal(folder.path() / "gone", own.key_file), HasSubstr("gone"));
  EXPECT_THAT(refusal(own.certificate_file, folder.path() / "gone"), HasSubstr("gone"));
  EXPECT_THAT(refusal(own.key_file, own.certificate_file), HasSubstr(own.key_file.string()));
}

}  // namespace
}  // namespace cell
