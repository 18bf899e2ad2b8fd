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

/// The owner of the users and their sessions, on the thread that writes.
class UserKeeper {
 public:
  /// Without a file: in memory. Throws as read_user_file() does.
  explicit UserKeeper(std::optional<std::filesystem::path> file);

  [[nodiscard]] const UserBook& book() const { return book_; }
  /// The book as `change` has made it, durable on return. Where that fails, it throws and nothing is changed.
  const UserBook& change(const std::function<void(UserBook&)>& change);

 private:
  std::optional<std::filesystem::path> file_;
  UserBook book_;
};

}  // namespace cell
