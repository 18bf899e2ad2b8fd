#include "service/cli/setup_directory.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "config/read_config.hpp"
#include "service/base/durable_file.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void about_to(const BeforeStep& before, const char* step) {
  if (before) before(step);
}

void write_all(const fs::path& directory, const CellFiles& files, const BeforeStep& before) {
  for (const auto& [name, text] : files) {
    about_to(before, "write a file");
    write_replaced(directory / name, text);
  }
}

/// Without what a setup that was broken off left there.
fs::path new_folder(const fs::path& folder, const BeforeStep& before) {
  about_to(before, "remove the folder of an earlier try");
  fs::remove_all(folder);
  about_to(before, "make a folder");
  fs::create_directories(folder);
  return folder;
}

void change_directory(const fs::path& directory, const CellFiles& files, const BeforeStep& before) {
  complete_change(directory, before);
  const fs::path made = new_folder(directory / ".setup-new", before);
  write_all(made, files, before);
  about_to(before, "let the new files count");
  fs::rename(made, directory / kBrokenChangeFolder);
  about_to(before, "make that durable");
  make_directory_durable(directory);
  complete_change(directory, before);
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

bool complete_change(const fs::path& directory, const BeforeStep& before) {
  const fs::path made = directory / kBrokenChangeFolder;
  if (!fs::is_directory(made)) return false;
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(made)) names.push_back(entry.path().filename());
  for (const fs::path& name : names) {
    about_to(before, "move a file into place");
    fs::rename(made / name, directory / name);
  }
  about_to(before, "make the files durable");
  make_directory_durable(directory);
  about_to(before, "end the change");
  fs::remove(made);
  make_directory_durable(directory);
  return true;
}

void write_cell_directory(const fs::path& directory, const CellFiles& files, const BeforeStep& before) {
  fs::path whole = fs::absolute(directory).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  const fs::path unfinished = fmt::format("{}.{}.unfinished", whole.string(), getpid());
  const bool is_there = fs::is_directory(whole);
  try {
    if (is_there) {
      change_directory(whole, files, before);
      return;
    }
    write_all(new_folder(unfinished, before), files, before);
    about_to(before, "give the directory its name");
    fs::rename(unfinished, whole);
  } catch (const std::exception& error) {
    std::error_code ignored;
    fs::remove_all(is_there ? whole / ".setup-new" : unfinished, ignored);
    throw std::runtime_error(
        fmt::format("{} cannot be written ({}); check its rights, those of the folder above "
                    "it and the space on the disk, then give the same command again",
                    directory.string(), error.what()));
  }
}

}  // namespace cell
