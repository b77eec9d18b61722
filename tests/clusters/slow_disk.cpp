// Loaded before the program (LD_PRELOAD): a disk that takes CAPSTAN_SYNC_S seconds for each sync, ten times
// as long on the host CAPSTAN_SLOW_HOST (its name, or SLURMD_NODENAME). So a shard takes time without taking
// a processor.
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

namespace {

void wait_for_disk() {
    const char* const usual = std::getenv("CAPSTAN_SYNC_S");
    if (usual == nullptr) return;
    double seconds = std::atof(usual);
    char name[256] = "";
    ::gethostname(name, sizeof name - 1);
    const char* const node = std::getenv("SLURMD_NODENAME");
    const char* const slow = std::getenv("CAPSTAN_SLOW_HOST");
    if (slow != nullptr && std::string(node != nullptr ? node : name) == slow) seconds *= 10.0;
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

}  // namespace

extern "C" {

int fdatasync(int file) {
    wait_for_disk();
    return static_cast<int>(::syscall(SYS_fdatasync, file));
}

int fsync(int file) {
    wait_for_disk();
    return static_cast<int>(::syscall(SYS_fsync, file));
}

}  // extern "C"
