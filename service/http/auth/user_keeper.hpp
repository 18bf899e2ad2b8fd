#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "service/http/auth/user_book.hpp"

namespace cell {

inline constexpr const char* kUserFileSchema = "touchcal/users-file/1";

/// What the file holds; an empty book where there is none. Throws std::runtime_error that names the place
/// and the remedy for a file that others than its owner may read or that does not hold users.
UserBook read_user_file(const std::filesystem::path& file);

/// Makes the file hold the book, all of it or what was there before; only its owner may read it. Throws
/// std::runtime_error that names the file.
void write_user_file(const std::filesystem::path& file, const UserBook& book);

/// What a change does for whom it is about.
enum class Effect {
  kGives,  // something that they could not do before
  kTakes,  // away, or nothing
};

/// The owner of the users and their sessions, on the thread that writes.
class UserKeeper {
 public:
  /// Without a file: in memory. Throws as read_user_file() does.
  explicit UserKeeper(std::optional<std::filesystem::path> file);

  [[nodiscard]] const UserBook& book() const { return book_; }
  /// The book becomes what `change` makes of it. What gives is durable on return; where that fails, this
  /// throws and nothing is changed. What takes away counts in any case: no full disk keeps anybody in. False
  /// where the file does not hold it: a restart would undo it, until keep() or another change has written it.
  bool change(const std::function<Effect(UserBook&)>& change);
  /// Writes what the file does not hold. Whether it holds all then; what hinders it is logged once.
  bool keep();

 private:
  std::optional<std::filesystem::path> file_;
  UserBook book_;
  bool is_kept_ = true;     // the file holds the book
  bool is_logged_ = false;  // that it cannot be written
};

}  // namespace cell
