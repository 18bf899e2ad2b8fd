#include "sim_controller/val3/language/instruction_table.hpp"

namespace val3::instruction_table {

std::vector<Row> of_values() {
  return {
      // numbers
      {"sin", {"num(num)"}, 32, 35},
      {"cos", {"num(num)"}, 33, 36},
      {"tan", {"num(num)"}, 34, 37},
      {"asin", {"num(num)"}, 33, 36},
      {"acos", {"num(num)"}, 33, 36},
      {"atan", {"num(num)"}, 34, 37},
      {"abs", {"num(num)", "joint(joint)", "jointRs(jointRs)"}, 34, 37},
      {"sqrt", {"num(num)"}, 35, 38},
      {"exp", {"num(num)"}, 35, 38},
      {"power", {"num(num, num)"}, 0, 38, kPlain, kS6},
      {"ln", {"num(num)"}, 36, 39},
      {"log", {"num(num)"}, 36, 39},
      {"roundUp", {"num(num)"}, 37, 40},
      {"roundDown", {"num(num)"}, 37, 40},
      {"round", {"num(num)"}, 37, 40},
      {"min", {"num(num, num)"}, 38, 41},
      {"max", {"num(num, num)"}, 38, 41},
      {"limit", {"num(num, num, num)"}, 38, 41},
      {"sel", {"num(bool, num, num)"}, 39, 42},
      // bits and bytes
      {"bAnd", {"num(num, num)"}, 0, 43, kPlain, kS64},
      {"bOr", {"num(num, num)"}, 0, 44, kPlain, kS64},
      {"bXor", {"num(num, num)"}, 0, 44, kPlain, kS64},
      {"bNot", {"num(num)"}, 0, 45, kPlain, kS64},
      {"toBinary", {"num(num[], num, string, num&[])"}, 0, 46, kPlain, kS64},
      {"fromBinary", {"num(num[], num, string, num&[])"}, 0, 46, kPlain, kS64},
      // strings
      {"toString", {"string(string, num)"}, 40, 48},
      {"toNum", {"string(string, num&, bool&)"}, 41, 49},
      {"chr", {"string(num)"}, 42, 50},
      {"asc", {"num(string, num)"}, 43, 51},
      {"left", {"string(string, num)"}, 43, 51},
      {"right", {"string(string, num)"}, 44, 52},
      {"mid", {"string(string, num, num)"}, 44, 52},
      {"insert", {"string(string, string, num)", "s7 any(any&)"}, 45, 53},
      {"delete", {"string(string, num, num)", "s7 any(any&)"}, 45, 53},
      {"replace", {"string(string, string, num, num)"}, 46, 54},
      {"find", {"num(string, string)"}, 46, 54},
      {"len", {"num(string)"}, 47, 55},
      // arrays and collections
      {"size", {"num(any[])", "s7 num(any[], num)"}, 29, 31},
      {"getData", {"num(string, any&[])"}, 0, 32, kPlain, kS64},
      {"resize", {"any(any&[], num, num)"}, 0, 0, kPlain, kS7},
      {"append", {"any(any&[])"}, 0, 0, kPlain, kS7},
      {"isDefined", {"bool(any[])"}, 0, 0, kPlain, kS7},
      {"first", {"string(any[])"}, 0, 0, kPlain, kS7},
      {"last", {"string(any[])"}, 0, 0, kPlain, kS7},
      {"next", {"string(any[])"}, 0, 0, kPlain, kS7},
      {"prev", {"string(any[])"}, 0, 0, kPlain, kS7},
  };
}

}  // namespace val3::instruction_table
