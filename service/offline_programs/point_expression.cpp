#include "service/offline_programs/point_expression.hpp"

#include <Eigen/Core>

#include "service/offline_programs/trsf_pose.hpp"

namespace cell {
namespace {

/// "-12.5" or "12.5" and nothing else.
std::optional<double> constant_in(const std::vector<ProgramToken>& tokens, TokenRange range) {
  double sign = 1.0;
  while (range.first < range.second &&
         (is_sign(tokens, range.first, "-") || is_sign(tokens, range.first, "+"))) {
    if (tokens[range.first].text == "-") sign = -sign;
    ++range.first;
  }
  if (range.first + 1 != range.second || tokens[range.first].kind != ProgramToken::Kind::kNumber)
    return std::nullopt;
  return sign * tokens[range.first].number;
}

}  // namespace

double PointExpressions::KnownTrsf::distance_mm(double mm_per_unit) const {
  return mm_per_unit * Eigen::Vector3d(trsf[0], trsf[1], trsf[2]).norm();
}

bool PointExpressions::KnownTrsf::turns() const { return trsf[3] != 0.0 || trsf[4] != 0.0 || trsf[5] != 0.0; }

std::string PointExpressions::element_named_in(const ScannedProgram& program,
                                               const std::vector<ProgramToken>& tokens, TokenRange range) {
  const auto [begin, end] = range;
  if (begin >= end || !is_own_name(tokens, begin) || program.text.own_types.contains(tokens[begin].text))
    return {};
  const std::string name(tokens[begin].text);
  if (begin + 1 == end) return name + "[0]";
  if (!is_sign(tokens, begin + 1, "[") || closing_of(tokens, begin + 1) + 1 != end) return {};
  std::string key;
  for (const TokenRange& index : listed_in(tokens, begin + 1)) {
    if (!key.empty()) key += ',';
    if (index.first + 1 != index.second) return {};
    const ProgramToken& token = tokens[index.first];
    if (token.kind == ProgramToken::Kind::kText)
      key += token.text;
    else if (token.kind == ProgramToken::Kind::kNumber)
      key += token.text.substr(0, token.text.find('.'));  // the integer part counts (manual 6, page 21)
    else
      return {};
  }
  return name + '[' + key + ']';
}

std::optional<PointExpressions::KnownTrsf> PointExpressions::trsf(const ScannedProgram& program,
                                                                  const std::vector<ProgramToken>& tokens,
                                                                  TokenRange range) const {
  if (is_sign(tokens, range.first, "{") && closing_of(tokens, range.first) + 1 == range.second) {
    const std::vector<TokenRange> fields = listed_in(tokens, range.first);
    KnownTrsf known;
    if (fields.size() != known.trsf.size()) return std::nullopt;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto number = constant_in(tokens, fields[i]);
      if (!number) return std::nullopt;
      known.trsf[i] = *number;
    }
    return known;
  }
  const std::string name = element_named_in(program, tokens, range);
  const auto found = data_.trsfs.find(name);
  if (found == data_.trsfs.end()) return std::nullopt;
  return KnownTrsf{found->second, name};
}

std::optional<StoredPlace> PointExpressions::place(const ScannedProgram& program,
                                                   const std::vector<ProgramToken>& tokens,
                                                   TokenRange range) const {
  const auto [begin, end] = range;
  if (begin < end && is_own_name(tokens, begin) && tokens[begin].text == "appro" &&
      is_sign(tokens, begin + 1, "(") && closing_of(tokens, begin + 1) + 1 == end) {
    const std::vector<TokenRange> arguments = listed_in(tokens, begin + 1);
    if (arguments.size() != 2) return std::nullopt;
    auto from = place(program, tokens, arguments[0]);
    const auto by = trsf(program, tokens, arguments[1]);
    if (!from || !by) return std::nullopt;
    from->world_from_tool = from->world_from_tool * pose_of_trsf(by->trsf, mm_per_unit_);
    return from;
  }
  const auto found = data_.points.find(element_named_in(program, tokens, range));
  return found == data_.points.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace cell
