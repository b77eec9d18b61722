// What the content hashes cost: the processor time that they add to a study, and their part of its file.
//
//     build/tests/benchmarks/hash_cost configs/noise-instants.toml configs/paper.toml
//
// The stored units of the study are written again, alternately with hashes and without.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "capstan/config/config_reader.h"
#include "capstan/placement/study_run.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/study_store.h"

namespace {

using namespace capstan;

double processor_time_s() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

enum class Hashes { written, left_out };

// Of all units of the study and its conclusions, into a new file.
double time_to_write_s(storage::Database& from, const std::filesystem::path& file, Hashes hashes) {
    std::filesystem::remove(file);
    storage::Database to = storage::Database::open_or_create(file);
    const storage::StudyDescription study = storage::load_study(from, 1);
    double spent_s = -processor_time_s();
    storage::begin_study(to, study);
    if (hashes == Hashes::left_out) to.execute("DELETE FROM content_hash", "leave out the hashes");
    for (std::size_t unit = 0; unit < study.work_units.size(); ++unit) {
        const storage::WorkUnitRecord& record = study.work_units[unit];
        const int s = record.scenario_index;
        const int noise = record.noise_index;
        if (record.stage == "single_sensor") {
            spent_s += processor_time_s();
            const auto sensors = storage::read_single_sensor(from, 1, s, noise);
            spent_s -= processor_time_s();
            storage::write_single_sensor(to, 1, static_cast<int>(unit), {s, noise, sensors});
        } else {
            spent_s += processor_time_s();
            const auto fusion = storage::read_fusion(from, 1, s, noise);
            spent_s -= processor_time_s();
            storage::write_fusion(to, 1, static_cast<int>(unit), fusion);
        }
    }
    storage::finish_study(to, 1, storage::read_recommendations(from, 1),
                          storage::read_paper_comparison(from, 1));
    return spent_s + processor_time_s();
}

double bytes_of_tables(storage::Database& database, const std::string& condition) {
    storage::Statement select(database, "SELECT sum(pgsize) FROM dbstat " + condition);
    select.step();
    return select.get<double>(0);
}

void measure(const std::string& name) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("capstan-hash-cost-" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    const StudyPlan plan = config::read_config(name).plan;
    storage::Database database = storage::Database::open_or_create(folder / "study.db");
    RunOptions options;
    options.jobs = 1;
    const double begin_s = processor_time_s();
    run_study(database, plan, "0", options);
    const double study_s = processor_time_s() - begin_s;
    double with_s = std::numeric_limits<double>::infinity();
    double without_s = with_s;
    for (int round = 0; round < 5; ++round) {
        with_s = std::min(with_s, time_to_write_s(database, folder / "again.db", Hashes::written));
        without_s = std::min(without_s, time_to_write_s(database, folder / "again.db", Hashes::left_out));
    }
    const double file = bytes_of_tables(database, "");
    const double hashes = bytes_of_tables(database, "WHERE name IN ('content_hash', 'computed_with')");
    std::printf("%-28s %8.2f s  hashes %7.1f ms = %4.1f%%   file %9.0f kB  hashes %5.0f kB = %4.2f%%\n",
                std::filesystem::path(name).filename().c_str(), study_s, 1e3 * (with_s - without_s),
                100.0 * (with_s - without_s) / study_s, file / 1e3, hashes / 1e3, 100.0 * hashes / file);
    std::filesystem::remove_all(folder);
}

}  // namespace

int main(int count, char** words) {
    std::printf("configuration                 study      time of the hashes         size\n");
    for (int k = 1; k < count; ++k) measure(words[k]);
}
