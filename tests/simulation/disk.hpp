#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/simulation/virtual_clock.hpp"

namespace simulation {

/// What is wrong with the disk, from now on.
enum class DiskTrouble { kNone, kFull, kWriteFails, kSyncFails, kWritesShort, kReadOnly, kSyncLies };

/// Files in memory for SQLite, which know what of them would outlive a power failure. It is SQLite's default
/// file system (VFS) while it exists; one at a time. Several connections may have a file, of one process.
class Disk {
 public:
  Disk(const VirtualClock& clock, std::uint64_t seed);
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// A write, or a new end of the file, that the disk may not have yet.
  struct Write {
    std::size_t offset = 0;
    std::vector<std::uint8_t> before, after;
    std::size_t size_before = 0, size_after = 0;  // of the file
  };
  /// Who of the connections has which lock of a file. `level` of SQLite: SHARED has many, what is above one.
  struct Locks {
    std::map<const void*, int> levels;
    struct Slot {
      std::set<const void*> readers;
      const void* writer = nullptr;
    };
    std::array<Slot, 8> slots;          // of the index of a write-ahead log
    std::set<const void*> with_memory;  // that have the index in memory
  };
  struct File {
    std::vector<std::uint8_t> bytes;                // as everybody reads them
    std::vector<Write> unsynced;                    // oldest first
    std::vector<std::vector<std::uint8_t>> shared;  // the index of a write-ahead log
    Locks locks;
  };
  using Files = std::map<std::string, File>;

  DiskTrouble trouble = DiskTrouble::kNone;
  /// Without it no power failure can be simulated, and writing takes a third of the time.
  bool keeps_unsynced = true;
  /// Called behind each write and each sync, from inside SQLite: it must not use the database.
  std::function<void(bool is_sync)> on_write;

  /// From now on nothing is written any more, and nobody is told: the process is dead.
  void freeze() { is_frozen_ = true; }
  /// The files at the next start: as they were when frozen. With `power_failed` each write that was not
  /// synced is there or is not, as chance has it.
  void start_again(bool power_failed);
  void thaw() { is_frozen_ = false; }

  /// It told that something was not written, and nothing was synced since.
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  [[nodiscard]] Files& files() { return files_; }
  static Disk* current();

  // For the file system.
  int write(File& file, std::size_t offset, const std::uint8_t* bytes, std::size_t size);
  int truncate(File& file, std::size_t size);
  int sync(File& file);
  void remove(const std::string& name);
  [[nodiscard]] const VirtualClock& clock() const { return clock_; }

 private:
  void fail_power(File& file);
  /// What SQLite is told.
  int fail(int error);

  const VirtualClock& clock_;
  std::mt19937_64 chance_;
  Files files_;
  bool is_frozen_ = false;
  bool has_failed_ = false;
};

}  // namespace simulation
