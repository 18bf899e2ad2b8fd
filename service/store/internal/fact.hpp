#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "service/store/model_store.hpp"
#include "service/store/outbox.hpp"

/// Facts of the outbox, each inside the caller's transaction.
namespace cell::row {

struct NewFact {
  FactKind kind = FactKind::kFault;
  std::string at;
  std::optional<std::int64_t> run_id;
  std::string body;
};

void append_fact(SQLite::Database& database, const NewFact& fact);

/// A row of `Fact`, its columns in this order.
inline constexpr const char* kFactColumns = "seq, instance, kind, at, run_id, previous, body, sha256";
Fact fact_in(SQLite::Statement& row);

/// What a fact tells, of the rows as they are now in this transaction.
void tell_run_started(SQLite::Database& database, std::int64_t run_id);
/// With it, where the run has touches, that they are closed.
void tell_run_ended(SQLite::Database& database, std::int64_t run_id);
void tell_run_withdrawn(SQLite::Database& database, std::int64_t run_id);
/// Of a run that has ended: a touch or its result changed since.
void tell_touch_set(SQLite::Database& database, std::int64_t run_id);

/// One that was approved or rolled back. `current` and `document`: the hash of the model that is the cell's
/// now, and what is told of it.
struct ToldModel {
  std::string hash;
  std::optional<std::string> operator_name;
  std::optional<std::string> valid_until;
  std::string current;
  std::string document;
  std::optional<std::chrono::days> check_every;  // of an approval, by the cell's file
};
std::string model_body(const ToldModel& model);
std::string application_body(const Approval& application);
std::string fault_body(const std::string& code, const std::string& message);
std::string certificate_body(const ExpiringCertificate& certificate);

}  // namespace cell::row
