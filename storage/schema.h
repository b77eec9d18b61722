#pragma once
// What marks a file as capstan's, and the text that makes one.

#include <cstdint>
#include <string>

namespace capstan::storage {

constexpr std::uint32_t application_id = 0x43505354;  // "CPST", in the file's header
constexpr int schema_version = 7;                     // SQLite's user_version; raised with every migration

const std::string& schema_text();  // schema.sql, as it was when the program was built

}  // namespace capstan::storage
