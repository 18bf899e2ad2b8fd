#pragma once

#include <span>
#include <vector>

namespace calib {

/// Touches that a face may be ahead of its even share of those so far.
inline constexpr double kInterleavingSlack = 2.0;

/// How far a sequence of faces is from interleaved: how often a face follows itself, and how often one is
/// more than kInterleavingSlack ahead. Where a face has more touches than all others together some are left.
int interleaving_faults(std::span<const int> faces);

/// Builds a sequence of faces, touch by touch, that ends interleaved as far as the counts allow.
class Interleaving {
 public:
  /// `faces`: of all touches of the sequence, in any order, counted from 0. `before`: the face touched before
  /// it begins, -1 for none.
  explicit Interleaving(std::span<const int> faces, int before = -1);

  /// The faces one of which may come next; never empty while touches are left.
  [[nodiscard]] std::vector<int> next_faces() const;
  void take(int face);

 private:
  [[nodiscard]] bool keeps_share(int face) const;
  [[nodiscard]] bool leaves_others_between(int face) const;

  std::vector<int> wanted_, done_;
  int total_ = 0;
  int taken_ = 0;
  int last_;
};

}  // namespace calib
