#include "calib_core/interleaving.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace calib {
namespace {

int face_count(std::span<const int> faces) { return faces.empty() ? 0 : std::ranges::max(faces) + 1; }

double share(int wanted, int total, int taken) {
  return static_cast<double>(wanted) * static_cast<double>(taken) / static_cast<double>(total);
}

}  // namespace

int interleaving_faults(std::span<const int> faces) {
  const auto count = static_cast<std::size_t>(face_count(faces));
  std::vector<int> wanted(count, 0), done(count, 0);
  for (const int face : faces) ++wanted[static_cast<std::size_t>(face)];
  const int total = static_cast<int>(faces.size());
  int faults = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i > 0 && faces[i] == faces[i - 1]) ++faults;
    ++done[static_cast<std::size_t>(faces[i])];
    for (std::size_t face = 0; face < count; ++face) {
      const double even = share(wanted[face], total, static_cast<int>(i) + 1);
      if (std::abs(done[face] - even) > kInterleavingSlack) ++faults;
    }
  }
  return faults;
}

Interleaving::Interleaving(std::span<const int> faces, int before)
    : wanted_(static_cast<std::size_t>(face_count(faces)), 0),
      done_(wanted_.size(), 0),
      total_(static_cast<int>(faces.size())),
      last_(before) {
  for (const int face : faces) ++wanted_[static_cast<std::size_t>(face)];
}

bool Interleaving::keeps_shares(int face) const {
  for (std::size_t other = 0; other < wanted_.size(); ++other) {
    const int done = done_[other] + (static_cast<int>(other) == face ? 1 : 0);
    if (std::abs(done - share(wanted_[other], total_, taken_ + 1)) > kInterleavingSlack) return false;
  }
  return true;
}

/// With this face next, the rest can go on without a face following itself.
bool Interleaving::leaves_others_between(int face) const {
  const int left = total_ - taken_ - 1;
  for (std::size_t other = 0; other < wanted_.size(); ++other) {
    const bool is_taken = static_cast<int>(other) == face;
    const int due = wanted_[other] - done_[other] - (is_taken ? 1 : 0);
    if (2 * due > left + (is_taken ? 0 : 1)) return false;
  }
  return true;
}

std::vector<int> Interleaving::next_faces() const {
  std::vector<int> due;
  for (std::size_t face = 0; face < wanted_.size(); ++face) {
    if (done_[face] < wanted_[face]) due.push_back(static_cast<int>(face));
  }
  const auto narrow = [&](const auto& is_good) {
    std::vector<int> good;
    std::ranges::copy_if(due, std::back_inserter(good), is_good);
    if (!good.empty()) due = std::move(good);
  };
  narrow([&](int face) { return face != last_; });
  narrow([&](int face) { return leaves_others_between(face); });
  narrow([&](int face) { return keeps_shares(face); });
  return due;
}

void Interleaving::take(int face) {
  ++done_[static_cast<std::size_t>(face)];
  ++taken_;
  last_ = face;
}

}  // namespace calib
