#pragma once

#include <string_view>
#include <utility>

#include "service/base/exit_code.hpp"
#include "service/cli/api_client.hpp"
#include "service/documents/document_error.hpp"

namespace cell {

/// What answers is no touchcald.
[[noreturn]] void tell_stranger(const ApiReply& reply);

/// The document that the daemon answered, by the function that reads its text. Throws DaemonUnreachable when
/// what answers is no touchcald, DocumentError when the document is another one.
template <class Document>
Document read_reply(const ApiReply& reply, Document (*read)(std::string_view)) {
  try {
    return read(reply.body);
  } catch (const NotJson&) {
    tell_stranger(reply);
  }
}

/// Prints the problem document of a reply; returns its exit code.
ExitCode print_problem(const ApiReply& reply, bool json);

}  // namespace cell
