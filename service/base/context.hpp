#pragma once

#include <boost/asio/io_context.hpp>

namespace cell {

/// An io_context that can be given up with all that waits in it, while what that refers to still exists: a
/// coroutine that never goes on is destroyed with its context, and what its frame holds may want its owner.
class Context : public boost::asio::io_context {
 public:
  using boost::asio::io_context::io_context;
  /// Nothing runs in it any more, and what is posted to it later waits for its end.
  void give_up() { shutdown(); }
};

}  // namespace cell
