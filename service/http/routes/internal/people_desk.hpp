#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <functional>
#include <optional>
#include <string>

#include "service/http/auth/access.hpp"
#include "service/http/auth/guess_counts.hpp"
#include "service/http/auth/user_book.hpp"
#include "service/http/server/http_message.hpp"
#include "service/http/server/problem.hpp"

namespace cell {

struct Route;
struct Services;

/// An answer, and who it was for: a sign-in tells that itself.
struct PersonAnswer {
  HttpResponse response;
  Caller caller;
};

/// Signs people in and out, and changes who they are. Used on the thread that serves; a secret is hashed on a
/// thread of its own, what is changed is written on that of the store, and counts from then on.
class PeopleDesk {
 public:
  /// Secrets at once that are hashed or wait for it. One more is told that the daemon is busy: a flood of
  /// guesses must not take the machine.
  static constexpr int kAtOnceMax = 4;

  /// `take` gets the users after each change, on the thread that serves. `services` must outlive this.
  PeopleDesk(boost::asio::any_io_executor hashing, boost::asio::any_io_executor store, Services& services,
             std::function<void(const UserBook&)> take);

  /// The answer to a request of DispatchMode::kPeople.
  boost::asio::awaitable<PersonAnswer> answer(const HttpRequest& request, const Route& route,
                                              std::string_view id);

 private:
  boost::asio::awaitable<PersonAnswer> sign_in(const HttpRequest& request);
  boost::asio::awaitable<PersonAnswer> sign_out(const HttpRequest& request);
  boost::asio::awaitable<PersonAnswer> change_own_secret(const HttpRequest& request);
  boost::asio::awaitable<HttpResponse> put(const HttpRequest& request);
  boost::asio::awaitable<HttpResponse> remove(const HttpRequest& request, const std::string& name);

  boost::asio::awaitable<std::optional<Problem>> why_not_theirs(const HttpRequest& request,
                                                                const std::string& name,
                                                                const std::string& secret, std::string& hash);
  boost::asio::awaitable<std::string> hashed(const std::string& secret);
  boost::asio::awaitable<std::optional<Problem>> write(const std::function<void(UserBook&)>& change);
  [[nodiscard]] Caller caller(const HttpRequest& request) const;

  boost::asio::any_io_executor hashing_;
  boost::asio::any_io_executor store_;
  Services& services_;
  std::function<void(const UserBook&)> take_;
  int at_once_ = 0;
  GuessCounts wrong_secrets_;  // by name and network
};

}  // namespace cell
