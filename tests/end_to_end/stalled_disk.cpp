// Preloaded into a daemon: a disk that stalls. As long as the file $TOUCHCAL_STALL_FILE is there, the next
// fsync or fdatasync removes it and takes a second, or for ever where $TOUCHCAL_STALL_FOR_EVER is set; all
// others take what they take.
#include <dlfcn.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

namespace {

constexpr int kStallMs = 1000;

void stall_if_told() {
  static const char* const file = ::getenv("TOUCHCAL_STALL_FILE");
  if (file == nullptr || ::unlink(file) != 0) return;
  do {
    ::poll(nullptr, 0, kStallMs);
  } while (::getenv("TOUCHCAL_STALL_FOR_EVER") != nullptr);
}

using Sync = int (*)(int);

}  // namespace

extern "C" int fdatasync(int descriptor) {
  static const auto real = reinterpret_cast<Sync>(::dlsym(RTLD_NEXT, "fdatasync"));
  stall_if_told();
  return real(descriptor);
}

extern "C" int fsync(int descriptor) {
  static const auto real = reinterpret_cast<Sync>(::dlsym(RTLD_NEXT, "fsync"));
  stall_if_told();
  return real(descriptor);
}
