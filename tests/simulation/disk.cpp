#include "tests/simulation/disk.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string_view>

namespace simulation {
namespace {

Disk* the_disk = nullptr;

/// What SQLite has of an open file.
struct OpenFile {
  sqlite3_file base;
  Disk::File* file;
};

Disk::File& file_of(sqlite3_file* open) { return *reinterpret_cast<OpenFile*>(open)->file; }

int close_file(sqlite3_file* open) {
  file_of(open).locks.levels.erase(open);
  return SQLITE_OK;
}

int read_file(sqlite3_file* open, void* into, int count, sqlite3_int64 offset) {
  const Disk::File& file = file_of(open);
  const auto from = static_cast<std::size_t>(offset);
  const auto wanted = static_cast<std::size_t>(count);
  const std::size_t there = from >= file.bytes.size() ? 0 : std::min(wanted, file.bytes.size() - from);
  if (there > 0) std::memcpy(into, file.bytes.data() + from, there);
  if (there == wanted) return SQLITE_OK;
  std::memset(static_cast<std::uint8_t*>(into) + there, 0, wanted - there);
  return SQLITE_IOERR_SHORT_READ;
}

int write_file(sqlite3_file* open, const void* bytes, int count, sqlite3_int64 offset) {
  return the_disk->write(file_of(open), static_cast<std::size_t>(offset),
                         static_cast<const std::uint8_t*>(bytes), static_cast<std::size_t>(count));
}

int truncate_file(sqlite3_file* open, sqlite3_int64 size) {
  return the_disk->truncate(file_of(open), static_cast<std::size_t>(size));
}

int sync_file(sqlite3_file* open, int) { return the_disk->sync(file_of(open)); }

int size_of_file(sqlite3_file* open, sqlite3_int64* size) {
  *size = static_cast<sqlite3_int64>(file_of(open).bytes.size());
  return SQLITE_OK;
}

int lock_file(sqlite3_file* open, int level) {
  auto& levels = file_of(open).locks.levels;
  for (const auto& [other, has] : levels) {
    if (other == open) continue;
    const bool is_free = level == SQLITE_LOCK_SHARED     ? has < SQLITE_LOCK_PENDING
                         : level == SQLITE_LOCK_RESERVED ? has < SQLITE_LOCK_RESERVED
                                                         : has == SQLITE_LOCK_NONE;
    if (!is_free) return SQLITE_BUSY;
  }
  levels[open] = std::max(levels[open], level);
  return SQLITE_OK;
}

int unlock_file(sqlite3_file* open, int level) {
  int& has = file_of(open).locks.levels[open];
  has = std::min(has, level);
  return SQLITE_OK;
}

int is_reserved(sqlite3_file* open, int* answer) {
  const auto& levels = file_of(open).locks.levels;
  *answer = std::ranges::any_of(levels, [](const auto& one) { return one.second >= SQLITE_LOCK_RESERVED; });
  return SQLITE_OK;
}

int control_file(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }
int sector_size(sqlite3_file*) { return 4096; }
int characteristics(sqlite3_file*) { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; }

int map_shared(sqlite3_file* open, int region, int size, int extend, void volatile** memory) {
  auto& shared = file_of(open).shared;
  *memory = nullptr;
  const auto index = static_cast<std::size_t>(region);
  if (index >= shared.size()) {
    if (extend == 0) return SQLITE_OK;
    shared.resize(index + 1);
  }
  if (shared[index].empty()) shared[index].resize(static_cast<std::size_t>(size));
  *memory = shared[index].data();
  file_of(open).locks.with_memory.insert(open);
  return SQLITE_OK;
}

bool may_have(const Disk::Locks::Slot& slot, const sqlite3_file* open, bool to_write) {
  if (slot.writer != nullptr && slot.writer != open) return false;
  const auto is_other = [open](const void* reader) { return reader != open; };
  return !to_write || std::ranges::none_of(slot.readers, is_other);
}

int lock_shared(sqlite3_file* open, int first, int count, int flags) {
  auto& locks = file_of(open).locks;
  const auto slots =
      std::span(locks.slots).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
  const bool to_write = (flags & SQLITE_SHM_EXCLUSIVE) != 0;
  if ((flags & SQLITE_SHM_UNLOCK) != 0) {
    for (Disk::Locks::Slot& slot : slots) {
      if (slot.writer == open) slot.writer = nullptr;
      slot.readers.erase(open);
    }
    return SQLITE_OK;
  }
  for (const Disk::Locks::Slot& slot : slots)
    if (!may_have(slot, open, to_write)) return SQLITE_BUSY;
  for (Disk::Locks::Slot& slot : slots) {
    if (to_write) slot.writer = open;
    if (!to_write) slot.readers.insert(open);
  }
  return SQLITE_OK;
}
void order_shared(sqlite3_file*) {}

int unmap_shared(sqlite3_file* open, int) {
  Disk::File& file = file_of(open);
  file.locks.with_memory.erase(open);
  if (file.locks.with_memory.empty()) file.shared.clear();
  return SQLITE_OK;
}

const sqlite3_io_methods kMethods{
    2,           close_file,   read_file,    write_file,   truncate_file, sync_file,       size_of_file,
    lock_file,   unlock_file,  is_reserved,  control_file, sector_size,   characteristics, map_shared,
    lock_shared, order_shared, unmap_shared, nullptr,      nullptr};

int open_file(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* flags_out) {
  static int unnamed_count = 0;
  const std::string known = name != nullptr ? name : "unnamed " + std::to_string(++unnamed_count);
  auto* const open = reinterpret_cast<OpenFile*>(file);
  open->base.pMethods = &kMethods;
  open->file = &the_disk->files()[known];
  if (flags_out != nullptr) *flags_out = flags;
  return SQLITE_OK;
}

int remove_file(sqlite3_vfs*, const char* name, int) {
  the_disk->remove(name);
  return SQLITE_OK;
}

int has_file(sqlite3_vfs*, const char* name, int, int* answer) {
  const auto found = the_disk->files().find(name);
  *answer = found != the_disk->files().end() && !found->second.bytes.empty() ? 1 : 0;
  return SQLITE_OK;
}

int full_name(sqlite3_vfs*, const char* name, int size, char* full) {
  sqlite3_snprintf(size, full, "%s", name);
  return SQLITE_OK;
}

/// SQLite draws salts and names from it.
int draw_bytes(sqlite3_vfs*, int count, char* bytes) {
  for (int i = 0; i < count; ++i) bytes[i] = static_cast<char>(i * 37 + 11);
  return count;
}

int pass_time(sqlite3_vfs*, int microseconds) { return microseconds; }

int current_time_ms(sqlite3_vfs*, sqlite3_int64* julian_ms) {
  constexpr sqlite3_int64 kBegin = 212'463'734'400'000;  // in 2020, Julian days in milliseconds
  *julian_ms =
      kBegin + std::chrono::duration_cast<std::chrono::milliseconds>(the_disk->clock().now()).count();
  return SQLITE_OK;
}

int current_time(sqlite3_vfs* vfs, double* julian_days) {
  sqlite3_int64 milliseconds = 0;
  current_time_ms(vfs, &milliseconds);
  *julian_days = static_cast<double>(milliseconds) / 86'400'000.0;
  return SQLITE_OK;
}

int last_error(sqlite3_vfs*, int, char*) { return 0; }

sqlite3_vfs& file_system() {
  static sqlite3_vfs vfs = [] {
    sqlite3_vfs made{};
    made.iVersion = 2;
    made.szOsFile = sizeof(OpenFile);
    made.mxPathname = 512;
    made.zName = "simulation";
    made.xOpen = open_file;
    made.xDelete = remove_file;
    made.xAccess = has_file;
    made.xFullPathname = full_name;
    made.xRandomness = draw_bytes;
    made.xSleep = pass_time;
    made.xCurrentTime = current_time;
    made.xGetLastError = last_error;
    made.xCurrentTimeInt64 = current_time_ms;
    return made;
  }();
  return vfs;
}

}  // namespace

Disk::Disk(const VirtualClock& clock, std::uint64_t seed) : clock_(clock), chance_(seed) {
  if (the_disk != nullptr) throw std::logic_error("two simulated disks at a time");
  the_disk = this;
  sqlite3_vfs_register(&file_system(), 1);
  sqlite3_randomness(0, nullptr);  // drawn anew, the same in every world
}

Disk::~Disk() {
  sqlite3_vfs_unregister(&file_system());
  the_disk = nullptr;
}

Disk* Disk::current() { return the_disk; }

int Disk::fail(int error) {
  has_failed_ = true;
  return error;
}

int Disk::write(File& file, std::size_t offset, const std::uint8_t* bytes, std::size_t size) {
  if (is_frozen_) return SQLITE_OK;
  if (trouble == DiskTrouble::kFull) return fail(SQLITE_FULL);
  if (trouble == DiskTrouble::kWriteFails || trouble == DiskTrouble::kReadOnly)
    return fail(SQLITE_IOERR_WRITE);
  const bool is_short = trouble == DiskTrouble::kWritesShort;
  const std::size_t count = is_short ? size / 2 : size;
  Write write{.offset = offset, .size_before = file.bytes.size()};
  const std::size_t end = offset + count;
  const std::size_t kept_end = std::min(end, file.bytes.size());
  if (keeps_unsynced && offset < kept_end)
    write.before.assign(file.bytes.begin() + static_cast<std::ptrdiff_t>(offset),
                        file.bytes.begin() + static_cast<std::ptrdiff_t>(kept_end));
  if (keeps_unsynced) write.after.assign(bytes, bytes + count);
  if (end > file.bytes.size()) file.bytes.resize(end);
  write.size_after = file.bytes.size();
  std::copy_n(bytes, count, file.bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  if (keeps_unsynced) file.unsynced.push_back(std::move(write));
  if (on_write) on_write(false);
  return is_short ? fail(SQLITE_IOERR_WRITE) : SQLITE_OK;
}

int Disk::truncate(File& file, std::size_t size) {
  if (is_frozen_ || size >= file.bytes.size()) return SQLITE_OK;
  Write write{.offset = size, .size_before = file.bytes.size(), .size_after = size};
  write.before.assign(file.bytes.begin() + static_cast<std::ptrdiff_t>(size), file.bytes.end());
  file.bytes.resize(size);
  if (keeps_unsynced) file.unsynced.push_back(std::move(write));
  if (on_write) on_write(false);
  return SQLITE_OK;
}

int Disk::sync(File& file) {
  if (is_frozen_ || trouble == DiskTrouble::kSyncLies) return SQLITE_OK;
  if (trouble == DiskTrouble::kSyncFails || trouble == DiskTrouble::kWriteFails)
    return fail(SQLITE_IOERR_FSYNC);
  file.unsynced.clear();
  has_failed_ = false;
  if (on_write) on_write(true);
  return SQLITE_OK;
}

void Disk::remove(const std::string& name) {
  if (!is_frozen_) files_.erase(name);
}

/// All that was not synced is undone, then each of it is done or not.
void Disk::fail_power(File& file) {
  for (auto write = file.unsynced.rbegin(); write != file.unsynced.rend(); ++write) {
    file.bytes.resize(write->size_before);
    std::ranges::copy(write->before, file.bytes.begin() + static_cast<std::ptrdiff_t>(write->offset));
  }
  for (const Write& write : file.unsynced) {
    if (chance_() % 2 == 0) continue;
    const std::size_t end = write.offset + write.after.size();
    if (write.after.empty()) {
      file.bytes.resize(std::min(file.bytes.size(), write.size_after));
      continue;
    }
    if (file.bytes.size() < end) file.bytes.resize(end);
    std::ranges::copy(write.after, file.bytes.begin() + static_cast<std::ptrdiff_t>(write.offset));
  }
  file.unsynced.clear();
}

void Disk::start_again(bool power_failed) {
  for (auto& [name, file] : files_) {
    file.shared.clear();
    file.locks = {};
    if (power_failed) fail_power(file);
  }
  is_frozen_ = has_failed_ = false;
  trouble = DiskTrouble::kNone;
}

}  // namespace simulation
