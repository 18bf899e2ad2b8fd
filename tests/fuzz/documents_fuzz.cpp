#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string_view>
#include <vector>

#include "config/arm_file.hpp"
#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "config/touches_file.hpp"
#include "service/documents/checks_document.hpp"
#include "service/documents/comparison_document.hpp"
#include "service/documents/compensation_document.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/model_document.hpp"
#include "service/documents/people_document.hpp"
#include "service/documents/plan_document.hpp"
#include "service/documents/result_document.hpp"
#include "service/documents/run_file.hpp"
#include "service/documents/verification_document.hpp"
#include "service/documents/verification_report.hpp"

namespace {

using Reader = std::function<void(std::string_view)>;

/// What was taken is written, read and written again the same.
template <class Document>
Reader kept(Document (*read)(std::string_view)) {
  return [read](std::string_view text) {
    const std::string written = document_text(read(text));
    if (document_text(read(written)) != written) std::abort();
  };
}

const cell::Cell& demo_cell() {
  static const cell::Cell cell = cell::read_cell(TOUCHCAL_SOURCE_DIR "/config/cells/demo/cell.json");
  return cell;
}

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all{
      kept(cell::read_checks),
      kept(cell::read_comparison),
      kept(cell::read_proof),
      kept(cell::read_check),
      kept(cell::read_verification_report),
      kept(cell::read_model),
      kept(cell::read_plan),
      kept(cell::read_result),
      [](std::string_view text) { (void)cell::read_conditions(text); },
      [](std::string_view text) { (void)cell::read_run_file(text); },
      [](std::string_view text) { (void)cell::read_arm_text("the arm", text); },
      [](std::string_view text) {
        (void)cell::touches_from_json("the touches", text, cell::kTouchesSizeMax, demo_cell());
      },
      [](std::string_view text) { (void)cell::touches_from_csv("the touches", text, demo_cell()); },
      kept(cell::read_users),
  };
  return all;
}

}  // namespace

/// The first byte says which document the others are: it is taken, or refused with words.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    readers()[data[0] % readers().size()](text);
  } catch (const cell::DocumentError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  } catch (const cell::ConfigError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
  return 0;
}
