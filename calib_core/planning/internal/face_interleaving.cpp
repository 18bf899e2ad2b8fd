#include "calib_core/planning/internal/face_interleaving.hpp"

#include <algorithm>
#include <iterator>

namespace calib {
namespace {

int face_count(std::span<const int> faces) { return faces.empty() ? 0 : std::ranges::max(faces) + 1; }

bool is_ahead(int done, int wanted, int total, int taken) {
  const double share = static_cast<double>(wanted) * static_cast<double>(taken) / static_cast<double>(total);
  return done - share > kInterleavingSlack;
}

}  // namespace

int interleaving_violations(std::span<const int> faces) {
  const auto count = static_cast<std::size_t>(face_count(faces));
  std::vector<int> wanted(count, 0), done(count, 0);
  for (const int face : faces) ++wanted[static_cast<std::size_t>(face)];
  const int total = static_cast<int>(faces.size());
  int faults = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i > 0 && faces[i] == faces[i - 1]) ++faults;
    const auto face = static_cast<std::size_t>(faces[i]);
    ++done[face];
    if (is_ahead(done[face], wanted[face], total, static_cast<int>(i) + 1)) ++faults;
  }
  return faults;
}

FaceInterleaving::FaceInterleaving(std::span<const int> faces, int before)
    : wanted_(static_cast<std::size_t>(face_count(faces)), 0),
      done_(wanted_.size(), 0),
      total_(static_cast<int>(faces.size())),
      last_(before) {
  for (const int face : faces) ++wanted_[static_cast<std::size_t>(face)];
}

bool FaceInterleaving::keeps_share(int face) const {
  const auto index = static_cast<std::size_t>(face);
  return !is_ahead(done_[index] + 1, wanted_[index], total_, taken_ + 1);
}

/// Whether the remaining touches can be ordered without repeating a face when this face is next.
bool FaceInterleaving::leaves_others_between(int face) const {
  const int left = total_ - taken_ - 1;
  for (std::size_t other = 0; other < wanted_.size(); ++other) {
    const bool is_taken = static_cast<int>(other) == face;
    const int due = wanted_[other] - done_[other] - (is_taken ? 1 : 0);
    if (2 * due > left + (is_taken ? 0 : 1)) return false;
  }
  return true;
}

std::vector<int> FaceInterleaving::next_faces() const {
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
  if (std::ranges::any_of(due, [&](int face) { return leaves_others_between(face); })) {
    narrow([&](int face) { return leaves_others_between(face); });
    narrow([&](int face) { return keeps_share(face); });
  } else if (!due.empty()) {  // the face with too many touches comes between the others as often as possible
    const auto left = [&](int face) {
      return wanted_[static_cast<std::size_t>(face)] - done_[static_cast<std::size_t>(face)];
    };
    due = {*std::ranges::max_element(due, {}, left)};
  }
  return due;
}

void FaceInterleaving::take(int face) {
  ++done_[static_cast<std::size_t>(face)];
  ++taken_;
  last_ = face;
}

}  // namespace calib
