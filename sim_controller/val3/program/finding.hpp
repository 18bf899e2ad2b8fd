#pragma once

#include <string>
#include <vector>

namespace val3 {

/// Where in an application's files something is.
struct Position {
  std::string file;  // as the project names it, from the application's folder: "readHost.pgx", "lib/x.dtx"
  int line = 0;      // from 1; 0: the whole file
  int column = 0;    // from 1; 0: the whole line
};

/// kError: a controller refuses the application, or it fails there. kWarning: it runs and hardly does what
/// was meant. kNote: it differs by version, or is worth knowing.
enum class Severity { kNote, kWarning, kError };

/// One thing that was found in an application: where, what, why, and the remedy.
struct Finding {
  Severity severity = Severity::kError;
  std::string rule;  // of rules.hpp: "array-by-value"
  Position at;
  std::string what;    // "x_nBytes is an array and is passed by value"
  std::string remedy;  // "write use=\"reference\""; may be empty where the rule's own says all
};

using Findings = std::vector<Finding>;

}  // namespace val3
