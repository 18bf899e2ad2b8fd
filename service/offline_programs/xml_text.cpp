#include "service/offline_programs/xml_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "config/config_error.hpp"

namespace cell {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
/// An XML declaration is shorter.
constexpr std::size_t kXmlDeclarationMax = 200;

/// What the XML declaration says, in lower case; empty where it says nothing.
std::string encoding_told(std::string_view bytes) {
  if (bytes.starts_with(kUtf8Mark)) bytes.remove_prefix(kUtf8Mark.size());
  if (!bytes.starts_with("<?xml")) return {};
  const std::string_view declaration = bytes.substr(0, std::min(bytes.find("?>"), kXmlDeclarationMax));
  const std::size_t word = declaration.find("encoding");
  if (word == std::string_view::npos) return {};
  const std::size_t open = declaration.find_first_of("\"'", word);
  if (open == std::string_view::npos) return {};
  const std::size_t close = declaration.find(declaration[open], open + 1);
  if (close == std::string_view::npos) return {};
  std::string told(declaration.substr(open + 1, close - open - 1));
  for (char& c : told)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return told;
}

bool is_read_as_it_is(std::string_view encoding) {
  for (const std::string_view known :
       {"", "utf-8", "utf8", "us-ascii", "iso-8859-1", "latin1", "windows-1252"})
    if (encoding == known) return true;
  return false;
}

}  // namespace

XmlText::XmlText(std::string source, std::string bytes)
    : source_(std::move(source)), bytes_(std::move(bytes)) {
  if (bytes_.size() > kVal3FileBytesMax)
    throw ConfigError(source_, "",
                      "has " + std::to_string(bytes_.size()) + " bytes, more than the " +
                          std::to_string(kVal3FileBytesMax) + " that are read; divide it");
  if (bytes_.find('\0') != std::string::npos)
    throw ConfigError(source_, "", "holds bytes 0: it is no text, or one in UTF-16; save it as UTF-8");
  const std::string encoding = encoding_told(bytes_);
  if (!is_read_as_it_is(encoding))
    throw ConfigError(source_, "", "is in the encoding " + in_quotes(encoding) + "; save it as UTF-8");
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < bytes_.size(); ++i)  // a CR by itself ends a line too, for XML
    if (bytes_[i] == '\n' || (bytes_[i] == '\r' && (i + 1 == bytes_.size() || bytes_[i + 1] != '\n')))
      line_starts_.push_back(i + 1);
  parsed_.assign(bytes_.begin(), bytes_.end());
  const pugi::xml_parse_result result =
      document_.load_buffer_inplace(parsed_.data(), parsed_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result)
    fail_at_line(line_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))),
                 std::string("is no whole XML: ") + result.description() + "; save it again from its editor");
  for (const pugi::xml_node other : document_.children())
    if (other != root() && (other.type() == pugi::node_element || other.type() == pugi::node_pcdata))
      fail_at_line(1, "has more than one outermost element; save it again from its editor");
}

std::string_view XmlText::root_space() const {
  const std::string_view name = root().name();
  const std::size_t colon = name.find(':');
  const std::string key =
      colon == std::string_view::npos ? "xmlns" : "xmlns:" + std::string(name.substr(0, colon));
  return root().attribute(key.c_str()).value();
}

int XmlText::line_at(std::size_t place) const {
  return static_cast<int>(std::ranges::upper_bound(line_starts_, place) - line_starts_.begin());
}

std::size_t XmlText::place_of(const char* inside) const {
  const std::less<> before;
  if (before(inside, parsed_.data()) || before(parsed_.data() + parsed_.size(), inside))
    throw std::logic_error("the XML parser handed out an address that is not in the file");
  return static_cast<std::size_t>(inside - parsed_.data());
}

XmlText::Span XmlText::value_span(pugi::xml_attribute attribute) const {
  const std::size_t begin = place_of(attribute.value());
  const std::size_t end = bytes_.find(bytes_.at(begin - 1), begin);
  if (end == std::string::npos) throw std::logic_error("an attribute without its closing quote was parsed");
  return {begin, end};
}

void XmlText::fail(pugi::xml_node element, const std::string& message) const {
  fail_at_line(line_of(element), message);
}

void XmlText::fail_at_line(int line, const std::string& message) const {
  throw ConfigError(source_ + ':' + std::to_string(line), "", message);
}

std::string_view unprefixed(const char* name) {
  const std::string_view whole = name;
  const std::size_t colon = whole.find(':');
  return colon == std::string_view::npos ? whole : whole.substr(colon + 1);
}

pugi::xml_node element_named(pugi::xml_node parent, std::string_view name) {
  for (const pugi::xml_node child : parent.children())
    if (child.type() == pugi::node_element && unprefixed(child.name()) == name) return child;
  return {};
}

std::string_view xsi_type_of(pugi::xml_node element) {
  for (const pugi::xml_attribute attribute : element.attributes())
    if (std::string_view(attribute.name()).find(':') != std::string_view::npos &&
        unprefixed(attribute.name()) == "type")
      return attribute.value();
  return {};
}

}  // namespace cell
