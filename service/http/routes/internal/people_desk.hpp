#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <functional>
#include <optional>
#include <string>

#include "service/http/auth/access.hpp"
#include "service/http/auth/hash_places.hpp"
#include "service/http/auth/secret_guesses.hpp"
#include "service/http/auth/user_book.hpp"
#include "service/http/auth/user_keeper.hpp"
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
/// thread of its own, what is changed is written on that of the store. What takes something away counts also
/// where it cannot be written.
class PeopleDesk {
 public:
  /// `take` gets the users after each change, on the thread that serves. `services` must outlive this.
  PeopleDesk(boost::asio::any_io_executor hashing, boost::asio::any_io_executor store, Services& services,
             std::function<void(const UserBook&)> take);

  /// The answer to a request of DispatchMode::kPeople. `is_recorded`: it stands in the audit; where it could
  /// not be recorded, only what takes something away is done.
  boost::asio::awaitable<PersonAnswer> answer(const HttpRequest& request, const Route& route,
                                              std::string_view id, bool is_recorded = true);

 private:
  boost::asio::awaitable<PersonAnswer> answer_by_path(const HttpRequest& request, const Route& route,
                                                      std::string_view id, bool is_recorded);
  boost::asio::awaitable<PersonAnswer> sign_in(const HttpRequest& request);
  boost::asio::awaitable<PersonAnswer> sign_out(const HttpRequest& request);
  boost::asio::awaitable<PersonAnswer> change_own_secret(const HttpRequest& request);
  boost::asio::awaitable<std::optional<Problem>> why_own_secret_stays(const HttpRequest& request,
                                                                      const Caller& caller);
  boost::asio::awaitable<HttpResponse> put(const HttpRequest& request, bool is_recorded);
  boost::asio::awaitable<HttpResponse> remove(const HttpRequest& request, const std::string& name);

  /// A name and a secret that somebody gives, and by what right.
  struct Tried {
    const std::string& name;
    const std::string& secret;
    bool is_by_token = false;  // one that counts is shown
  };
  boost::asio::awaitable<std::optional<Problem>> why_not_theirs(const HttpRequest& request, Tried tried,
                                                                std::string& hash);
  boost::asio::awaitable<std::optional<Problem>> hash_new(const std::string& secret, std::string& hash);
  boost::asio::awaitable<std::optional<Problem>> write(const std::function<Effect(UserBook&)>& change);
  [[nodiscard]] Caller caller(const HttpRequest& request) const;

  boost::asio::any_io_executor hashing_;
  boost::asio::any_io_executor store_;
  Services& services_;
  std::function<void(const UserBook&)> take_;
  HashPlaces places_;
  SecretGuesses guesses_;
};

}  // namespace cell
