#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace capstan {

/// The bytes of a file. Throws std::runtime_error that says why it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// Writes a file completely or not at all, as AtomicFile does.
void write_file(const std::filesystem::path& path, std::string_view text);

/// Throws what write_file() would where no file of this name can be written: its folder does not exist or may
/// not be written, or it is a folder. Before long work whose result goes there.
void require_writable(const std::filesystem::path& path);

/// A file that is written piece by piece and appears under its name, complete and on the disk, with finish().
/// Until then the name keeps what it had. An existing file keeps its mode, a symbolic link keeps its target,
/// and a pipe or a device is written directly. Nothing is left behind by a failure or by a kill; the one
/// exception is a kill between the last two steps of a replacement, and the next replacement in the folder
/// removes what that left. Every member throws std::runtime_error with the reason and what to try.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void append(std::string_view text);
    void finish();

  private:
    void write_pending();
    void publish();

    std::filesystem::path named_;  ///< as the caller wrote it
    std::filesystem::path path_;   ///< the file behind it, where `named_` is a link
    std::string temporary_;        ///< beside it; empty while the new file has no name
    std::string pending_;          ///< not written yet
    int descriptor_ = -1;
    bool is_special_ = false;  ///< a pipe or a device
};

/// Gives a finished file its final name, and makes sure that the file and its new name are on the disk.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace capstan
