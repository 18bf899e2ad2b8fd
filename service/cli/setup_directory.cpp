#include "service/cli/setup_directory.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "service/base/durable_file.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The cell's own file last: until then the old one stands beside what it names.
void write_all(const fs::path& directory, const CellFiles& files) {
  for (const auto& [name, text] : files)
    if (name != kSetupCellFile) write_replaced(directory / name, text);
  write_replaced(directory / kSetupCellFile, files.at(kSetupCellFile));
}

}  // namespace

bool has_cell(const fs::path& directory) { return fs::exists(directory / kSetupCellFile); }

fs::path draft_file(const fs::path& directory) {
  fs::path whole = fs::absolute(directory).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  whole += ".draft.json";
  return whole;
}

std::vector<std::string> changed_by_hand(const fs::path& directory, const CellFiles& files) {
  std::vector<std::string> changed;
  for (const auto& [name, text] : files)
    if (bytes_of(directory / name) != text) changed.push_back(name);
  return changed;
}

void write_replaced(const fs::path& file, const std::string& text) {
  replace_file(file, text);
  // The daemon is another user.
  fs::permissions(
      file, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read | fs::perms::others_read);
}

void write_cell_directory(const fs::path& directory, const CellFiles& files) {
  std::error_code error;
  if (fs::is_directory(directory, error)) {
    write_all(directory, files);
    return;
  }
  fs::path whole = fs::absolute(directory).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  const fs::path unfinished = fmt::format("{}.{}.unfinished", whole.string(), getpid());
  try {
    fs::create_directories(unfinished);
    write_all(unfinished, files);
    fs::rename(unfinished, whole);
  } catch (const std::exception&) {
    fs::remove_all(unfinished, error);
    throw std::runtime_error(directory.string() +
                             " cannot be written; check the folder above it and its rights");
  }
}

}  // namespace cell
