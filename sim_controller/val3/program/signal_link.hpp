#pragma once

#include <string_view>

namespace val3 {

/// Whether a link's name is an input's: "BasicIO-1\%I0", "FastIO\fIn0", "usrIn1", "bIn3", "SECTEUR_OK". The
/// name of any other signal does not say, nor do these names on a card of a fieldbus: "J206\bIn3".
bool names_input(std::string_view link);

}  // namespace val3
