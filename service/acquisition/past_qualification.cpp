#include "service/acquisition/past_qualification.hpp"

#include <spdlog/spdlog.h>

#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/utc_text.hpp"
#include "service/documents/qualification_document.hpp"

namespace cell {

std::optional<QualifiedNoise> qualification_that_counts(const RunStore& store,
                                                        const std::optional<std::string>& config_digest,
                                                        std::chrono::system_clock::time_point now) try {
  const auto run = store.last_complete(RunKind::kQualification);
  if (!run || run->verdict != Verdict::kAccepted || !config_digest || run->config_digest != config_digest)
    return std::nullopt;
  const auto ended = time_from_utc(run->ended_at.value_or(""));
  if (!ended || *ended > now || now - *ended > kQualifiedFor) return std::nullopt;
  const auto stored = store.result_json(run->id);
  if (!stored) return std::nullopt;
  const auto scatter = read_qualification(*stored).scatter;
  if (!scatter.std_um || !scatter.degrees_of_freedom) return std::nullopt;
  // As it is written with the run: whoever identifies again has the same number.
  const double scatter_um =
      scatter_um_of({calib::metres_from_um(*scatter.std_um), *scatter.degrees_of_freedom});
  return QualifiedNoise{run->id, {calib::metres_from_um(scatter_um), *scatter.degrees_of_freedom}};
} catch (const std::runtime_error& error) {
  spdlog::error("what the probe was qualified with cannot be told: {}", error.what());
  return std::nullopt;
}

}  // namespace cell
