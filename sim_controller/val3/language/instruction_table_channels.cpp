#include "sim_controller/val3/language/instruction_table.hpp"

namespace val3::instruction_table {

std::vector<Row> of_channels() {
  constexpr unsigned kWaits = kYields | kBlocks;
  return {
      // inputs and outputs
      {"dioLink", {"void(dio&, dio)"}, 49, 57},
      {"dioGet", {"num(dio[])"}, 49, 57},
      {"dioSet", {"num(dio[], num)"}, 50, 58},
      {"aioLink", {"void(aio&, aio)"}, 51, 59},
      {"aioGet", {"num(aio)"}, 51, 59},
      {"aioSet", {"num(aio, num)"}, 52, 60},
      {"ioStatus", {"num(dio|aio|sio)"}, 0, 0, kPlain, kS7},
      {"ioBusStatus", {"any(string&[])"}, 0, 0, kPlain, kS7},
      // sockets and serial ports
      {"sioLink", {"void(sio&, sio)"}, 54, 62},
      {"clearBuffer", {"num(sio)"}, 54, 62},
      {"sioGet", {"num(sio, num&[])"}, 54, 62, kWaits},
      {"sioSet", {"num(sio, num[])"}, 55, 63, kWaits},
      {"sioCtrl", {"num(sio, string, num|string|bool)"}, 0, 64, kPlain, kS64},
      // user page; s7 has pages of their own, which are named or are a screen
      {"userPage", {"any(bool?)", "s7 any(screen|string, bool?)"}, 59, 67},
      {"gotoxy", {"void(num, num)", "s7 void(screen, num, num)"}, 60, 68},
      {"cls", {"void()", "s7 void(screen)"}, 60, 68},
      {"getDisplayLen", {"num(string)", "s7 num(screen, string)"}, 0, 68, kPlain, kS6},
      {"put", {"void(string|num)", "s7 void(screen, string|num)"}, 60, 69},
      {"putln", {"void(string|num)", "s7 void(screen, string|num)"}, 60, 69},
      {"title", {"void(string)", "s7 void(screen, string)"}, 61, 69},
      {"get", {"num()", "num(string|num&)", "s7 num(screen)", "s7 num(screen, string|num&)"}, 61, 69, kWaits},
      {"getKey", {"num()", "s7 num(screen)"}, 63, 71},
      {"isKeyPressed", {"bool(num)", "s7 bool(screen, num)"}, 63, 71},
      {"popUpMsg", {"void(string)"}, 63, 71},
      {"logMsg", {"void(string)", "s7 void(string, num)"}, 64, 72},
      {"getProfile", {"string()"}, 64, 72},
      {"setProfile", {"num(string, string)"}, 0, 72, kYields, kS6},
      {"getLanguage", {"string()"}, 0, 73, kPlain, kS64},
      {"setLanguage", {"any(string)"}, 0, 74, kPlain, kS64},
      {"getDate", {"string(string)"}, 0, 74, kPlain, kS64},
      {"setTextMode", {"void(num|bool|string?)", "void(screen, num|bool|string)"}, 0, 0, kPlain, kS7},
      {"userPageSet", {"any(string, string, string, string|num|bool)"}, 0, 0, kPlain, kS7},
      {"userPageAlert", {"any(string, any?)"}, 0, 0, kPlain, kS7},
      {"userPageConfirm", {"any(string, any?)"}, 0, 0, kWaits, kS7},
      {"userPagePrompt", {"any(string, string|num&, any?)"}, 0, 0, kWaits, kS7},
  };
}

}  // namespace val3::instruction_table
