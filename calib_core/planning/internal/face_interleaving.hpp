#pragma once

#include <span>
#include <vector>

namespace calib {

/// Number of touches by which a face may be ahead of its proportional share so far.
inline constexpr double kInterleavingSlack = 2.0;

/// Counts how often a face follows itself and how often one is more than kInterleavingSlack ahead. Not 0 for
/// any order when a face has more touches than all others together.
int interleaving_violations(std::span<const int> faces);

/// Builds a sequence of faces, touch by touch, that is interleaved as far as the counts allow.
class FaceInterleaving {
 public:
  /// `faces`: of all touches of the sequence, in any order, counted from 0. `before`: the last face before
  /// the sequence, -1 for none.
  explicit FaceInterleaving(std::span<const int> faces, int before = -1);

  /// The faces that may be next; never empty while touches remain.
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
