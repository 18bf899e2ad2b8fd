#pragma once

#include <span>
#include <vector>

namespace calib {

/// How far a sequence of faces is from interleaved: how often a face follows itself, and how often one is
/// more than kInterleavingSlack touches ahead of its even share. 0 is interleaved; where a face has more
/// touches than all others together some remain.
int interleaving_faults(std::span<const int> faces);

/// Touches that a face may be ahead of its share of all touches so far, or behind it.
inline constexpr double kInterleavingSlack = 2.0;

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
  [[nodiscard]] bool keeps_shares(int face) const;
  [[nodiscard]] bool leaves_others_between(int face) const;

  std::vector<int> wanted_, done_;
  int total_ = 0;
  int taken_ = 0;
  int last_;
};

}  // namespace calib
