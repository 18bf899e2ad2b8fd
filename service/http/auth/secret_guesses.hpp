#pragma once

#include <chrono>
#include <set>
#include <string>

#include "service/http/auth/guess_counts.hpp"

namespace cell {

/// How often secrets are tried: for each name from each network, and how many names from one network, so that
/// a flood of made-up names is refused before it costs a hash. Names that are there and others are counted
/// alike: who guesses does not learn which are. A name that has signed in from a network is not held up by
/// the others that are tried there. Of one thread.
class SecretGuesses {
 public:
  using TimePoint = GuessCounts::TimePoint;
  using Duration = std::chrono::steady_clock::duration;

  /// `network`: network_of() the client. `is_known`: who asks shows a token that counts.
  struct Guess {
    std::string network;
    std::string name;
    bool is_known = false;
  };

  /// How long until another secret of this name may be tried; zero where it is now.
  [[nodiscard]] Duration wait_of_name(const Guess& guess, TimePoint now) const;
  /// How long until another name may be tried; zero where it is now, and for a name that is counted already.
  [[nodiscard]] Duration wait_of_network(const Guess& guess, TimePoint now) const;

  /// One that begins. It counts as wrong until one of the others is called.
  class Begun {
   private:
    friend class SecretGuesses;
    std::string key;
    std::string network;
    bool is_new_name = false;
  };
  [[nodiscard]] Begun begin(const Guess& guess, TimePoint now);
  /// It was right: all that this name guessed wrong here is forgotten.
  void was_right(const Begun& begun);
  /// Nobody knows, as nothing was compared.
  void was_none(const Begun& begun);

 private:
  [[nodiscard]] bool is_counted(const Guess& guess, TimePoint now) const;

  GuessCounts of_names_;           // by network and name
  GuessCounts new_names_;          // by network
  std::set<std::string> at_home_;  // network and name of who has signed in there
};

}  // namespace cell
