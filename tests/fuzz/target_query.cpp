// Anyone's SQL: an answer or words, soon, and nothing in the database or beside it is another than before.
#include <set>

#include "capstan/storage/error.h"
#include "capstan/storage/read_only_query.h"
#include "sample_database.h"
#include "target.h"

namespace {

using namespace capstan;

struct Box {
    fuzz::TemporaryFolder folder;
    std::filesystem::path path = fuzz::make_sample_database(folder);
    std::string bytes = fuzz::bytes_of(path);

    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
            names.insert(entry.path().filename().string());
        return names;
    }
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Box box;
    // A relative path in somebody's SQL would lead here.
    static const bool at_home = (std::filesystem::current_path(box.folder.path()), true);
    fuzz::demand(at_home, "a folder to be in");
    {
        storage::Database database = storage::Database::open_read_only(box.path);
        try {
            const storage::QueryResult result = storage::run_read_only(
                database, fuzz::text_of(data, size), {}, {.time_limit_s = 0.5, .row_limit = 1000});
            fuzz::demand(result.rows.size() <= 1000, "rows beyond the limit are cut off");
            for (const auto& row : result.rows)
                fuzz::demand(row.size() == result.columns.size(), "a value for each column");
        } catch (const storage::Error& refusal) {
            fuzz::demand(std::string_view(refusal.what()).size() > 10, "a refusal has words");
        }
    }
    fuzz::demand(fuzz::bytes_of(box.path) == box.bytes, "the database keeps every byte");
    static const std::set<std::string> files = box.files();
    fuzz::demand(box.files() == files, "no file comes or goes");
    return 0;
}
