#pragma once
// Whose file is this? Judged from its first bytes alone: opening a foreign database with SQLite could already
// change it (a journal rolled back, a log checkpointed).

#include <filesystem>

namespace capstan::storage {

enum class FileKind {
    missing,
    empty,  // no byte, a database without a table, or a creation that was killed: free to become ours
    capstan,
    foreign_database,
    not_a_database,
    unreadable,  // a folder, or no permission
};

struct FileIdentity {
    FileKind kind = FileKind::missing;
    int schema_version = 0;  // of a capstan file
};

FileIdentity identify_file(const std::filesystem::path& path);

// Throws an Error unless the file is capstan's, of a schema this program knows, or missing or empty.
void refuse_foreign(const std::filesystem::path& path, const FileIdentity& identity);

// The Error of every way to learn that a file is newer than this program.
[[noreturn]] void refuse_newer(const std::filesystem::path& path, int file_version);

}  // namespace capstan::storage
