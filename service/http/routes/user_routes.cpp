#include "service/http/routes/internal/user_routes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/documents/people_document.hpp"
#include "service/http/auth/access.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {
namespace {

/// What a token of a file may, it may as an engineer does.
std::string_view told_role(const Caller& caller) {
  switch (caller.role) {
    case Role::kNone:
    case Role::kWrongToken:
    case Role::kOverSession:
      return "none";
    case Role::kView:
      return user_role_name(UserRole::kView);
    case Role::kOperate:
      return user_role_name(caller.is_user ? UserRole::kOperate : UserRole::kEngineer);
    case Role::kEngineer:
      return user_role_name(UserRole::kEngineer);
  }
  return "";
}

std::string_view told_kind(const Caller& caller) {
  if (caller.is_user) return "user";
  return caller.role == Role::kNone || caller.role == Role::kWrongToken ? "none" : "token";
}

HttpResponse get_session(const Call& call) { return session_answer(call.request, call.services); }
HttpResponse get_users(const Call& call) { return users_answer(200, call.services); }

/// The PeopleDesk answers, which the Api has; a route by itself has none.
HttpResponse needs_the_desk(const Call&) { throw std::logic_error("answered by the PeopleDesk"); }

Route people_command(std::string_view path, std::string_view summary, Access access, Answer answer,
                     std::string_view body_schema = {}) {
  return {.method = "POST",
          .path = path,
          .summary = summary,
          .access = access,
          .handle = needs_the_desk,
          .answers = {answer},
          .body_schema = body_schema,
          .dispatch = DispatchMode::kPeople};
}

}  // namespace

HttpResponse session_answer(const HttpRequest& request, const Services& services) {
  const Caller caller = caller_of(request, services.tokens);
  SessionDocument document{.role = std::string(told_role(caller)),
                           .kind = std::string(told_kind(caller)),
                           .sign_in = !services.user_book.users.empty()};
  if (!caller.token_name.empty()) document.name = caller.token_name;
  if (caller.is_user && caller.role != Role::kOverSession) {
    const auto session =
        std::ranges::find(services.tokens.sessions, token_digest_of(request), &Session::token_digest);
    if (session != services.tokens.sessions.end()) document.ends_at = session->ends_at;
  }
  return json_response(200, document_text(document));
}

HttpResponse users_answer(unsigned status, const Services& services) {
  UsersDocument document;
  for (const User& user : services.user_book.users)
    document.users.push_back({.name = user.name,
                              .role = std::string(user_role_name(user.role)),
                              .created_at = user.created_at,
                              .created_by = user.created_by,
                              .last_sign_in_at = user.last_sign_in_at,
                              .session_count = session_count(services.tokens.sessions, user.name)});
  return json_response(status, document_text(document));
}

Problem no_user(std::string_view name) {
  return {.status = 404,
          .kind = ProblemKind::kNotFound,
          .detail = fmt::format("there is no user '{}'; GET /api/v1/users lists them", name)};
}

std::vector<Route> user_routes() {
  return {
      {.method = "GET",
       .path = kSessionPath,
       .summary = "Whose token the request carries, and whether people can sign in",
       .access = Access::kOpen,
       .handle = get_session,
       .answers = {{.schema = "Session"}}},
      people_command(kSignInPath,
                     "Gives a token for a name and its secret; wrong ones are slowed down for that name from "
                     "that network",
                     Access::kOpen, {.status = 201, .schema = "SignedIn"}, "SignInRequest"),
      people_command(kSignOutPath, "Ends the session of the request's token; without one nothing is changed",
                     Access::kOpen, {.schema = "Session"}),
      people_command(kOwnSecretPath, "Changes the secret of who is signed in; their other sessions end",
                     Access::kOpen, {.schema = "Session"}, "SecretRequest"),
      {.method = "GET",
       .path = kUsersPath,
       .summary = "Who may sign in",
       .access = Access::kEngineer,
       .handle = get_users,
       .answers = {{.schema = "Users"}}},
      people_command(kUsersPath,
                     "Makes a user, or gives one that is there a role and a secret; their sessions end",
                     Access::kEngineer, {.status = 201, .schema = "Users"}, "UserRequest"),
      people_command(kRemoveUserPath, "Removes a user; their sessions end at once", Access::kEngineer,
                     {.schema = "Users"}),
  };
}

}  // namespace cell
