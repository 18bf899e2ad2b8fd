#pragma once

#include "config/read_config.hpp"
#include "folder.hpp"

namespace cell {

inline constexpr const char* kArm = "arms/tx90.json";
inline constexpr const char* kBlock = "cells/demo/block.json";
inline constexpr const char* kProbe = "cells/demo/probe.json";
inline constexpr const char* kRecipe = "recipes/edf-25.json";
inline constexpr const char* kCell = "cells/demo/cell.json";
inline constexpr const char* kTruth = "cells/demo/truth.json";
inline constexpr const char* kRealTruth = "cells/demo/truth-real.json";

/// Of the cell with a star stylus.
inline constexpr const char* kStarCell = "cells/star/cell.json";
inline constexpr const char* kStarProbe = "cells/star/probe.json";
inline constexpr const char* kStarRecipe = "cells/star/star.json";
inline constexpr const char* kStarTruth = "cells/star/truth.json";

inline bool is_truth(const std::string& file) {
  return file == kTruth || file == kRealTruth || file == kStarTruth;
}

/// Makes a document of the cell, block or probe one of an earlier schema, which has no serial numbers.
inline void lower_schema(nlohmann::json& document, std::string_view schema) {
  for (const char* key : {"serial", "arm_serial", "controller_serial"}) document.erase(key);
  document.erase("places");  // of the block
  if (const auto limits = document.find("acceptance"); limits != document.end()) limits->erase("probe");
  if (const auto tools = document.find("tools"); tools != document.end())
    for (auto& tool : *tools) tool.erase("tip");
  document["schema"] = schema;
}

/// A copy of the shipped configuration to spoil: the demo cell, whose files have every kind of entry.
class CopiedConfig : public testing::Test {
 protected:
  CopiedConfig() {
    for (const char* name : {"arms", "cells", "recipes"}) {
      std::filesystem::copy(kSourceDir / "config" / name, folder_.path() / name,
                            std::filesystem::copy_options::recursive);
    }
  }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  void edit(const std::string& file, const std::function<void(nlohmann::json&)>& change) const {
    nlohmann::json document = json_of(path(file));
    change(document);
    folder_.write(file, document.dump());
  }

  [[nodiscard]] Cell read() const { return read_cell(path(kCell)); }

  Folder folder_;
};

}  // namespace cell
