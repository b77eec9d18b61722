// A damaged database: the input says where its bytes are changed. Every reader gives an answer or words.
#include <algorithm>
#include <functional>
#include <span>

#include "capstan/answers/placement_answers.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/placement/stored_study.h"
#include "capstan/reports/study_report.h"
#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/error.h"
#include "capstan/storage/health.h"
#include "capstan/storage/report_queries.h"
#include "capstan/storage/study_store.h"
#include "sample_database.h"
#include "target.h"

namespace {

using namespace capstan;
using storage::Database;

constexpr std::size_t page_bytes = 4096;

// The input as damages of seven bytes each: what, where (three bytes), and up to three bytes to put there.
std::string damaged(std::string bytes, std::span<const std::uint8_t> input) {
    for (; input.size() >= 7 && !bytes.empty(); input = input.subspan(7)) {
        const std::size_t anywhere = input[1] << 16 | input[2] << 8 | input[3];
        const std::size_t place = anywhere % bytes.size();
        switch (input[0] % 8) {
            case 0:  // a page becomes a copy of another
            case 1: {
                const std::size_t from = (input[4] << 8 | input[5]) * page_bytes % bytes.size();
                const std::size_t to = place / page_bytes * page_bytes;
                for (std::size_t k = 0; k < page_bytes && std::max(from, to) + k < bytes.size(); ++k)
                    bytes[to + k] = bytes[from + k];
                break;
            }
            case 2:  // the end is cut off
                bytes.resize(input[4] < 8 ? place : bytes.size());
                break;
            default:
                for (std::size_t k = 0; k < input[0] % 3 + 1u && place + k < bytes.size(); ++k)
                    bytes[place + k] = static_cast<char>(input[4 + k]);
        }
    }
    return bytes;
}

void let_refuse(const std::function<void()>& reader) {
    try {
        reader();
    } catch (const storage::Error& refusal) {
        fuzz::demand(std::string_view(refusal.what()).size() > 10, "a refusal has words");
    } catch (const InvalidInput&) {  // of a configuration that is stored
    }
}

void read_study(Database& database, std::int64_t id) {
    let_refuse([&] { reports::study_report_html(database, id); });
    let_refuse([&] { reports::study_live_html(database, id); });
    let_refuse([&] { reports::study_report_json(database, id); });
    let_refuse([&] { reports::study_report_markdown(database, id); });
    let_refuse([&] { reports::study_error_csv(database, id); });
    let_refuse([&] {
        reports::answer_text(answers::conclusions_answer(database, id));
    });
    let_refuse([&] { load_stored_study(database, id); });
    let_refuse([&] { storage::pending_units(database, id); });
    let_refuse([&] { storage::read_single_sensor(database, id, 0, 0); });
    let_refuse([&] { storage::read_fusion(database, id, 0, 0); });
    let_refuse([&] { storage::read_cell_summaries(database, id, 0); });
    let_refuse([&] { storage::read_errors_by_layout(database, id, 0); });
    for (const std::string_view query : {storage::units_query, storage::cable_query})
        let_refuse([&] { storage::run_read_only(database, query, {id}); });
}

void read_all(const std::filesystem::path& path) {
    Database database = Database::open_read_only(path);
    let_refuse([&] { storage::examine(database); });
    let_refuse([&] {
        for (const storage::DiagnosisSummary& each : storage::list_diagnoses(database))
            storage::load_diagnosis(database, each.diagnosis_id);
    });
    let_refuse([&] { storage::read_shard(database); });
    let_refuse([&] { storage::run_read_only(database, storage::studies_query); });
    let_refuse([&] {
        std::size_t studies = 0;
        for (const storage::StudySummary& study : storage::list_studies(database)) {
            if (++studies > 2) break;  // there is one, before a page counts twice
            read_study(database, study.study_id);
        }
    });
}

void write_to(const std::filesystem::path& path) {
    Database database = Database::open_existing(path);
    const std::int64_t id = storage::find_study(database, "latest");
    const storage::StudyDescription description = storage::load_study(database, id);
    let_refuse([&] { storage::begin_study(database, description); });
    storage::delete_study(database, id);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::TemporaryFolder folder;
    static const std::string sample = fuzz::bytes_of(fuzz::make_sample_database(folder));
    const auto path = folder.write("damaged.db", damaged(sample, {data, size}));
    let_refuse([&] { read_all(path); });
    let_refuse([&] { write_to(path); });
    for (const char* suffix : {"-wal", "-shm", "-journal"}) std::filesystem::remove(path.string() + suffix);
    return 0;
}
