#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"
#include "service/documents/conditions_document.hpp"

/// The small documents of the command line: what it reads of the daemon besides runs and status, and what it
/// prints that no daemon answers.
namespace cell {

/// What the sender of a request may do.
struct AccessDocument {
  std::string role;  // operate, view, none, wrong token

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("role", self.role);
  }
};

/// GET /readyz of a cell that accepts a run.
struct ReadyDocument {
  std::string status = "ready";
  std::vector<std::string> remarks;  // what keeps no run from starting

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("status", self.status);
    fields("remarks", self.remarks);
  }
};

/// What the command line reads of GET /api/v1/recipes.
struct RecipeNamesDocument {
  struct Named {
    std::string name;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
    }
  };
  std::vector<Named> recipes;
  std::string default_name;  // of the cell

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("recipes", self.recipes);
    fields("default", self.default_name);
  }
};

/// `touchcal page --json`.
struct PageLinkDocument {
  std::string role;
  std::string url;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("role", self.role);
    fields("url", self.url);
  }
};

/// `touchcal export --json`.
struct ExportDocument {
  std::string run_id;
  std::optional<std::string> arm_file;  // what was written
  std::optional<std::string> urdf_file;
  std::optional<std::string> dh_file;
  CarriedJson verdict;  // of the run's result
  std::vector<std::string> warnings;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("run_id", self.run_id);
    fields("arm_file", self.arm_file);
    fields("urdf_file", self.urdf_file);
    fields("dh_file", self.dh_file);
    fields("verdict", self.verdict);
    fields("warnings", self.warnings);
  }
};

/// `touchcal export-run --json`.
struct ExportedRunDocument {
  std::string run_id;
  std::string cell;
  std::string file;    // what was written
  std::string sha256;  // of the run's file, as in it

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("run_id", self.run_id);
    fields("cell", self.cell);
    fields("file", self.file);
    fields("sha256", self.sha256);
  }
};

std::string document_text(const ReadyDocument& document);
std::string document_text(const PageLinkDocument& document);
std::string document_text(const ExportDocument& document);
std::string document_text(const ExportedRunDocument& document);

/// DocumentError when the text is no such document.
AccessDocument read_access(std::string_view text);
RecipeNamesDocument read_recipe_names(std::string_view text);

/// `place` of the cell's document; nothing where the block stands as the cell's file has it.
std::optional<PlaceDocument> read_place_of_cell(std::string_view text);
/// The tools that can touch the block, of GET /api/v1/cell. DocumentError likewise.
std::vector<std::string> read_tool_tips_of_cell(std::string_view text);

/// The JSON document with its keys in alphabetical order.
std::string sorted_text(std::string_view text);

}  // namespace cell
