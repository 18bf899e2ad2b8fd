#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/verification_document.hpp"

namespace cell {

/// touchcal/comparison/1 (service/doc/surfaces.md): two calibrations of one arm, compared by the independent
/// combinations of errors that both identified.
struct ComparisonDocument {
  struct Share {
    std::string parameter;
    std::optional<double> share;  // -1 to 1, of the errors in their standard deviations

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("parameter", self.parameter);
      fields("share", self.share);
    }
  };
  struct Combination {
    std::optional<double> e_n;  // later minus earlier by the expanded uncertainty of that, k = 2
    std::vector<Share> shares;  // the largest first

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("e_n", self.e_n);
      fields("shares", self.shares);
    }
  };
  struct Part {
    std::optional<bool> changed;  // nothing, as the figures: none of these errors was identified by both
    std::optional<double> p;
    std::optional<double> chi_square;
    std::optional<double> degrees_of_freedom;
    std::vector<Combination> combinations;  // the most striking first

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("changed", self.changed);
      fields("p", self.p);
      fields("chi_square", self.chi_square);
      fields("degrees_of_freedom", self.degrees_of_freedom);
      fields("combinations", self.combinations);
    }
  };

  std::string schema = "touchcal/comparison/1";
  std::string earlier;  // runs
  std::string later;
  VerificationVerdict verdict;  // accepted: neither has changed, as far as is known
  std::optional<double> p_min;  // of each part
  std::optional<double> growth_ppm;
  std::optional<double> std_growth_ppm;
  std::optional<double> tip_difference_mm;      // rms over the workspace box, the block's place apart
  std::optional<double> std_tip_difference_mm;  // what chance alone makes of it
  Part arm;                                     // beside its growth
  Part tool;                                    // the stylus

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("earlier", self.earlier);
    fields("later", self.later);
    fields("verdict", self.verdict);
    fields("p_min", self.p_min);
    fields("growth_ppm", self.growth_ppm);
    fields("std_growth_ppm", self.std_growth_ppm);
    fields("tip_difference_mm", self.tip_difference_mm);
    fields("std_tip_difference_mm", self.std_tip_difference_mm);
    fields("arm", self.arm);
    fields("tool", self.tool);
  }
};

std::string document_text(const ComparisonDocument& document);

/// DocumentError when the text is no such document.
ComparisonDocument read_comparison(std::string_view text);

}  // namespace cell
