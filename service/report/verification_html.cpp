#include "service/report/verification_html.hpp"

#include <spdlog/fmt/fmt.h>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"
#include "service/store/run_kind.hpp"

namespace cell {
namespace {

/// What differs between the reports of the kinds, in English.
struct KindWords {
  const char* title;      // with the report's number
  const char* of_what;    // the row of the calibration
  const char* with_what;  // caption
  const char* how;        // caption
  const char* made_by;
  const char* good;
  const char* good_words;
  const char* bad;
  const char* bad_words;
  const char* does_not_show;
  const char* certificates;
  const char* of_touches;  // heading
  DeviationWords deviation;
};

constexpr KindWords kProofWords{
    .title = "Proof report {}",
    .of_what = "calibration that is proved",
    .with_what = "What was proved, with what, by whom",
    .how = "How it was proved",
    .made_by = "Proved by",
    .good = "proved",
    .good_words = "The calibrated arm is right at this place, where it was not calibrated.",
    .bad = "not proved",
    .bad_words = "At this place, where it was not calibrated, the calibrated arm does not meet the limits.",
    .does_not_show =
        "What this proof does not show: it says nothing of volumes that are far both from the place of the "
        "calibration and from the place of this proof, and nothing of what has changed in the cell since.",
    .certificates =
        "The block is the ruler of the calibration and of this proof. An error of its size is in both and "
        "does "
        "not show here; an unknown certificate means that nobody vouches for it.",
    .of_touches = "Distances from the block",
    .deviation = {"distance, µm", "the block", "distance mm"}};

constexpr KindWords kCheckWords{
    .title = "Check report {}",
    .of_what = "calibration that is checked",
    .with_what = "What was checked, with what, by whom",
    .how = "How it was checked",
    .made_by = "Checked by",
    .good = "unchanged",
    .good_words = "The touches are those of the reference, within their noise and the arm's growth.",
    .bad = "changed",
    .bad_words = "Something has changed since the reference.",
    .does_not_show =
        "What this check does not show: it is of change since its reference only, so that what was wrong "
        "with "
        "the calibration or the reference shows in no check. A growth of all lengths is told and is no "
        "fault.",
    .certificates =
        "A check compares touches with earlier ones of the same block: its certificate does not enter the "
        "verdict. It is the ruler of the calibration.",
    .of_touches = "Changes since the reference",
    .deviation = {"change of the distance, µm", "the reference", "change mm"}};

constexpr KindWords kQualificationWords{
    .title = "Qualification report {}",
    .of_what = "calibration that the stylus and the lengths are held against",
    .with_what = "What was qualified, with what, by whom",
    .how = "How it was qualified",
    .made_by = "Qualified by",
    .good = "qualified",
    .good_words = "The probe is within its limits.",
    .bad = "not qualified",
    .bad_words = "The probe does not meet its limits.",
    .does_not_show =
        "What this qualification does not show: the radius of the ball and the pre-travel along the stylus, "
        "unless a calibrated arm measures a length between two sides; and what both had wrong already when "
        "the arm was calibrated.",
    .certificates =
        "Scatter, run-out and lobes need no ruler. The known lengths are those of the block's certificate.",
    .of_touches = "Deviations of the touches",
    .deviation = {"deviation, µm", "the model", "deviation mm"}};

constexpr KindWords kToolWords{
    .title = "Tool report {}",
    .of_what = "calibration whose arm touched",
    .with_what = "Which tool was touched, with what, by whom",
    .how = "How it was touched",
    .made_by = "Touched by",
    .good = "found",
    .good_words = "The touches agree on where the tip of the tool is on the calibrated arm.",
    .bad = "not found",
    .bad_words = "The touches do not agree on where the tip is, or it is not known well enough.",
    .does_not_show =
        "What these touches do not show: which way the tool points, as only its tip has touched, and "
        "whether it is still where it was after it was taken off.",
    .certificates =
        "The block is the ruler, and so is the radius of the tip: an error of it moves the tip along the "
        "tool.",
    .of_touches = "Distances from the block",
    .deviation = {"distance, µm", "the block", "distance mm"}};

const KindWords& words_of_kind(const std::string& kind) {
  if (kind == run_kind_name(RunKind::kTool)) return kToolWords;
  if (kind == run_kind_name(RunKind::kProof)) return kProofWords;
  return kind == run_kind_name(RunKind::kQualification) ? kQualificationWords : kCheckWords;
}

const VerificationVerdict& verdict_in(const FoundVerification& found) {
  static const VerificationVerdict kNoVerdict;
  if (found.proof) return found.proof->verdict;
  if (found.qualification) return found.qualification->verdict;
  if (found.tool) return found.tool->verdict;
  return found.check ? found.check->verdict : kNoVerdict;
}

/// What the result says, and where there is none why.
std::vector<html::Text> reasons_of(const Words& words, const VerificationReport& report,
                                   const FoundVerification& found) {
  std::vector<html::Text> reasons = stored_texts(words, verdict_in(found).reasons);
  if (!found.unreadable.empty())
    reasons.push_back(in_english(words, "the stored result cannot be read: ", found.unreadable));
  else if (!report.result && report.run.outcome == RunOutcome::kRunning)
    reasons.emplace_back(words("the run is not over"));
  else if (!report.result)
    reasons.emplace_back(words("the run ended before it had a result"));
  if (!verdict_in(found).accepted && report.run.fault_message)
    reasons.push_back(in_english(words, "it ended with a fault: ", *report.run.fault_message));
  return reasons;
}

std::string verification_verdict(const Words& words, const VerificationReport& report,
                                 const FoundVerification& found, const KindWords& kind) {
  const std::vector<html::Text> reasons = reasons_of(words, report, found);
  const std::optional<bool> accepted = verdict_in(found).accepted;
  if (!accepted) return verdict_box(words, "none", "This run has no verdict.", reasons);
  return *accepted ? verdict_box(words, kind.good, kind.good_words, reasons)
                   : verdict_box(words, kind.bad, kind.bad_words, reasons);
}

/// "run 1 of 2026-01-31T..., report 20260131-1-3f2a9c1b".
html::Text calibration_text(const Words& words, const VerificationReport::Calibration& of,
                            const FoundVerification& found) {
  if (!of.id)
    return found.qualification && found.qualification->no_of_run
               ? in_english(words, "none: ", *found.qualification->no_of_run)
               : html::Text(words("none"));
  if (!of.raw_data_sha256)
    return words("run {}, which is no longer stored: its date is unknown", words.known(of.id));
  const std::string date = of.ended_at.value_or(of.started_at.value_or(""));
  return words("run {} of {}, recipe {}, {}, report {}", words.known(of.id), words.known(date),
               words.known(of.recipe), words(of.verdict ? word_of(*of.verdict) : "unknown"),
               report_number(date, words.known(of.id), *of.raw_data_sha256));
}

std::string verification_front(const Words& words, const VerificationReport& report,
                               const FoundVerification& found, const ConditionsDocument& conditions,
                               const KindWords& kind, const std::string& issued_at) {
  const std::string arm = found.proof           ? found.proof->arm
                          : found.check         ? found.check->arm
                          : found.qualification ? found.qualification->arm
                          : found.tool          ? found.tool->arm
                                                : std::string();
  std::vector<html::Row> rows = identification_rows(words, report, issued_at, arm, conditions);
  rows.insert(rows.begin() + 1, {{words(kind.of_what), calibration_text(words, report.calibration, found)},
                                 {words("cell"), words.known(report.cell)}});
  return front_sheet(
      words(kind.title, report_number(report)),
      verification_verdict(words, report, found, kind) + html::paragraph(words(kind.does_not_show)) +
          pairs_table(words, words(kind.with_what), rows) + signatures(words, kind.made_by) +
          (found.proof ? proof_tables(words, *found.proof) : std::string()) +
          (found.check ? check_tables(words, *found.check) : std::string()) +
          (found.qualification ? qualification_tables(words, *found.qualification) : std::string()) +
          (found.tool ? tool_tables(words, *found.tool) : std::string()));
}

}  // namespace

std::string verification_html(const VerificationReport& report, const std::string& issued_at,
                              const Words& words) {
  const KindWords& kind = words_of_kind(report.kind);
  const FoundVerification found =
      report.result ? read_verification(report.result->text) : FoundVerification();
  const ConditionsDocument conditions = report.conditions ? report.conditions->value : ConditionsDocument();
  const std::string body =
      verification_front(words, report, found, conditions, kind, issued_at) +
      section(words(kind.of_touches), deviation_figures(words, report, kind.deviation) +
                                          verifying_touches_table(words, report, kind.deviation)) +
      (report.checks ? section(words("From check to check"), check_charts(words, *report.checks))
                     : std::string()) +
      run_section(words, words(kind.how), report, conditions) +
      section(words("Touches and faults"), made_again_table(words, report) + incident_tables(words, report)) +
      section(words("Certificates"),
              certificates_table(words, conditions) + html::paragraph(words(kind.certificates)));
  return printed_page(words, words(kind.title, report_number(report)), body);
}

}  // namespace cell
