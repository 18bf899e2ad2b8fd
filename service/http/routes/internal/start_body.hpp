#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/server/problem.hpp"

namespace cell {

/// The body of POST runs, and of others that name an operator: parsed once, for the start and for the audit.
struct StartBody;
/// `signed_in`: the name of the user who sends it, who is the operator then; empty for a token of a file.
std::shared_ptr<const StartBody> parse_start(const std::string& text, const std::string& signed_in = {});

/// Reads a recipe, or a plan of one; optionally the operator, who makes the touches, whether the compliance
/// is estimated and the block's temperature, measured now unless it says when. The age of that is a
/// precondition.
std::variant<StartRequest, Problem> read_start(const StartBody& body, const CellOperation& operation);

/// Whether a text is one line that reports, lists and the log can show.
bool is_line(const std::string& text, std::size_t bytes_max);
/// Whether a text can name an operator, and what is required of it, for a refusal.
bool is_operator_name(const std::string& text);
std::string operator_name_is();

/// The operator of a body that may name one: who is signed in, else who is named. Nobody else may be named by
/// who is signed in.
std::variant<std::optional<std::string>, Problem> read_operator_of(const std::string& signed_in,
                                                                   const std::optional<std::string>& named);
const std::string& signed_in_of(const StartBody& body);

/// The operator whom the body names; empty where it names nobody or cannot be read.
std::string operator_of(const StartBody& body);

}  // namespace cell
