#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Who may sign in, and who has: what the daemon tells of them. Never a secret, nor its hash.
namespace cell {

/// Whose token a request carries.
struct SessionDocument {
  std::string schema = "touchcal/session/1";
  std::optional<std::string> name;     // of the user, or of a named token
  std::string role = "none";           // none, view, operate, engineer
  std::string kind = "none";           // none, token (in a file), user (who signed in)
  std::optional<std::string> ends_at;  // RFC 3339, of a session that is not over
  bool sign_in = false;                // there are users

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("name", self.name);
    fields("role", self.role);
    fields("kind", self.kind);
    fields("ends_at", self.ends_at);
    fields("sign_in", self.sign_in);
  }
};

/// The answer to a sign-in, the only one with the token.
struct SignedInDocument {
  std::string schema = "touchcal/signed-in/1";
  std::string token;
  std::string name;
  std::string role;
  std::string ends_at;  // RFC 3339

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("token", self.token);
    fields("name", self.name);
    fields("role", self.role);
    fields("ends_at", self.ends_at);
  }
};

struct UserRow {
  std::string name;
  std::string role;                       // view, operate, engineer
  std::string created_at;                 // RFC 3339
  std::optional<std::string> created_by;  // who was signed in then, or the name of a token
  std::optional<std::string> last_sign_in_at;
  int session_count = 0;  // that are not over

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("name", self.name);
    fields("role", self.role);
    fields("created_at", self.created_at);
    fields("created_by", self.created_by);
    fields("last_sign_in_at", self.last_sign_in_at);
    fields("session_count", self.session_count);
  }
};

struct UsersDocument {
  std::string schema = "touchcal/users/1";
  std::vector<UserRow> users;  // by name

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("users", self.users);
  }
};

/// The body of POST /api/v1/users. Without a secret the one that is there stays.
struct UserRequestDocument {
  std::string name;
  std::string role;
  std::optional<std::string> secret;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("name", self.name);
    fields("role", self.role);
    fields.if_set("secret", self.secret);
  }
};

std::string document_text(const SessionDocument& document);
std::string document_text(const SignedInDocument& document);
std::string document_text(const UsersDocument& document);
std::string document_text(const UserRequestDocument& document);

/// DocumentError when the text is no such document.
UsersDocument read_users(std::string_view text);

}  // namespace cell
