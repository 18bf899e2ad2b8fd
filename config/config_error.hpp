#pragma once

#include <stdexcept>
#include <string>

namespace cell {

/// Something given from outside (a file, a request's body) is not what it must be. what() is one line:
/// "SOURCE: /json/pointer: what is wrong; what to do".
class ConfigError : public std::runtime_error {
 public:
  /// `source`: a file's path, or what else the bytes are called. `pointer`: RFC 6901, empty for the whole
  /// document.
  ConfigError(std::string source, std::string pointer, std::string message);

  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] const std::string& message() const { return message_; }

 private:
  std::string source_;
  std::string pointer_;
  std::string message_;
};

/// The text in double quotes, cut after 60 characters; for names that came from outside.
std::string in_quotes(const std::string& text);

}  // namespace cell
