#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "service/offline_programs/stored_data.hpp"

namespace cell {

/// Frames that were touched with the nominal arm: they hold its errors, and no place in them is known.
struct TaughtFrames {
  std::set<std::string, std::less<>> names = {};
  std::string source = {};  // what says so
};

/// The frames of a data file in the controller's world, each by way of its fathers in the same file. Lengths
/// in metres. A frame whose value was left out is its father, the world.
class FrameChains {
 public:
  /// Throws ConfigError with the line: a father of a frame or a point that is not in the file, is no frame or
  /// beyond its size; frames that are given in each other.
  FrameChains(const XmlText& xml, const StoredData& data, double mm_per_unit, TaughtFrames taught = {});

  /// The frame, or why it is not known: it is of a library, whose file is another.
  struct Found {
    Eigen::Isometry3d world_from_frame = Eigen::Isometry3d::Identity();
    std::string unknown;
  };
  [[nodiscard]] Found find(const FrameName& frame) const;

 private:
  static constexpr std::size_t kWorld = static_cast<std::size_t>(-1);
  struct Frame {
    const StoredVariable* variable = nullptr;
    const StoredElement* element = nullptr;
    Eigen::Isometry3d father_from_frame = Eigen::Isometry3d::Identity();
    std::size_t father = kWorld;
    Found found;
    enum class State { kOpen, kOnTheWay, kDone } state = State::kOpen;
  };

  void demand_frame(const StoredVariable& variable, const StoredElement& element) const;
  [[nodiscard]] std::size_t place_of(const FrameName& frame) const;
  void follow(std::size_t frame);

  const XmlText& xml_;
  const StoredData& data_;
  TaughtFrames taught_;
  std::map<std::pair<std::string, std::string>, std::size_t> places_;  // by name and key
  std::vector<Frame> frames_;
};

}  // namespace cell
