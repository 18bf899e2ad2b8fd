#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace cell {

/// Who may have a secret hashed now: each hash takes memory and some tenths of a second of the one thread
/// that makes them, behind those before it. A flood from one network leaves places for all others, and who
/// shows a token that counts has places apart. Of one thread.
class HashPlaces {
 public:
  static constexpr int kOfStrangers = 4;  // of all who show no token
  static constexpr int kOfNetwork = 2;    // of those, of one network
  static constexpr int kOfTokens = 2;     // of who shows one
  static constexpr int kMost = kOfStrangers + kOfTokens;

  /// Held to the end of its scope. The places must outlive it.
  class Place {
   public:
    Place(Place&& other) noexcept
        : places_(std::exchange(other.places_, nullptr)), network_(std::move(other.network_)) {}
    ~Place() {
      if (places_) places_->leave(network_);
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    Place& operator=(Place&&) = delete;

   private:
    friend class HashPlaces;
    Place(HashPlaces& places, std::optional<std::string> network)
        : places_(&places), network_(std::move(network)) {}

    HashPlaces* places_;
    std::optional<std::string> network_;  // none: of a token
  };

  /// Nothing where they are all taken.
  std::optional<Place> take_as_stranger(const std::string& network);
  std::optional<Place> take_by_token();

 private:
  void leave(const std::optional<std::string>& network);

  std::map<std::string, int> of_network_;  // without those that are zero
  int of_strangers_ = 0;
  int of_tokens_ = 0;
};

}  // namespace cell
