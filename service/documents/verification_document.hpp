#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"

namespace cell {

/// `verdict` of a proof or a check.
struct VerificationVerdict {
  std::optional<bool> accepted;      // nothing: there is none, and `reasons` says why
  std::vector<std::string> reasons;  // one sentence each

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("accepted", self.accepted);
    fields("reasons", self.reasons);
  }
};

/// touchcal/proof/1 (service/doc/surfaces.md): the touches of the block at another place, never fitted,
/// against the calibration of a run. No figure where there is no verdict.
struct ProofDocument {
  /// What these touches would see of what the model lacks; each as large as makes the tip wrong by 0.1 mm.
  struct Power {
    std::string alternative;  // droop, eccentric gears, oval gears
    std::optional<double> power;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("alternative", self.alternative);
      fields("power", self.power);
    }
  };
  struct TouchDistance {
    int touch = 0;  // from 1
    int plane = 0;  // from 1
    std::optional<double> distance_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touch", self.touch);
      fields("plane", self.plane);
      fields("distance_mm", self.distance_mm);
    }
  };

  std::string schema = "touchcal/proof/1";
  std::string arm;
  std::string of_run;
  int touch_count = 0;
  bool complete = false;
  VerificationVerdict verdict;
  std::optional<double> rms_mm;
  std::optional<double> rms_max_mm;
  std::optional<double> chi_square;
  std::optional<double> degrees_of_freedom;
  std::optional<double> p;
  std::optional<double> p_min;
  std::optional<double> noise_um;                   // of a touch, as the calibration measured it
  std::optional<std::array<double, 3>> moved_mm;    // the block since the calibration, in R_-1 then
  std::optional<std::array<double, 3>> turned_deg;  // rotation vector
  std::vector<Power> power;
  std::vector<TouchDistance> touches;
  std::optional<CarriedJson> conditions;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("arm", self.arm);
    fields("of_run", self.of_run);
    fields("touch_count", self.touch_count);
    fields("complete", self.complete);
    fields("verdict", self.verdict);
    fields("rms_mm", self.rms_mm);
    fields("rms_max_mm", self.rms_max_mm);
    fields("chi_square", self.chi_square);
    fields("degrees_of_freedom", self.degrees_of_freedom);
    fields("p", self.p);
    fields("p_min", self.p_min);
    fields("noise_um", self.noise_um);
    fields("moved_mm", self.moved_mm);
    fields("turned_deg", self.turned_deg);
    fields("power", self.power);
    fields("touches", self.touches);
    fields("conditions", self.conditions);
  }
};

/// touchcal/check/1 (service/doc/surfaces.md): the touches of the commissioning once more. The first ones of
/// a calibration are its reference and have no verdict.
struct CheckDocument {
  struct Reference {
    int count = 0;  // checks that are in it, this one among them where it is one
    int needed = 0;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("count", self.count);
      fields("needed", self.needed);
    }
  };
  /// As if this joint alone had changed, beside the arm's growth.
  struct Joint {
    int joint = 0;  // from 1
    std::optional<double> offset_mrad;
    std::optional<double> std_offset_mrad;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("joint", self.joint);
      fields("offset_mrad", self.offset_mrad);
      fields("std_offset_mrad", self.std_offset_mrad);
    }
  };
  struct TouchChange {
    int touch = 0;                    // from 1
    int plane = 0;                    // from 1
    std::optional<double> change_mm;  // of its distance since the reference

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touch", self.touch);
      fields("plane", self.plane);
      fields("change_mm", self.change_mm);
    }
  };

  std::string schema = "touchcal/check/1";
  std::string arm;
  std::string of_run;
  int touch_count = 0;
  bool complete = false;
  VerificationVerdict verdict;
  Reference reference;
  std::optional<double> chi_square;
  std::optional<double> degrees_of_freedom;
  std::optional<double> p;
  std::optional<double> joint_p;
  std::optional<double> p_min;  // of each of the two
  std::optional<double> rms_mm;
  std::optional<double> noise_um;    // of a touch, as the reference scatters
  std::optional<std::string> cause;  // of an alarm: joint, block, stylus, unknown
  std::optional<int> joint;          // of the first
  std::vector<Joint> joints;
  std::optional<double> growth_ppm;  // of the arm's lengths since the reference
  std::optional<double> std_growth_ppm;
  std::optional<double> warmer_k;  // what the growth stands for, where the arm's expansion is known
  std::optional<int> every_days;   // how often the cell's file wants a check; left out where it does not say
  std::vector<TouchChange> touches;
  std::optional<CarriedJson> conditions;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("arm", self.arm);
    fields("of_run", self.of_run);
    fields("touch_count", self.touch_count);
    fields("complete", self.complete);
    fields("verdict", self.verdict);
    fields("reference", self.reference);
    fields("chi_square", self.chi_square);
    fields("degrees_of_freedom", self.degrees_of_freedom);
    fields("p", self.p);
    fields("joint_p", self.joint_p);
    fields("p_min", self.p_min);
    fields("rms_mm", self.rms_mm);
    fields("noise_um", self.noise_um);
    fields("cause", self.cause);
    fields("joint", self.joint);
    fields("joints", self.joints);
    fields("growth_ppm", self.growth_ppm);
    fields("std_growth_ppm", self.std_growth_ppm);
    fields("warmer_k", self.warmer_k);
    fields.if_set("every_days", self.every_days);
    fields("touches", self.touches);
    fields("conditions", self.conditions);
  }
};

std::string document_text(const ProofDocument& document);
std::string document_text(const CheckDocument& document);

/// DocumentError when the text is no such document.
ProofDocument read_proof(std::string_view text);
CheckDocument read_check(std::string_view text);

/// "touchcal/proof/1" of a result document of any kind; empty where it names none. DocumentError where it is
/// no JSON.
std::string schema_of(std::string_view text);

}  // namespace cell
