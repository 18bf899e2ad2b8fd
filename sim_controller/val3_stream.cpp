#include "sim_controller/val3_stream.hpp"

#include <array>
#include <utility>

#include "config/endpoint.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

bool would_wait(const boost::system::error_code& error) {
  return error == asio::error::would_block || error == asio::error::try_again;
}

}  // namespace

std::string address_text(const tcp::endpoint& endpoint) {
  return cell::endpoint_text({endpoint.address().to_string(), endpoint.port()});
}

Val3Stream::Val3Stream(tcp::socket connected) : socket_(std::move(connected)) {
  boost::system::error_code ignored;
  socket_.non_blocking(true, ignored);
}

void Val3Stream::set_nagle(bool on) {
  boost::system::error_code ignored;
  socket_.set_option(tcp::no_delay(!on), ignored);
}

std::string Val3Stream::peer() const {
  boost::system::error_code error;
  const tcp::endpoint endpoint = socket_.remote_endpoint(error);
  return error ? "a peer that has gone" : address_text(endpoint);
}

void Val3Stream::add(const std::vector<std::uint8_t>& bytes) {
  unsent_.insert(unsent_.end(), bytes.begin(), bytes.end());
}

std::size_t Val3Stream::write(boost::system::error_code& error) {
  const std::size_t before = sent_;
  error = {};
  while (!error && has_unsent())
    sent_ += socket_.write_some(asio::buffer(unsent_.data() + sent_, unsent_.size() - sent_), error);
  if (would_wait(error)) error = {};
  const std::size_t written = sent_ - before;
  if (!has_unsent()) {
    unsent_.clear();
    sent_ = 0;
  }
  return written;
}

std::size_t Val3Stream::read(std::span<std::uint8_t> into, boost::system::error_code& error) {
  const std::size_t size = socket_.read_some(asio::buffer(into.data(), into.size()), error);
  if (would_wait(error)) error = {};
  return size;
}

void Val3Stream::end_sending() {
  boost::system::error_code ignored;
  socket_.shutdown(tcp::socket::shutdown_send, ignored);
}

void Val3EndingStreams::add(Val3Stream stream, TimePoint until) {
  if (streams_.size() >= kEndingStreamsMax) streams_.pop_front();
  streams_.push_back({std::move(stream), until});
}

void Val3EndingStreams::proceed(TimePoint now) {
  streams_.remove_if([now](Ending& ending) { return now >= ending.until || has_ended(ending); });
}

bool Val3EndingStreams::has_ended(Ending& ending) {
  boost::system::error_code error;
  ending.stream.write(error);
  if (error) return true;
  if (!ending.is_sent && !ending.stream.has_unsent()) {
    ending.is_sent = true;
    ending.stream.end_sending();
  }
  // One buffer each time: a peer that never stops does not hold anybody up.
  std::array<std::uint8_t, 4096> dropped{};
  ending.stream.read(dropped, error);
  return static_cast<bool>(error);
}

}  // namespace sim
