#include "service/documents/command_documents.hpp"

#include <nlohmann/json.hpp>

#include "service/documents/internal/document_fields.hpp"

namespace cell {
namespace {

/// What is read of the cell's document (cell_view.hpp).
struct PlaceOfCell {
  std::optional<PlaceDocument> place;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("place", self.place);
  }
};

struct ToolsOfCell {
  std::vector<std::string> tool_tips;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("tool_tips", self.tool_tips);
  }
};

}  // namespace

std::string document_text(const ReadyDocument& document) { return written(document); }
std::string document_text(const PageLinkDocument& document) { return written(document); }
std::string document_text(const ExportDocument& document) { return written(document); }
std::string document_text(const ExportedRunDocument& document) { return written(document); }

AccessDocument read_access(std::string_view text) {
  return document_from<AccessDocument>(text, Absent::kIsRefused);
}

RecipeNamesDocument read_recipe_names(std::string_view text) {
  return document_from<RecipeNamesDocument>(text, Absent::kIsRefused);
}

std::optional<PlaceDocument> read_place_of_cell(std::string_view text) {
  return document_from<PlaceOfCell>(text, Absent::kIsRefused).place;
}

std::vector<std::string> read_tool_tips_of_cell(std::string_view text) {
  return document_from<ToolsOfCell>(text, Absent::kIsRefused).tool_tips;
}

std::string sorted_text(std::string_view text) { return nlohmann::json::parse(text).dump(); }

}  // namespace cell
