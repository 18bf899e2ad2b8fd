#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <optional>
#include <string>

#include "cs8_protocol/messages.hpp"
#include "service/store/run_store.hpp"

/// Changes of a row of touches, each inside the caller's transaction, and what binds its columns.
namespace cell::row {

template <class Value>
void bind_or_null(SQLite::Statement& statement, int index, const std::optional<Value>& value) {
  if (value) {
    statement.bind(index, *value);
  } else {
    statement.bind(index);
  }
}

/// Behind `index`, which is moved on; nulls for a null pointer.
void bind_joints(SQLite::Statement& statement, int& index, const cs8::JointsMicrodeg* joints);

/// Whether the touch of its number is this one, of the same command and moment, without a repetition.
bool is_there(SQLite::Database& database, std::int64_t run_id, const StoredTouch& touch);
/// Whether the reference touch of its number is this one, of the same moment.
bool is_there(SQLite::Database& database, std::int64_t run_id, const ReferenceTouch& touch);

/// Whether the touch of this number is the answer to the same command. A touch by hand answers none.
bool has_answer(SQLite::Database& database, std::int64_t run_id, const StoredTouch& touch);

/// Moves a touch to superseded_touches. DamagedStore for one that is not as it was written.
void supersede(SQLite::Database& database, std::int64_t run_id, int number, const std::string& reason);

/// Keeps the contact of a repetition with a touch. DamagedStore as above.
void confirm(SQLite::Database& database, std::int64_t run_id, int number, const cs8::JointsMicrodeg& again);

}  // namespace cell::row
