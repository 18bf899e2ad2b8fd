#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "service/base/exit_code.hpp"
#include "service/cli/api_client.hpp"
#include "service/documents/document_error.hpp"

namespace cell {

/// Throws DaemonUnreachable: the peer is not touchcald.
[[noreturn]] void refuse_peer(const ApiReply& reply);

/// The document in a reply, by the function that reads its text. Throws DaemonUnreachable if the peer is not
/// touchcald, DocumentError if the document is another one.
template <class Document>
Document read_reply(const ApiReply& reply, Document (*read)(std::string_view)) {
  try {
    return read(reply.body);
  } catch (const NotJson&) {
    refuse_peer(reply);
  }
}

/// What the problem document of a reply says, in one line.
std::string problem_line(const ApiReply& reply);
/// Prints the problem document of a reply; returns its exit code.
ExitCode print_problem(const ApiReply& reply, bool json);

}  // namespace cell
