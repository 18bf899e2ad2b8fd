#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <string_view>

#include "service/base/terminal_text.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/documents/audit_document.hpp"

namespace cell {
namespace {

/// Rows that are asked for at once.
constexpr int kAuditPageRows = 500;

/// As a field of CSV, RFC 4180; a text of a request that a spreadsheet would take for a formula stays a text.
std::string csv_field(const std::string& text) {
  constexpr std::string_view kFormulas = "=+-@\t\r";
  std::string field = "\"";
  if (!text.empty() && kFormulas.find(text.front()) != std::string_view::npos) field += '\'';
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string audit_csv(const AuditDocument& audit) {
  std::string lines = "id,at,role,token,operator,remote,action,outcome,detail,hash\r\n";
  for (const AuditRow& row : audit.rows) {
    const std::array fields{row.id,
                            row.at,
                            row.role,
                            row.token_name.value_or(""),
                            row.operator_name.value_or(""),
                            row.remote,
                            row.action,
                            row.outcome,
                            row.detail,
                            row.hash};
    for (const std::string& field : fields) lines += (&field == fields.data() ? "" : ",") + csv_field(field);
    lines += "\r\n";
  }
  return lines;
}

std::string audit_text(const AuditDocument& audit) {
  std::string lines = fmt::format("{:<26}{:<13}{:<11} {:<17} {:<18}{:<10}{}\n", "at", "role", "token",
                                  "operator", "from", "outcome", "action");
  for (const AuditRow& row : audit.rows) {
    lines += fmt::format("{:<26}{:<13}{:<11} {:<17} {:<18}{:<10}{}{}{}\n", row.at, row.role,
                         row.token_name.value_or("-"), row.operator_name.value_or("-"), row.remote,
                         row.outcome, row.action, row.detail.empty() ? "" : "; ", row.detail);
  }
  return terminal_text(lines);  // names come from requests
}

}  // namespace

ExitCode audit_command(const ApiClient& daemon, const AuditArguments& arguments, bool json) {
  AuditDocument all;
  for (int left = arguments.limit; left > 0; left = arguments.limit - static_cast<int>(all.rows.size())) {
    std::string target = fmt::format("/api/v1/audit?limit={}", std::min(left, kAuditPageRows));
    if (all.next_before) target += "&before=" + *all.next_before;
    const ApiReply reply = daemon.get(target);
    if (reply.status != 200) return print_problem(reply, json);
    AuditDocument page = read_reply(reply, read_audit);
    all.next_before = page.next_before;
    std::ranges::move(page.rows, std::back_inserter(all.rows));
    if (!all.next_before) break;
  }
  fmt::print("{}", json ? document_text(all) + "\n" : arguments.csv ? audit_csv(all) : audit_text(all));
  return kExitDone;
}

}  // namespace cell
