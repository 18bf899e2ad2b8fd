#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/simulation/table_cell.hpp"

namespace simulation {

/// A row of the fault table: the cells of a mode, one for each step.
using TableRow = std::vector<TriedCell>;

/// The numbers of mode (0: nothing goes wrong) and step (from 1), as the document has them.
using CellNumber = std::pair<std::size_t, std::size_t>;

/// service/doc/fault_modes.md; `rows` are of all table_modes(), in their order.
std::string fault_table_document(std::span<const TableRow> rows);

/// What the document says of each cell: cell_text().
std::map<CellNumber, std::string> cells_of_document(const std::string& document);

/// What it says under "Contradictions", of each cell that is there.
std::map<CellNumber, std::vector<std::string>> contradictions_of_document(const std::string& document);

/// One cell as the document has it; `without` is that of the first row at the same step.
std::string cell_text(const TableCell& cell, const TableCell& without);

/// Codes of the fault table that no cell has, with the reason.
const std::map<std::string, std::string>& codes_without_cell();
/// Of P01 to P42 those that are no row, with where they are tested.
const std::map<std::string, std::string>& modes_without_row();

}  // namespace simulation
