#pragma once

#include <stdexcept>
#include <string>

namespace cell {

/// A document that cannot be read. The message names the field by its JSON pointer.
class DocumentError : public std::runtime_error {
 public:
  DocumentError(const std::string& pointer, const std::string& what)
      : std::runtime_error((pointer.empty() ? std::string("the document") : pointer) + ": " + what) {}
};

/// The text is no JSON at all.
class NotJson : public DocumentError {
 public:
  NotJson() : DocumentError("", "is no JSON") {}
};

}  // namespace cell
