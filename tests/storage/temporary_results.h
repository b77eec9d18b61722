#pragma once
// Places to write to, and questions to ask a file.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "capstan/storage/database.h"
#include "capstan/storage/error.h"
#include "capstan/storage/read_only_query.h"

namespace capstan::storage {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "capstan-storage-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// The message of the Error that the call ends in; '' when there is none.
inline std::string error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

inline void expect_says(const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos)
        << "says: '" << message << "'\nshould say: '" << part << "'";
}

// For facts that a query states in one number.
inline std::int64_t number_from(Database& database, const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(database.connection(), sql.c_str(), -1, &statement, nullptr);
    const bool found = statement != nullptr && sqlite3_step(statement) == SQLITE_ROW;
    const std::int64_t number = found ? sqlite3_column_int64(statement, 0) : -1;
    sqlite3_finalize(statement);
    EXPECT_TRUE(found) << sql;
    return number;
}

}  // namespace capstan::storage
