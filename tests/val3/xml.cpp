#include "tests/val3/xml.hpp"

#include <algorithm>
#include <cctype>

namespace val3 {
namespace {

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {
    if (bytes_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  Element document() {
    if (!take("<?xml version=\"1.0\"")) fail("no XML declaration");
    skip_past("?>");
    skip_space();
    Element root = element("", false);
    skip_space();
    if (at_ != bytes_.size()) fail("more behind the root element");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { throw Problem{file_, line_, text}; }

  char next() {
    if (at_ == bytes_.size()) fail("the file ends too early");
    const char c = bytes_[at_++];
    if (c == '\n') ++line_;
    return c;
  }
  [[nodiscard]] char peek() const { return at_ < bytes_.size() ? bytes_[at_] : '\0'; }

  bool take(std::string_view word) {
    if (!bytes_.substr(at_).starts_with(word)) return false;
    for (std::size_t i = 0; i < word.size(); ++i) next();
    return true;
  }
  void expect(std::string_view word) {
    if (!take(word)) fail("expected '" + std::string(word) + "'");
  }
  std::string skip_past(std::string_view word) {
    std::string skipped;
    while (!take(word)) skipped += next();
    return skipped;
  }
  void skip_space() {
    for (;;) {
      while (std::isspace(static_cast<unsigned char>(peek())) != 0) next();
      if (!take("<!--")) return;
      skip_past("-->");
    }
  }

  std::string name() {
    std::string result;
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 || peek() == '_' || peek() == ':' ||
           peek() == '-')
      result += next();
    if (result.empty()) fail("expected a name");
    return result;
  }

  char entity() {
    for (const auto& [word, c] :
         {std::pair{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}})
      if (take(word)) return c;
    fail("an entity that is none of the five");
  }

  void attributes(Element& element) {
    for (;;) {
      const std::size_t before = at_;
      skip_space();
      if (peek() == '>' || peek() == '/') return;
      if (at_ == before) fail("expected a space before an attribute");
      const std::string key = name();
      expect("=");
      expect("\"");
      std::string value;
      while (peek() != '"') {
        if (peek() == '<') fail("'<' in an attribute");
        value += peek() == '&' ? entity() : next();
      }
      next();
      if (!element.attributes.emplace(key, value).second) fail("attribute " + key + " twice");
    }
  }

  Element element(const std::string& outer_space, bool xsi_known) {
    Element result{.line = line_};
    expect("<");
    result.name = name();
    attributes(result);
    const std::string own_space = result.attribute("xmlns");
    result.space = own_space.empty() ? outer_space : own_space;
    if (result.attributes.contains("xmlns:xsi")) {
      if (result.attribute("xmlns:xsi") != "http://www.w3.org/2001/XMLSchema-instance")
        fail("xmlns:xsi is not XMLSchema-instance");
      xsi_known = true;
    }
    if (result.attributes.contains("xsi:type") && !xsi_known) fail("xsi:type without xmlns:xsi");
    if (take("/>")) return result;
    expect(">");
    result.text_line = line_;
    content(result, xsi_known);
    return result;
  }

  void content(Element& result, bool xsi_known) {
    while (!take("</")) {
      if (take("<![CDATA[")) {
        result.text_line = line_;
        result.text += skip_past("]]>");
      } else if (take("<!--")) {
        skip_past("-->");
      } else if (peek() == '<') {
        result.children.push_back(element(result.space, xsi_known));
      } else {
        const char c = peek() == '&' ? entity() : next();
        if (std::isspace(static_cast<unsigned char>(c)) == 0 || !result.text.empty()) result.text += c;
      }
    }
    const std::string closing = name();
    if (closing != result.name) fail("</" + closing + "> closes <" + result.name + ">");
    expect(">");
  }

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::string Element::attribute(std::string_view key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? "" : found->second;
}

const Element* Element::child(std::string_view child_name) const {
  const auto found = std::ranges::find(children, child_name, &Element::name);
  return found == children.end() ? nullptr : &*found;
}

Element read_xml(std::string_view bytes, const std::string& file) { return Reader(bytes, file).document(); }

}  // namespace val3
