#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "service/store/run_copy.hpp"

namespace cell {

/// Largest file of a run: twenty times that of 150 touches.
inline constexpr std::size_t kRunFileBytesMax = 8 * 1024 * 1024;

/// touchcal/run-file/1: a run that ended, with all that is stored of it and the model that was approved of
/// it, as it travels from one daemon to another.
struct RunFile {
  std::string cell;         // the name of the cell that the run is of
  std::string exported_at;  // RFC 3339
  RunCopy copy;
  std::optional<std::string> model_json;  // touchcal/model/1; nothing: none was approved
};

/// With its SHA-256 over everything else in it.
std::string document_text(const RunFile& file);

/// A file as it came, and the digest that it has.
struct ReadRunFile {
  RunFile file;
  std::string sha256;
};

/// The file in a text from outside. DocumentError, with the place, when the text is none of at most
/// kRunFileBytesMax; when it is not as it was written (its digest, or that of the model, is another); when it
/// holds what no daemon stores of a run that ended. The digest finds damage; whoever changes a file can write
/// a new one.
ReadRunFile read_run_file(std::string_view text);

}  // namespace cell
