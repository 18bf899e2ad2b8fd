// touchcald: the daemon of one robot cell.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <new>

#include "config/config_error.hpp"
#include "config/decimal_text.hpp"
#include "config/option_text.hpp"
#include "config/read_config.hpp"
#include "service/archive/archive_options.hpp"
#include "service/base/exit_code.hpp"
#include "service/base/log_format.hpp"
#include "service/base/state_directory.hpp"
#include "service/base/version.hpp"
#include "service/daemon/daemon.hpp"
#include "service/daemon/self_check.hpp"
#include "service/store/damaged_store.hpp"
#include "service/store/maintenance.hpp"

namespace {

std::string check_endpoint(const std::string& text) {
  if (std::string refusal = cell::refuse_empty(text); !refusal.empty()) return refusal;
  return cell::parse_endpoint(text) ? "" : "'" + text + "' is not HOST:PORT, with an IPv6 host in brackets";
}

std::string check_host_name(const std::string& text) {
  return cell::parse_host_name(text) ? "" : "'" + text + "' is not NAME or NAME:PORT of a host";
}

void demand_both_of_tls(const std::string& certificate, const std::string& key) {
  if (certificate.empty() == key.empty()) return;
  const std::string given = key.empty() ? "--tls-cert" : "--tls-key";
  throw CLI::ValidationError(given, "is given without " +
                                        std::string(key.empty() ? "--tls-key" : "--tls-cert") +
                                        "; give both, or neither and no TLS");
}

std::string check_mqtt_url(const std::string& text) {
  return cell::mqtt_from_url(text)
             ? ""
             : "'" + text +
                   "' is not mqtt://HOST[:PORT] or mqtts://HOST[:PORT]; a certificate, and "
                   "no user, says who the cell is";
}

std::string check_archive_url(const std::string& text) {
  return cell::archive_from_url(text) ? ""
                                      : "'" + text +
                                            "' is not postgresql://[USER@]HOST[:PORT]/DATABASE?sslmode="
                                            "verify-full, without a password; a host that is this machine "
                                            "needs no sslmode";
}

/// The texts of the options, empty where they are not given.
struct MqttTexts {
  std::string url, authority, certificate, key;
};

std::optional<cell::MqttOptions> mqtt_options(const MqttTexts& texts) {
  const bool has_files = !texts.authority.empty() || !texts.certificate.empty() || !texts.key.empty();
  auto options = cell::mqtt_from_url(texts.url);
  if ((!options || !options->tls) && has_files)
    throw CLI::ValidationError("--mqtt", "has to be mqtts://HOST[:PORT] where certificates are given");
  if (!options) return std::nullopt;
  if (options->tls && texts.authority.empty())
    throw CLI::ValidationError("--mqtt", "needs --mqtt-ca: who has signed the broker's certificate");
  if (texts.certificate.empty() != texts.key.empty())
    throw CLI::ValidationError("--mqtt-cert", "and --mqtt-key belong together; give both, or neither");
  options->authority = texts.authority;
  options->certificate = texts.certificate;
  options->key = texts.key;
  return options;
}

/// Maintenance of the database, also beside a running daemon. Returns the exit code.
int keep_state(const std::filesystem::path& database, const std::string& backup, bool verify) {
  if (verify) {
    const std::vector<std::string> damage = cell::find_damage(database);
    for (const std::string& line : damage) std::cerr << database.string() << ": " << line << '\n';
    if (!damage.empty()) {
      std::cerr << "stop the daemon and restore the last backup\n";
      return cell::kExitBadInput;
    }
    std::cout << database.string() << " is in order\n";
  }
  if (backup.empty()) return cell::kExitDone;
  try {
    cell::back_up(database, backup);
  } catch (const cell::DamagedStore& damage) {
    std::cerr << damage.what() << '\n';
    return cell::kExitBadInput;
  }
  std::cout << backup << " is a copy of " << database.string() << '\n';
  return cell::kExitDone;
}

/// Reports everything that prevents a start. The last line says what was not looked at.
cell::ExitCode tell_check(const std::string& cell_file, const cell::SelfCheck& check) {
  for (const std::string& line : check.bad_files) std::cerr << line << '\n';
  for (const std::string& line : check.troubles) std::cerr << line << '\n';
  for (const std::string& line : check.remarks) std::cout << line << '\n';
  if (!check.bad_files.empty()) return cell::kExitBadInput;
  if (!check.troubles.empty()) return cell::kExitFailed;
  std::cout << cell_file << ": cell " << check.cell_name << " is in order";
  if (!check.not_looked_at.empty()) std::cout << "; not looked at: " << check.not_looked_at;
  std::cout << '\n';
  return cell::kExitDone;
}

void begin_log(const std::string& format) {
  const bool json = format == "json";
  const auto log = json ? spdlog::stderr_logger_mt("touchcald") : spdlog::stderr_color_mt("touchcald");
  log->set_formatter(json ? cell::json_log_format() : cell::text_log_format());
  spdlog::set_default_logger(log);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "touchcald: executes the touches of one robot cell, identifies the arm and serves the JSON API");
  std::string cell_file, listen, controller, state, backup, tls_certificate, tls_key, log_format = "text";
  std::vector<std::string> host_names;
  MqttTexts mqtt;
  std::string archive;
  bool check = false, verify = false, loopback_needs_token = false;
  int retain_days = 0;
  const CLI::Validator filled(cell::refuse_empty, "");
  const CLI::Validator endpoint(check_endpoint, "");
  app.add_option("--cell", cell_file, "cell file, for example config/cells/demo/cell.json")->check(filled);
  app.add_option("--listen", listen, "HOST:PORT of the API")->check(endpoint)->default_str("127.0.0.1:8080");
  app.add_option("--host-name", host_names,
                 "a host name that clients may use, besides the address; with the port of a proxy that "
                 "listens elsewhere than at 443")
      ->check(CLI::Validator(check_host_name, "NAME[:PORT]"));
  app.add_option("--controller", controller, "HOST:PORT of the CS8; default: the cell file's")
      ->check(endpoint);
  app.add_option("--state", state, "directory for runs and tokens; default: the user's state home")
      ->check(filled);
  app.add_option("--tls-cert", tls_certificate, "certificate, PEM; with --tls-key the API is served over TLS")
      ->check(filled);
  app.add_option("--tls-key", tls_key, "the certificate's key, PEM")->check(filled);
  app.add_option("--log-format", log_format,
                 "format of the log on standard error: text, or json (one object per line)")
      ->check(CLI::IsMember({"text", "json"}))
      ->default_str(log_format);
  app.add_flag("--check", check,
               "check the cell and its files, the state directory, its database and the block's place, the "
               "tokens, the address and TLS, report every error, then exit; a daemon may run");
  app.add_option("--backup", backup,
                 "copy the state's database into this new file, then exit; a daemon may run")
      ->check(filled);
  app.add_flag("--verify", verify, "check the state's database for damage, then exit; a daemon may run");
  app.add_option("--retain-days", retain_days, "delete older runs, except the last accepted one")
      ->check(cell::refuse_integer)
      ->check(CLI::Range(1, cell::kRetainDaysMax));
  app.add_option("--mqtt", mqtt.url,
                 "mqtts://HOST[:PORT] or mqtt://HOST[:PORT] of a broker that is told what happens")
      ->check(CLI::Validator(check_mqtt_url, "URL"));
  app.add_option("--mqtt-ca", mqtt.authority, "who has signed the broker's certificate, PEM")->check(filled);
  app.add_option("--mqtt-cert", mqtt.certificate,
                 "the cell's certificate, PEM; its CN is the name of the cell; with --mqtt-key")
      ->check(filled);
  app.add_option("--mqtt-key", mqtt.key, "that certificate's key, PEM")->check(filled);
  app.add_option("--archive", archive, "postgresql://... of a database that keeps the facts of many cells")
      ->check(CLI::Validator(check_archive_url, "URL"));
  app.add_flag("--loopback-needs-token", loopback_needs_token,
               "reading over a loopback address needs a token too, as behind a proxy on this machine");
  app.set_version_flag("--version", std::string("touchcald ") + cell::kVersion);

  try {
    app.parse(argc, argv);
    demand_both_of_tls(tls_certificate, tls_key);
    begin_log(log_format);
    cell::DaemonOptions options{.state_directory = state.empty() ? cell::default_state_directory()
                                                                 : std::filesystem::path(state)};
    if (!check) cell::demand_state_directory(options.state_directory);
    if (!backup.empty() || verify)
      return keep_state(options.state_directory / cell::kStoreFile, backup, verify);
    if (cell_file.empty()) throw CLI::RequiredError("--cell");
    if (retain_days > 0) options.retain_days = retain_days;
    for (const std::string& name : host_names)
      options.host_names.push_back(cell::parse_host_name(name).value());
    options.trusts_loopback = !loopback_needs_token;
    options.mqtt = mqtt_options(mqtt);
    if (!archive.empty()) options.archive = archive;
    options.tls_certificate = tls_certificate;
    options.tls_key = tls_key;
    if (!listen.empty()) options.listen = cell::parse_endpoint(listen).value();
    if (!controller.empty()) options.controller = cell::parse_endpoint(controller).value();
    if (check) return tell_check(cell_file, cell::check_daemon(cell_file, options));
    const cell::Cell cell = cell::read_cell(cell_file);
    cell::demand_revolute(cell);
    cell::run_daemon(cell, options);
    return cell::kExitDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? cell::kExitDone : cell::kExitUsage;
  } catch (const cell::ConfigError& error) {
    std::cerr << error.what() << '\n';
    return cell::kExitBadInput;
  } catch (const std::bad_alloc&) {
    std::cerr << "touchcald: there is not enough memory; free some, or give the service more, and start it "
                 "again: what was stored is kept\n";
    return cell::kExitFailed;
  } catch (const std::exception& error) {
    std::cerr << "touchcald: " << error.what() << '\n';
    return cell::kExitFailed;
  }
}
