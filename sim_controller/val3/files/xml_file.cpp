#include "sim_controller/val3/files/xml_file.hpp"

#include <algorithm>
#include <fstream>

#include "sim_controller/val3/files/file_rules.hpp"

namespace val3 {
namespace {

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const auto lead = static_cast<unsigned char>(bytes[i]);
    const std::size_t size = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
    if (size == 0 || i + size > bytes.size()) return false;
    for (std::size_t k = 1; k < size; ++k)
      if ((static_cast<unsigned char>(bytes[i + k]) & 0xC0U) != 0x80U) return false;
    i += size;
  }
  return true;
}

std::string utf8_of_latin1(std::string_view bytes) {
  std::string result;
  result.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      result += c;
    } else {
      result += static_cast<char>(0xC0U | (byte >> 6U));
      result += static_cast<char>(0x80U | (byte & 0x3FU));
    }
  }
  return result;
}

/// What the XML declaration says, in lower case; empty where it says nothing.
std::string declared_encoding(std::string_view bytes) {
  if (!bytes.starts_with("<?xml")) return {};
  const std::string_view declaration = bytes.substr(0, std::min(bytes.find("?>"), std::size_t{200}));
  std::size_t at = declaration.find("encoding");
  if (at == std::string_view::npos) return {};
  at = declaration.find_first_of("\"'", at);
  if (at == std::string_view::npos) return {};
  const std::size_t end = declaration.find(declaration[at], at + 1);
  if (end == std::string_view::npos) return {};
  std::string result(declaration.substr(at + 1, end - at - 1));
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

/// The bytes as UTF-8 without a byte order mark; empty when they are in no encoding that is read.
std::optional<std::string> in_utf8(std::string bytes, FileFindings& findings) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  const bool marked = bytes.starts_with(kByteOrderMark);
  if (marked) bytes.erase(0, kByteOrderMark.size());
  const std::string encoding = declared_encoding(bytes);
  const bool is_latin1 = encoding == "iso-8859-1" || encoding == "latin1" || encoding == "windows-1252";
  if (!encoding.empty() && encoding != "utf-8" && encoding != "utf8" && encoding != "us-ascii" &&
      !is_latin1) {
    findings.error(file_rules::kEncoding, 1, "the encoding " + shown_word(encoding) + " is not read",
                   "save the file as UTF-8");
    return std::nullopt;
  }
  if (bytes.find('\0') != std::string::npos) {
    findings.error(file_rules::kBrokenXml, 0, "the file holds bytes 0: it is no text, or one in UTF-16",
                   "save the file as UTF-8");
    return std::nullopt;
  }
  if (is_latin1 && !marked) return utf8_of_latin1(bytes);
  if (is_utf8(bytes)) return bytes;
  findings.warning(file_rules::kEncoding, 0,
                   "the file says that it is UTF-8, and is not; it is read as ISO-8859-1",
                   "save the file as UTF-8");
  return utf8_of_latin1(bytes);
}

}  // namespace

std::optional<std::string> read_bounded(const std::filesystem::path& path, std::size_t bytes_max,
                                        FileFindings& findings) {
  std::error_code error;
  // A pipe or a device would have no end.
  if (!std::filesystem::is_regular_file(path, error)) {
    const bool there = std::filesystem::exists(path, error);
    findings.error(there ? file_rules::kFileUnreadable : file_rules::kFileMissing, 0,
                   there ? "it is no regular file" : "the file is not there",
                   there ? "" : "add it, or take it out of the project");
    return std::nullopt;
  }
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > bytes_max) {
    findings.error(file_rules::kFileTooLarge, 0,
                   "the file has " + std::to_string(size) + " bytes; at most " + std::to_string(bytes_max) +
                       " are read here",
                   "divide it");
    return std::nullopt;
  }
  std::ifstream in(path, std::ios::binary);
  std::string bytes(error ? 0 : size, '\0');
  if (in) in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (error || !in) {
    findings.error(file_rules::kFileUnreadable, 0, "the file cannot be read");
    return std::nullopt;
  }
  return bytes;
}

std::unique_ptr<XmlFile> XmlFile::parse(std::string bytes, FileFindings& findings) {
  auto utf8 = in_utf8(std::move(bytes), findings);
  if (!utf8) return nullptr;
  std::unique_ptr<XmlFile> file(new XmlFile);
  file->utf8_ = std::move(*utf8);
  file->line_starts_.push_back(0);
  const std::string& text = file->utf8_;
  for (std::size_t i = 0; i < text.size(); ++i)  // a CR by itself ends a line too, for XML
    if (text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n')))
      file->line_starts_.push_back(i + 1);
  const pugi::xml_parse_result result =
      file->document_.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    findings.error(file_rules::kBrokenXml, file->line_at(result.offset),
                   std::string("the file is no XML: ") + result.description());
    return nullptr;
  }
  const pugi::xml_node root = file->root();
  for (const pugi::xml_node other : file->document_.children())
    if (other != root && (other.type() == pugi::node_element || other.type() == pugi::node_pcdata)) {
      findings.error(file_rules::kBrokenXml, file->line_of(other),
                     "there is more than one outermost element");
      return nullptr;
    }
  return file;
}

int XmlFile::line_at(std::ptrdiff_t offset) const {
  if (offset < 0) return 0;
  const auto after = std::ranges::upper_bound(line_starts_, static_cast<std::size_t>(offset));
  return static_cast<int>(after - line_starts_.begin());
}

int XmlFile::line_of(pugi::xml_node node) const { return line_at(node.offset_debug()); }

std::string_view XmlFile::root_name() const { return local_name(root().name()); }

std::string_view XmlFile::root_space() const {
  const std::string_view name = root().name();
  const std::size_t colon = name.find(':');
  const std::string key =
      colon == std::string_view::npos ? "xmlns" : "xmlns:" + std::string(name.substr(0, colon));
  return root().attribute(key.c_str()).value();
}

XmlFile::Text XmlFile::text_of(pugi::xml_node element) const {
  Text result{{}, line_of(element)};
  bool is_first = true;
  int line = 0;  // of the next character
  for (const pugi::xml_node part : element.children()) {
    if (part.type() != pugi::node_pcdata && part.type() != pugi::node_cdata) continue;
    const int begins = line_of(part);
    if (is_first) result.line = line = begins;
    for (; line < begins; ++line) result.text += '\n';
    is_first = false;
    const std::string_view text = part.value();
    line += static_cast<int>(std::ranges::count(text, '\n'));
    result.text += text;
  }
  return result;
}

std::string_view local_name(const char* name) {
  const std::string_view whole = name;
  const std::size_t colon = whole.find(':');
  return colon == std::string_view::npos ? whole : whole.substr(colon + 1);
}

pugi::xml_attribute attribute_of(pugi::xml_node node, std::string_view name) {
  for (const pugi::xml_attribute attribute : node.attributes())
    if (name == attribute.name()) return attribute;
  return {};
}

std::string_view schema_type_of(pugi::xml_node node) {
  for (const pugi::xml_attribute attribute : node.attributes()) {
    const std::string_view name = attribute.name();
    if (name.find(':') != std::string_view::npos && local_name(attribute.name()) == "type")
      return attribute.value();
  }
  return {};
}

}  // namespace val3
