#include "tests/simulation/clients.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>

#include "tests/simulation/setting.hpp"
#include "tests/simulation/simulated_daemon.hpp"

namespace simulation {
namespace {

/// Of one event of a crowd, times its number.
constexpr int kCrowd = 10;
/// More than the way to a client that does not read can hold.
constexpr int kPipelined = 40;

constexpr std::array kAskedByCrowds{"GET /api/v1/status",
                                    "GET /api/v1/runs",
                                    "GET /api/v1/cell",
                                    "GET /metrics",
                                    "GET /healthz",
                                    "GET /api/v1/runs/1",
                                    "GET /api/v1/runs/1/result",
                                    "GET /api/v1/runs/1/touches",
                                    "GET /api/v1/audit",
                                    "POST /api/v1/cell/reset",
                                    "POST /api/v1/runs",
                                    "GET /nowhere"};

constexpr std::array kCommandedWithKey{"POST /api/v1/runs", "POST /api/v1/runs", "POST /api/v1/runs/1/resume",
                                       "POST /api/v1/cell/acknowledge", "POST /api/v1/cell/reset"};

/// The status of an answer whose header is whole, and how many bytes it has; nothing before that.
struct AnswerHead {
  int status = 0;
  std::size_t size = 0;
};

std::optional<AnswerHead> head_of(const std::string& text) {
  constexpr std::string_view kStatusAt = "HTTP/1.1 ";
  constexpr std::string_view kLengthAt = "Content-Length: ";
  const std::size_t end = text.find("\r\n\r\n");
  if (end == std::string::npos || !text.starts_with(kStatusAt)) return std::nullopt;
  AnswerHead head{.size = end + 4};
  std::from_chars(text.data() + kStatusAt.size(), text.data() + end, head.status);
  const std::size_t length_at = text.find(kLengthAt);
  if (length_at >= end) return head;
  std::size_t length = 0;
  std::from_chars(text.data() + length_at + kLengthAt.size(), text.data() + end, length);
  head.size += length;
  return head;
}

}  // namespace

void Clients::begin(const DrawnFault& fault) {
  switch (fault.kind) {
    case FaultKind::kClientsFlood:
      return flood(fault.number * kCrowd);
    case FaultKind::kClientRepeatsKey:
      return repeat_key(fault.lasts);
    case FaultKind::kClientsStopReading:
      return stop_reading(fault.number);
    default:
      return;
  }
}

void Clients::ask(const Request& request, int times, bool reads) {
  std::string text = fmt::format("{} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n", request.line, kHttpPort);
  if (request.has_token) text += fmt::format("Authorization: Bearer {}\r\n", kOperateToken);
  if (!request.key.empty()) text += fmt::format("Idempotency-Key: {}\r\n", request.key);
  if (!request.body.empty())
    text += fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n", request.body.size());
  text += "\r\n" + request.body;
  Talk talk{.descriptor = network_.open_socket(),
            .request = request,
            .asked_at = clock_.now(),
            .unsent = {},
            .read = {},
            .reads = reads};
  for (int i = 0; i < times; ++i) talk.unsent += text;
  network_.connect(talk.descriptor, kHttpPort);
  talks_.push_back(std::move(talk));
}

void Clients::flood(int count) {
  for (int i = 0; i < count; ++i)
    ask({.line = kAskedByCrowds[static_cast<std::size_t>(chance_.below(kAskedByCrowds.size()))],
         .key = {},
         .body = {},
         .has_token = chance_.once_in(4)});
}

void Clients::repeat_key(Time again) {
  Request request{
      .line = kCommandedWithKey[static_cast<std::size_t>(chance_.below(kCommandedWithKey.size()))],
      .key = fmt::format("key-{}", ++keys_count_),
      .body = {},
      .has_token = true};
  if (request.line.ends_with("/runs")) request.body = fmt::format(R"({{"recipe":"{}"}})", kRecipe);
  ask(request);
  ask(request);
  again_.emplace(clock_.now() + again, request);
}

void Clients::stop_reading(int count) {
  for (int i = 0; i < count; ++i) {
    const bool wants_events = chance_.once_in(2);
    ask({.line = wants_events ? "GET /api/v1/events" : "GET /api/v1/openapi.json", .key = {}, .body = {}},
        wants_events ? 1 : kPipelined, false);
  }
}

std::optional<Time> Clients::next_due() const {
  return again_.empty() ? std::nullopt : std::optional(again_.begin()->first);
}

void Clients::send(Talk& talk) {
  if (talk.unsent.empty()) return;
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(talk.unsent.data());
  const auto sent = network_.send(talk.descriptor, {bytes, talk.unsent.size()});
  if (sent > 0) talk.unsent.erase(0, static_cast<std::size_t>(sent));  // else it is not connected yet
}

bool Clients::read(Talk& talk) {
  const auto count = network_.receive(talk.descriptor, room_.data(), room_.size());
  if (count < 0 && errno == EAGAIN) return false;
  if (count > 0)
    talk.read.append(reinterpret_cast<const char*>(room_.data()), static_cast<std::size_t>(count));
  const auto head = head_of(talk.read);
  if (head && talk.read.size() >= head->size) {
    note(talk, HttpAnswer::End::kAnswered);
  } else if (count <= 0) {
    note(talk, HttpAnswer::End::kClosed);
  } else {
    return false;
  }
  network_.close(talk.descriptor);
  return true;
}

void Clients::note(const Talk& talk, HttpAnswer::End end) {
  const auto head = head_of(talk.read);
  HttpAnswer answer{.asked_at = talk.asked_at,
                    .at = clock_.now(),
                    .request = talk.request.line,
                    .key = talk.request.key,
                    .end = end,
                    .status = head ? head->status : 0,
                    .body = talk.read.substr(std::min(talk.read.size(), talk.read.find("\r\n\r\n")))};
  if (!answer.key.empty())
    journal_.note("client", fmt::format("{} with {}: {}", answer.request, answer.key, answer.status));
  record_.http_answers.push_back(std::move(answer));
}

void Clients::ask_again() {
  while (!again_.empty() && again_.begin()->first <= clock_.now()) {
    ask(again_.begin()->second);
    again_.erase(again_.begin());
  }
}

void Clients::go_on() {
  std::erase_if(talks_, [this](Talk& talk) {
    send(talk);
    return talk.reads && read(talk);
  });
}

void Clients::end() {
  for (const Talk& talk : talks_)
    if (talk.reads) note(talk, HttpAnswer::End::kOpen);
}

}  // namespace simulation
