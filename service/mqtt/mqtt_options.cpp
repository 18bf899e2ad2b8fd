#include "service/mqtt/mqtt_options.hpp"

#include <openssl/pem.h>
#include <openssl/x509.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <boost/url/parse.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace cell {
namespace {

constexpr std::uint16_t kPlainPort = 1883;
constexpr std::uint16_t kTlsPort = 8883;

using OwnedFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
using OwnedCertificate = std::unique_ptr<X509, void (*)(X509*)>;
using OwnedKey = std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)>;

OwnedFile opened_pem(const char* option, const std::filesystem::path& file) {
  OwnedFile opened(std::fopen(file.c_str(), "re"), std::fclose);
  if (!opened)
    throw std::runtime_error(
        fmt::format("{} {}: cannot be read; name a file that this user may read", option, file.string()));
  return opened;
}

OwnedCertificate read_certificate(const char* option, const std::filesystem::path& file) {
  const OwnedFile opened = opened_pem(option, file);
  OwnedCertificate certificate(PEM_read_X509(opened.get(), nullptr, nullptr, nullptr), X509_free);
  if (!certificate)
    throw std::runtime_error(
        fmt::format("{} {}: holds no certificate; name one in PEM", option, file.string()));
  return certificate;
}

/// One behind a password is none: nobody is there to be asked.
int no_password(char*, int, int, void*) { return -1; }

OwnedKey read_key(const std::filesystem::path& file) {
  const OwnedFile opened = opened_pem("--mqtt-key", file);
  OwnedKey key(PEM_read_PrivateKey(opened.get(), nullptr, no_password, nullptr), EVP_PKEY_free);
  if (!key)
    throw std::runtime_error(
        fmt::format("--mqtt-key {}: holds no key without a password; name one in PEM", file.string()));
  return key;
}

std::string common_name(X509& certificate) {
  constexpr int kNameBytesMax = 256;
  std::string name(kNameBytesMax, '\0');
  const int length = X509_NAME_get_text_by_NID(X509_get_subject_name(&certificate), NID_commonName,
                                               name.data(), kNameBytesMax);
  name.resize(static_cast<std::size_t>(std::max(length, 0)));
  return name;
}

void demand_own_certificate(const MqttOptions& options, const std::string& cell) {
  const std::string file = options.certificate.string();
  const OwnedCertificate certificate = read_certificate("--mqtt-cert", options.certificate);
  const OwnedKey key = read_key(options.key);
  if (X509_check_private_key(certificate.get(), key.get()) != 1)
    throw std::runtime_error(fmt::format("--mqtt-key {}: is not the key of {}; name the one it was made with",
                                         options.key.string(), file));
  if (const std::string name = common_name(*certificate); name != cell)
    throw std::runtime_error(
        fmt::format("--mqtt-cert {}: is of '{}', and this cell is '{}'; name the certificate whose CN is the "
                    "cell's name",
                    file, name, cell));
  if (X509_cmp_current_time(X509_get0_notAfter(certificate.get())) < 0)
    throw std::runtime_error(
        fmt::format("--mqtt-cert {}: its time is over; have the plant's authority renew it", file));
}

}  // namespace

std::optional<MqttOptions> mqtt_from_url(std::string_view url) {
  const auto parsed = boost::urls::parse_uri(url);
  if (parsed.has_error()) return std::nullopt;
  const bool tls = parsed->scheme() == "mqtts";
  if (!tls && parsed->scheme() != "mqtt") return std::nullopt;
  const bool has_more = parsed->has_userinfo() || parsed->has_query() || parsed->has_fragment() ||
                        !(parsed->encoded_path().empty() || parsed->encoded_path() == "/");
  if (has_more || parsed->encoded_host_address().empty()) return std::nullopt;
  const bool has_port = parsed->has_port() && !parsed->port().empty();
  if (has_port && parsed->port_number() == 0) return std::nullopt;
  return MqttOptions{.host = std::string(parsed->host_address()),
                     .port = has_port ? parsed->port_number()
                             : tls    ? kTlsPort
                                      : kPlainPort,
                     .tls = tls};
}

void demand_mqtt_files(const MqttOptions& options, const std::string& cell) {
  if (cell.find_first_of("/+#") != std::string::npos || cell.starts_with('$'))
    throw std::runtime_error(fmt::format(
        "the cell's name '{}' cannot stand in a topic: it has one of / + # or begins with $; name the cell "
        "otherwise",
        cell));
  if (!options.tls) return;
  read_certificate("--mqtt-ca", options.authority);
  if (!options.certificate.empty()) demand_own_certificate(options, cell);
}

}  // namespace cell
