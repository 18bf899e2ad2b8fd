// The format of the log: https://www.sqlite.org/fileformat2.html#walformat
#include "service/store/log_damage.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

namespace cell {
namespace {

constexpr std::size_t kLogHeaderBytes = 32, kFrameHeaderBytes = 24;
constexpr std::size_t kHeaderSaltsAt = 16, kFrameSaltsAt = 8, kSaltsBytes = 8;
constexpr std::size_t kPageBytes = 4096;         // SQLite's own choice, where the log's header cannot be read
constexpr std::uint32_t kLogMagic = 0x377f0682;  // its last bit is that of a big-endian machine

struct FrameSum {
  std::uint32_t first = 0, second = 0;
  bool operator==(const FrameSum&) const = default;
};

std::uint32_t big_endian_word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word = word << 8U | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

FrameSum sum_at(std::string_view bytes, std::size_t at) {
  return {big_endian_word(bytes, at), big_endian_word(bytes, at + 4)};
}

/// In words of this machine, which has written the log.
FrameSum summed(FrameSum sum, std::string_view bytes) {
  for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
    std::uint32_t words[2];
    std::memcpy(words, bytes.data() + at, sizeof words);
    sum.first += words[0] + sum.second;
    sum.second += words[1] + sum.first;
  }
  return sum;
}

std::string bytes_of(const std::filesystem::path& file, std::size_t at_most = std::string::npos) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes;
  if (at_most == std::string::npos) return {std::istreambuf_iterator<char>(in), {}};
  bytes.resize(at_most);
  in.read(bytes.data(), static_cast<std::streamsize>(at_most));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

struct LogReading {
  std::size_t frames_whole = 0;  // that SQLite reads
  int commits_lost = 0;          // that stand whole behind them
};

/// Each frame's checksum goes on from that of the one before: behind a damaged one they can still be told to
/// be whole.
LogReading read_log(std::string_view log) {
  const bool has_header =
      (big_endian_word(log, 0) | 1U) == (kLogMagic | 1U) && summed({}, log.substr(0, 24)) == sum_at(log, 24);
  const std::size_t frame_bytes = kFrameHeaderBytes + (has_header ? big_endian_word(log, 8) : kPageBytes);
  if (log.size() < kLogHeaderBytes + frame_bytes) return {};
  const std::string_view salts =
      log.substr(has_header ? kHeaderSaltsAt : kLogHeaderBytes + kFrameSaltsAt, kSaltsBytes);
  LogReading reading;
  bool reads = has_header;
  FrameSum before = sum_at(log, 24);
  for (std::size_t at = kLogHeaderBytes; at + frame_bytes <= log.size(); at += frame_bytes) {
    const std::string_view frame = log.substr(at, frame_bytes);
    const FrameSum sum = sum_at(frame, 16);
    const bool is_whole = frame.substr(kFrameSaltsAt, kSaltsBytes) == salts &&
                          summed(summed(before, frame.substr(0, 8)), frame.substr(kFrameHeaderBytes)) == sum;
    const bool is_commit = big_endian_word(frame, 4) != 0;
    reads = reads && is_whole;
    if (reads) ++reading.frames_whole;
    if (!reads && is_whole && is_commit) ++reading.commits_lost;
    before = sum;
  }
  return reading;
}

}  // namespace

std::optional<std::string> find_log_damage(const std::filesystem::path& database_file) {
  constexpr int kReadings = 3;  // a daemon that writes may begin the log anew while it is read
  const std::filesystem::path file = database_file.string() + "-wal";
  for (int i = 0; i < kReadings; ++i) {
    const std::string log = bytes_of(file);
    if (log.size() < kLogHeaderBytes) return std::nullopt;
    const LogReading reading = read_log(log);
    if (reading.commits_lost <= kUnsyncedCommitsMax) return std::nullopt;
    if (bytes_of(file, kLogHeaderBytes) != log.substr(0, kLogHeaderBytes)) continue;
    return fmt::format("{}: frame {} is not what was written, and {} commits behind it are lost",
                       file.string(), reading.frames_whole + 1, reading.commits_lost);
  }
  return std::nullopt;
}

}  // namespace cell
