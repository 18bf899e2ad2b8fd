#include "service/http/routes/reads.hpp"

#include "service/acquisition/cell_operation.hpp"

namespace cell {

Reads::Reads(const CellOperation& operation)
    : operation_(operation),
      store_(operation.store()),
      located_(operation.located_cell()),
      regions_(std::in_place, located_->cell, located_->regions) {}

Reads::Reads(const CellOperation& operation, const std::filesystem::path& store_file)
    : operation_(operation),
      own_store_(RunStore::reader(store_file)),
      store_(*own_store_),
      located_(operation.located_cell()),
      regions_(std::in_place, located_->cell, located_->regions) {}

void Reads::update(std::shared_ptr<const ActiveRun> live) {
  live_ = std::move(live);
  auto located = operation_.located_cell();
  if (located == located_) return;
  located_ = std::move(located);
  regions_.emplace(located_->cell, located_->regions);
}

const std::optional<std::string>& Reads::config_digest() const { return operation_.config_digest(); }

std::chrono::system_clock::time_point Reads::now() const { return operation_.clocks().system(); }

std::optional<std::string> Reads::live_result(std::int64_t run_id) const {
  const ActiveRun* live = own_store_ ? live_.get() : operation_.active_run();
  return live && live->run.id() == run_id ? result_json(*live, tip_regions()) : std::nullopt;
}

}  // namespace cell
