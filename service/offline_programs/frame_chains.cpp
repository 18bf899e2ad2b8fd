#include "service/offline_programs/frame_chains.hpp"

#include <charconv>

#include "config/config_error.hpp"
#include "service/offline_programs/trsf_pose.hpp"

namespace cell {
namespace {

constexpr std::string_view kWorldName = "world";

bool is_world(const FrameName& frame) { return frame.alias.empty() && frame.name == kWorldName; }

/// An element of an array whose value was left out.
bool is_left_out(const StoredVariable& variable, const std::string& key) {
  if (variable.is_collection) return false;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  return error == std::errc{} && end == key.data() + key.size() && index < variable.size;
}

}  // namespace

FrameChains::FrameChains(const XmlText& xml, const StoredData& data, double mm_per_unit, TaughtFrames taught)
    : xml_(xml), data_(data), taught_(std::move(taught)) {
  for (const StoredVariable& variable : data.variables) {
    if (variable.kind != StoredKind::kFrame || variable.name == kWorldName) continue;
    for (const StoredElement& element : variable.elements) {
      places_.emplace(std::pair{variable.name, element.key}, frames_.size());
      const SixNumbers trsf = element.numbers ? numbers_of(*element.numbers) : SixNumbers{};
      frames_.push_back({&variable, &element, pose_of_trsf(trsf, mm_per_unit)});
    }
  }
  for (const StoredVariable& variable : data.variables) {
    if (variable.kind != StoredKind::kFrame && variable.kind != StoredKind::kPoint) continue;
    for (const StoredElement& element : variable.elements) demand_frame(variable, element);
  }
  for (Frame& frame : frames_)
    if (frame.element->father) frame.father = place_of(*frame.element->father);
  for (std::size_t i = 0; i < frames_.size(); ++i) follow(i);
}

void FrameChains::demand_frame(const StoredVariable& variable, const StoredElement& element) const {
  if (!element.father || is_world(*element.father) || !element.father->alias.empty()) return;
  const FrameName& father = *element.father;
  if (places_.contains({father.name, father.key})) return;
  const std::string who = shown_element(variable, element.key) + " is given in " + in_quotes(father.name);
  const auto place = data_.places.find(father.name);
  if (place == data_.places.end())
    xml_.fail_at_line(element.line,
                      who + ", which is not in the file; add the frame, or give another father");
  const StoredVariable& found = data_.variables[place->second];
  if (found.kind != StoredKind::kFrame)
    xml_.fail_at_line(element.line, who + ", which is a " + found.type + "; give a frame");
  if (!is_left_out(found, father.key))
    xml_.fail_at_line(element.line,
                      who + ", which has no element [" + father.key + "]; give one that is there");
}

std::size_t FrameChains::place_of(const FrameName& frame) const {
  if (is_world(frame) || !frame.alias.empty()) return kWorld;
  const auto place = places_.find({frame.name, frame.key});
  return place == places_.end() ? kWorld : place->second;
}

// Not by recursion: a chain may be as long as the file.
void FrameChains::follow(std::size_t frame) {
  std::vector<std::size_t> way;
  std::size_t at = frame;
  while (at != kWorld && frames_[at].state == Frame::State::kOpen) {
    frames_[at].state = Frame::State::kOnTheWay;
    way.push_back(at);
    at = frames_[at].father;
  }
  if (at != kWorld && frames_[at].state == Frame::State::kOnTheWay)
    xml_.fail_at_line(frames_[at].element->line,
                      shown_element(*frames_[at].variable, frames_[at].element->key) +
                          " is given in itself, by way of its father; give another father");
  for (; !way.empty(); way.pop_back()) {
    Frame& one = frames_[way.back()];
    const Found father = one.element->father ? find(*one.element->father) : Found{};
    one.found = {father.world_from_frame * one.father_from_frame, father.unknown};
    if (one.found.unknown.empty() && taught_.names.contains(one.variable->name))
      one.found.unknown = "the frame " + one.variable->name + " was touched with the nominal arm, says " +
                          taught_.source +
                          " (taught), and holds that arm's errors; touch it again with the " +
                          "calibrated arm and mark it leave";
    one.state = Frame::State::kDone;
  }
}

FrameChains::Found FrameChains::find(const FrameName& frame) const {
  if (!frame.alias.empty())
    return {.unknown = "the frame " + frame.name + " is in the library " + frame.alias +
                       ", whose file is another; copy the frame into this file"};
  const std::size_t place = place_of(frame);
  return place == kWorld ? Found{} : frames_[place].found;
}

}  // namespace cell
