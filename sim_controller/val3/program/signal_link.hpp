#pragma once

#include <string_view>

namespace val3 {

/// Whether a link's name is an input's: "BasicIO-1\%I0", "FastIO\fIn0", "usrIn1", "bIn3", "SECTEUR_OK". The
/// name of any other signal, as a fieldbus has them, does not say.
bool names_input(std::string_view link);

}  // namespace val3
