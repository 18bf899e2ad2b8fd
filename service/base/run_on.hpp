#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <concepts>
#include <exception>
#include <optional>
#include <type_traits>
#include <utility>

namespace cell {

/// Calls `work` on the executor `there`, behind all that was posted to it before, and goes on with what it
/// returned or threw on the caller's own executor. What `work` refers to must outlive the call; what another
/// thread owns must not be touched by it. With `there` the caller's own executor it is only a detour, so that
/// a test runs everything on one thread.
template <std::invocable Work>
boost::asio::awaitable<std::invoke_result_t<Work>> run_on(boost::asio::any_io_executor there, Work work) {
  using Result = std::invoke_result_t<Work>;
  namespace asio = boost::asio;
  const auto here = co_await asio::this_coro::executor;
  std::exception_ptr failure;
  if constexpr (std::is_void_v<Result>) {
    co_await asio::post(asio::bind_executor(there, asio::use_awaitable));
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    co_await asio::post(asio::bind_executor(here, asio::use_awaitable));
    if (failure) std::rethrow_exception(failure);
  } else {
    std::optional<Result> result;
    co_await asio::post(asio::bind_executor(there, asio::use_awaitable));
    try {
      result.emplace(work());
    } catch (...) {
      failure = std::current_exception();
    }
    co_await asio::post(asio::bind_executor(here, asio::use_awaitable));
    if (failure) std::rethrow_exception(failure);
    co_return *std::move(result);
  }
}

}  // namespace cell
