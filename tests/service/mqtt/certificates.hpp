#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/config/folder.hpp"

namespace cell {

/// A folder with certificates, made once for a program's tests.
inline const std::filesystem::path& certificates() {
  static const Folder folder;
  static const std::filesystem::path made = [] {
    const std::string script = std::string(TOUCHCAL_SOURCE_DIR) + "/tests/service/mqtt/make_certificates";
    if (std::system((script + " " + folder.path().string()).c_str()) != 0)  // NOLINT(cert-env33-c)
      throw std::runtime_error("no certificates: " + (folder.path() / "make_certificates.err").string());
    return folder.path();
  }();
  return made;
}

}  // namespace cell
