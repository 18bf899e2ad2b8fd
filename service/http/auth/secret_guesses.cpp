#include "service/http/auth/secret_guesses.hpp"

namespace cell {
namespace {

/// No name has a line end in it that one of the users can have.
std::string guess_key(const SecretGuesses::Guess& guess) { return guess.network + '\n' + guess.name; }

}  // namespace

SecretGuesses::Duration SecretGuesses::wait_of_name(const Guess& guess, TimePoint now) const {
  return of_names_.wait(guess_key(guess), now);
}

SecretGuesses::Duration SecretGuesses::wait_of_network(const Guess& guess, TimePoint now) const {
  return is_counted(guess, now) ? Duration::zero() : new_names_.wait(guess.network, now);
}

bool SecretGuesses::is_counted(const Guess& guess, TimePoint now) const {
  const std::string key = guess_key(guess);
  return guess.is_known || of_names_.knows(key, now) || at_home_.contains(key);
}

SecretGuesses::Begun SecretGuesses::begin(const Guess& guess, TimePoint now) {
  Begun begun;
  begun.key = guess_key(guess);
  begun.network = guess.network;
  begun.is_new_name = !is_counted(guess, now);
  if (begun.is_new_name) new_names_.add(begun.network, now);
  of_names_.add(begun.key, now);
  return begun;
}

void SecretGuesses::was_right(const Begun& begun) {
  of_names_.forgive(begun.key);
  if (begun.is_new_name) new_names_.take_back(begun.network);
  if (at_home_.size() >= GuessCounts::kKeysMax) at_home_.clear();  // they are held up as all others, once
  at_home_.insert(begun.key);
}

void SecretGuesses::was_none(const Begun& begun) {
  of_names_.take_back(begun.key);
  if (begun.is_new_name) new_names_.take_back(begun.network);
}

}  // namespace cell
