#include "capstan/storage/file_identity.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "capstan/storage/error.h"
#include "capstan/storage/schema.h"

namespace capstan::storage {
namespace {

// Offsets from "The Database Header" of the SQLite file format (sqlite.org/fileformat2.html, sections 1.3
// and 1.6).
constexpr std::string_view magic("SQLite format 3\0", 16);
constexpr std::size_t user_version_offset = 60;
constexpr std::size_t application_id_offset = 68;
constexpr std::size_t first_page_type_offset = 100;
constexpr std::size_t first_page_cells_offset = 103;
constexpr char leaf_page = 13;

using Header = std::array<char, 105>;

std::uint32_t big_endian_32(const Header& header, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(header[offset + i]);
    return value;
}

bool has_no_table(const Header& header, const std::filesystem::path& path) {
    const bool no_row_in_schema = header[first_page_type_offset] == leaf_page &&
                                  header[first_page_cells_offset] == 0 &&
                                  header[first_page_cells_offset + 1] == 0;
    // Tables may still be waiting in a write-ahead log.
    return no_row_in_schema && !std::filesystem::exists(path.string() + "-wal");
}

// A rollback journal that leads back to a file of zero pages: whatever stands in the file was never
// committed. (sqlite.org/fileformat2.html, section 3: magic, record count, nonce, initial size in pages.)
bool its_creation_was_killed(const std::filesystem::path& path) {
    constexpr std::string_view journal_magic("\xd9\xd5\x05\xf9\x20\xa1\x63\xd7", 8);
    constexpr std::size_t initial_pages_offset = 16;
    std::ifstream journal(path.string() + "-journal", std::ios::binary);
    Header header{};
    journal.read(header.data(), header.size());
    return std::string_view(header.data(), journal_magic.size()) == journal_magic &&
           big_endian_32(header, initial_pages_offset) == 0;
}

}  // namespace

FileIdentity identify_file(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return {FileKind::missing};
    // A pipe would be waited for, and a device has no end.
    if (!std::filesystem::is_regular_file(path, ignored)) return {FileKind::unreadable};
    std::ifstream file(path, std::ios::binary);
    if (!file) return {FileKind::unreadable};

    Header header{};
    file.read(header.data(), header.size());
    if (file.gcount() == 0 || its_creation_was_killed(path)) return {FileKind::empty};
    if (std::string_view(header.data(), magic.size()) != magic) return {FileKind::not_a_database};
    const std::uint32_t owner = big_endian_32(header, application_id_offset);
    if (owner == application_id) {
        return {FileKind::capstan, static_cast<int>(big_endian_32(header, user_version_offset))};
    }
    if (owner == 0 && has_no_table(header, path)) return {FileKind::empty};
    return {FileKind::foreign_database};
}

void refuse_foreign(const std::filesystem::path& path, const FileIdentity& identity) {
    switch (identity.kind) {
        case FileKind::missing:
        case FileKind::empty:
            return;
        case FileKind::capstan:
            if (identity.schema_version > schema_version) refuse_newer(path, identity.schema_version);
            return;
        case FileKind::foreign_database:
            throw Error(path.string() +
                        " is an SQLite database, but not one of capstan's; it was left as it is. "
                        "Name another file for the results.");
        case FileKind::not_a_database:
            throw Error(path.string() +
                        " is not a database; it was left as it is. "
                        "Name another file for the results.");
        case FileKind::unreadable:
            throw Error(path.string() +
                        " cannot be read: it is a folder, a pipe or a device, or you have no permission. "
                        "Name a file, or ask its owner for the permission.");
    }
}

void refuse_newer(const std::filesystem::path& path, int file_version) {
    throw Error(path.string() + " has schema version " + std::to_string(file_version) +
                ", newer than version " + std::to_string(schema_version) +
                " that this program knows; it was left as it is. Use the newer capstan that wrote it.");
}

}  // namespace capstan::storage
