#pragma once

#include <boost/asio/any_io_executor.hpp>

#include "config/cell.hpp"
#include "service/acquisition/controller.hpp"

namespace cell {

/// The controller at an address or a name, which is looked up at each connection, over the protocol's client.
/// One thread: that of the executor.
class Cs8Controller : public Controller {
 public:
  Cs8Controller(boost::asio::any_io_executor executor, const Deadlines& deadlines, Endpoint endpoint);

  void listen(cs8::ClientHooks hooks) override { hooks_ = std::move(hooks); }
  boost::asio::awaitable<cs8::ConnectReply> connect(cs8::ExpectedController expected) override;
  void close() override { client_.close(); }
  [[nodiscard]] bool connected() const override { return client_.connected(); }
  boost::asio::awaitable<cs8::PermitReply> begin(std::uint32_t run,
                                                 std::chrono::milliseconds confirm_within) override {
    return client_.begin(run, confirm_within);
  }
  void finish() override { client_.finish(); }
  [[nodiscard]] std::optional<cs8::Permit> latest_permit() const override { return client_.latest_permit(); }
  [[nodiscard]] std::optional<cs8::State> latest_state() const override { return client_.latest_state(); }
  [[nodiscard]] std::uint32_t next_sequence() const override { return client_.next_sequence(); }
  boost::asio::awaitable<cs8::TouchReply> touch(cs8::Touch command) override {
    return client_.touch(command);
  }
  boost::asio::awaitable<cs8::MoveReply> travel(cs8::Travel command) override {
    return client_.travel(command);
  }
  boost::asio::awaitable<cs8::MoveReply> retract(cs8::Retract command) override {
    return client_.retract(command);
  }
  boost::asio::awaitable<cs8::QueryReply> query(std::uint32_t sequence,
                                                std::chrono::milliseconds deadline) override {
    return client_.query(sequence, deadline);
  }
  void stop() override { client_.stop(); }
  void acknowledge(std::uint32_t sequence) override { client_.acknowledge(sequence); }

 private:
  boost::asio::any_io_executor executor_;
  Endpoint endpoint_;
  std::chrono::milliseconds look_up_max_;
  cs8::ClientHooks hooks_;
  cs8::Client client_;
};

}  // namespace cell
