#include "service/offline_programs/filter_list.hpp"

#include <algorithm>

#include "config/config_error.hpp"

namespace cell {
namespace {

constexpr std::string_view kListMark = "\xEF\xBB\xBF";
constexpr std::string_view kListBlanks = " \t";
constexpr std::string_view kFilteredWord = "filtered";
constexpr std::string_view kFilteredPointsWord = "filtered-points";
constexpr std::size_t kSha256Digits = 64;

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(kListBlanks);
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(kListBlanks, begin), line.size());
    words.emplace_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

bool is_sha256(const std::string& word) {
  return word.size() == kSha256Digits &&
         std::ranges::all_of(word, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

bool is_variable_name(const std::string& word) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return word.size() <= kListedNameMax && is_letter(word[0]) &&
         std::ranges::all_of(word, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

bool is_tool_name(const std::string& word) {
  return word.size() <= kListedNameMax &&
         std::ranges::all_of(word, [](char c) { return c > ' ' && c <= '~'; });
}

class FilterListReader {
 public:
  explicit FilterListReader(FilterList& list) : list_(list) {}

  void line(std::string_view text) {
    ++number_;
    if (text.ends_with('\r')) text.remove_suffix(1);
    const std::size_t comment = text.find('#');
    const std::vector<std::string> words = words_of(text.substr(0, comment));
    if (!words.empty()) return variable(words);
    if (comment != std::string_view::npos) remark(words_of(text.substr(comment + 1)));
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ConfigError(list_.source + ':' + std::to_string(number_), "", message);
  }

  void remark(const std::vector<std::string>& words) {
    if (words.empty()) return;
    if (words[0] == kFilteredPointsWord) return points(words);
    if (words[0] != kFilteredWord) return;
    if (words.size() != 3 || !is_sha256(words[1]) || !is_sha256(words[2]))
      fail(
          "is no mark of a filtered file; write # filtered and two SHA-256 of 64 digits, or begin the "
          "comment "
          "with another word");
    list_.filtered.push_back(
        {.original_sha256 = words[1], .result_sha256 = words[2], .source = list_.source});
  }

  void points(const std::vector<std::string>& words) {
    if (words.size() != 3 || !is_variable_name(words[1]) || !is_sha256(words[2]))
      fail(
          "is no mark of filtered points; write # filtered-points, a variable and a SHA-256 of 64 digits, or "
          "begin the comment with another word");
    list_.points.push_back({words[1], words[2], list_.source});
  }

  void variable(const std::vector<std::string>& words) {
    if (!is_variable_name(words[0]))
      fail(in_quotes(words[0]) + " is no name of a variable; write letters, digits and _, a letter first");
    if (words.size() < 2) fail(in_quotes(words[0]) + " has no mark; write offline, taught or leave after it");
    if (words.size() > 3)
      fail(in_quotes(words[3]) + " is one word too many; a line is NAME offline|taught|leave [TOOL]");
    ListedVariable listed{.line = number_};
    if (words[1] == "offline")
      listed.mark = FilterMark::kOffline;
    else if (words[1] == "taught")
      listed.mark = FilterMark::kTaught;
    else if (words[1] != "leave")
      fail(in_quotes(words[1]) + " is no mark; write offline, taught or leave");
    if (words.size() == 3) {
      if (!is_tool_name(words[2]))
        fail(in_quotes(words[2]) + " is no name of a tool; write at most 64 letters");
      listed.tool = words[2];
    }
    const auto [place, is_new] = list_.variables.emplace(words[0], listed);
    if (!is_new)
      fail(in_quotes(words[0]) + " is there twice, first in line " + std::to_string(place->second.line) +
           "; remove one of them");
  }

  FilterList& list_;
  int number_ = 0;
};

}  // namespace

FilterList parse_filter_list(std::string source, std::string_view text) {
  FilterList list{.source = std::move(source)};
  if (text.size() > kFilterListBytesMax)
    throw ConfigError(list.source, "",
                      "is larger than " + std::to_string(kFilterListBytesMax) + " bytes; make it smaller");
  if (text.starts_with(kListMark)) text.remove_prefix(kListMark.size());
  FilterListReader reader(list);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader.line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return list;
}

void refuse_filtered_file(const FilterList& list, const std::string& data_source,
                          const std::string& sha256_of_data) {
  const auto found = std::ranges::find(list.filtered, sha256_of_data, &FilteredMark::result_sha256);
  if (found == list.filtered.end()) return;
  throw ConfigError(data_source, "",
                    "is filtered already, says " + found->source +
                        ": a second filter would correct its points twice; give the original");
}

std::string with_filtered_mark(std::string_view list_text, const FilteredMark& mark) {
  std::string text(list_text);
  if (mark.original_sha256 == mark.result_sha256) return text;
  const std::size_t first_end = text.find('\n');
  const std::string end =
      first_end != std::string::npos && first_end > 0 && text[first_end - 1] == '\r' ? "\r\n" : "\n";
  const auto add = [&](std::string_view word, const std::string& first, const std::string& second) {
    const std::string line = "# " + std::string(word) + ' ' + first + ' ' + second;
    if (text.find(line) != std::string::npos) return;
    if (!text.empty() && !text.ends_with('\n')) text += end;
    text += line + end;
  };
  add(kFilteredWord, mark.original_sha256, mark.result_sha256);
  for (const FilteredPoints& points : mark.points) add(kFilteredPointsWord, points.variable, points.sha256);
  return text;
}

}  // namespace cell
