#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/store/audit_chain.hpp"

namespace cell {

/// A row of the audit.
struct AuditRow {
  std::string id;
  std::string at;                            // RFC 3339
  std::string role;                          // operate, view, none, wrong token
  std::optional<std::string> token_name;     // of the token, where it has one
  std::optional<std::string> operator_name;  // of the run that the request is for
  std::string remote;
  std::string action;
  std::string outcome;
  std::string detail;
  std::string hash;  // audit_hash() in store/audit_chain.hpp

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("id", self.id);
    fields("at", self.at);
    fields("role", self.role);
    fields("token", self.token_name);
    fields("operator", self.operator_name);
    fields("remote", self.remote);
    fields("action", self.action);
    fields("outcome", self.outcome);
    fields("detail", self.detail);
    fields("hash", self.hash);
  }
};

/// A page of the audit, newest first.
struct AuditDocument {
  std::vector<AuditRow> rows;
  std::optional<std::string> next_before;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("rows", self.rows);
    fields("next_before", self.next_before);
  }
};

/// `next_before`: the id to request the next page with, absent on the last.
AuditDocument audit_page(const std::vector<AuditEntry>& entries, std::optional<std::int64_t> next_before);

std::string document_text(const AuditDocument& document);

/// DocumentError when the text is no such document.
AuditDocument read_audit(std::string_view text);

}  // namespace cell
