// Loaded before the program (LD_PRELOAD): stands between SQLite and the file system, and lets one of its
// writes, syncs and truncations fail. What is to fail is its number, from 1 (0: none), and how: "17 short".
// forked_main.h tells how it is asked.
//   full        as ENOSPC
//   error       as EIO
//   short       half is written, then ENOSPC
//   stays_full  every write from then on
#include <sqlite3.h>

#include <cstdlib>
#include <cstring>

#include "forked_main.h"

namespace {

enum class Kind { full, error, short_write, stays_full };

sqlite3_vfs* real_vfs = nullptr;
sqlite3_vfs shim;
sqlite3_io_methods methods;
long operations = 0;
long fails_at = 0;
Kind kind = Kind::full;

// SQLite's file, and behind it the real one.
struct File {
    sqlite3_file base;
    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

File& of(sqlite3_file* file) {
    return *reinterpret_cast<File*>(file);
}

bool fails() {
    ++operations;
    return operations == fails_at;
}

int write(sqlite3_file* file, const void* bytes, int count, sqlite3_int64 offset) {
    sqlite3_file* real = of(file).real();
    const bool now = fails();
    if (kind == Kind::stays_full && fails_at > 0 && operations >= fails_at) return SQLITE_FULL;
    if (!now) return real->pMethods->xWrite(real, bytes, count, offset);
    if (kind == Kind::error) return SQLITE_IOERR_WRITE;
    if (kind == Kind::short_write) real->pMethods->xWrite(real, bytes, count / 2, offset);
    return SQLITE_FULL;
}

int truncate(sqlite3_file* file, sqlite3_int64 size) {
    if (fails() && kind != Kind::stays_full) return SQLITE_IOERR_TRUNCATE;
    sqlite3_file* real = of(file).real();
    return real->pMethods->xTruncate(real, size);
}

int sync(sqlite3_file* file, int flags) {
    if (fails() && kind != Kind::stays_full) return SQLITE_IOERR_FSYNC;
    sqlite3_file* real = of(file).real();
    return real->pMethods->xSync(real, flags);
}

int close(sqlite3_file* file) {
    sqlite3_file* real = of(file).real();
    return real->pMethods != nullptr ? real->pMethods->xClose(real) : SQLITE_OK;
}
int read(sqlite3_file* file, void* bytes, int count, sqlite3_int64 offset) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xRead(real, bytes, count, offset);
}
int file_size(sqlite3_file* file, sqlite3_int64* size) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xFileSize(real, size);
}
int lock(sqlite3_file* file, int level) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xLock(real, level);
}
int unlock(sqlite3_file* file, int level) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xUnlock(real, level);
}
int check_reserved_lock(sqlite3_file* file, int* reserved) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xCheckReservedLock(real, reserved);
}
int file_control(sqlite3_file* file, int operation, void* argument) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xFileControl(real, operation, argument);
}
int sector_size(sqlite3_file* file) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xSectorSize(real);
}
int device_characteristics(sqlite3_file* file) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xDeviceCharacteristics(real);
}
int shm_map(sqlite3_file* file, int page, int size, int extend, void volatile** memory) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xShmMap(real, page, size, extend, memory);
}
int shm_lock(sqlite3_file* file, int offset, int count, int flags) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xShmLock(real, offset, count, flags);
}
void shm_barrier(sqlite3_file* file) {
    sqlite3_file* real = of(file).real();
    real->pMethods->xShmBarrier(real);
}
int shm_unmap(sqlite3_file* file, int remove) {
    sqlite3_file* real = of(file).real();
    return real->pMethods->xShmUnmap(real, remove);
}

int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
    File& opened = of(file);
    std::memset(file, 0, static_cast<std::size_t>(shim.szOsFile));
    const int code = real_vfs->xOpen(real_vfs, name, opened.real(), flags, out_flags);
    if (opened.real()->pMethods != nullptr) opened.base.pMethods = &methods;
    return code;
}

[[gnu::constructor]] void stand_between() {
    methods = {2,
               close,
               read,
               write,
               truncate,
               sync,
               file_size,
               lock,
               unlock,
               check_reserved_lock,
               file_control,
               sector_size,
               device_characteristics,
               shm_map,
               shm_lock,
               shm_barrier,
               shm_unmap,
               nullptr,
               nullptr};
    real_vfs = sqlite3_vfs_find(nullptr);
    shim = *real_vfs;
    shim.zName = "faults";
    shim.pNext = nullptr;
    shim.szOsFile = static_cast<int>(sizeof(File)) + real_vfs->szOsFile;
    shim.xOpen = open;
    sqlite3_vfs_register(&shim, 1);
}

}  // namespace

void faults::begin(const char* line) {
    char* how = nullptr;
    fails_at = std::strtol(line, &how, 10);
    operations = 0;
    if (std::strcmp(how, " error") == 0) kind = Kind::error;
    if (std::strcmp(how, " short") == 0) kind = Kind::short_write;
    if (std::strcmp(how, " stays_full") == 0) kind = Kind::stays_full;
}

void faults::end() {
    say_count(operations);
}
