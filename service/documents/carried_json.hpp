#pragma once

#include <string>

namespace cell {

/// A part of a document that is passed on as it was written, whatever it holds; "" is null.
struct CarriedJson {
  std::string text;
};

/// The same for a part that is also read: the writer passes `text` on, the reader sets `text` and `value`. So
/// a part that an older daemon stored is shown without the fields that it never had.
template <class T>
struct Carried {
  std::string text;
  T value;
};

}  // namespace cell
