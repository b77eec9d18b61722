#include "capstan/storage/integrity/computed_with.h"

#include "capstan/platform/simd_width.h"
#include "capstan/storage/error.h"
#include "capstan/storage/statement.h"

namespace capstan::storage {

Computation this_computation() {
#ifdef __clang__
    const std::string compiler = "clang++ " __clang_version__;
#else
    const std::string compiler = "g++ " __VERSION__;
#endif
    return {simd_width(), compiler, CAPSTAN_VERSION};
}

void write_computation(Database& database, std::int64_t study_id, const Computation& computation) {
    Statement insert(database,
                     "INSERT OR IGNORE INTO computed_with (study_id, simd, compiler, program_version) VALUES "
                     "(?, ?, ?, ?)");
    insert.bind_all(study_id, std::string_view(computation.simd), std::string_view(computation.compiler),
                    std::string_view(computation.program_version));
    insert.run("write what the study is computed with");
}

std::vector<Computation> read_computations(Database& database, std::int64_t study_id) {
    Statement select(database,
                     "SELECT simd, compiler, program_version FROM computed_with WHERE study_id = ?1 ORDER BY "
                     "simd, compiler, program_version");
    select.bind(1, study_id);
    std::vector<Computation> computations;
    while (select.step())
        computations.push_back(
            {select.get<std::string>(0), select.get<std::string>(1), select.get<std::string>(2)});
    return computations;
}

std::optional<std::string> other_simd(Database& database, std::int64_t study_id) {
    for (const Computation& computation : read_computations(database, study_id))
        if (computation.simd != simd_width()) return computation.simd;
    return std::nullopt;
}

void require_same_simd(Database& database, std::int64_t study_id) {
    if (const auto before = other_simd(database, study_id))
        throw Error(database.path().string() + " was begun with SIMD " + *before + ", and this is " +
                    simd_width() + ", which gives other last bits. Run it with --simd " + *before +
                    ", or on a machine of the kind that began it, or name a new file.");
}

std::string SameComputation::problem_of(Database& database) {
    Statement select(database,
                     "SELECT DISTINCT simd, compiler, program_version FROM computed_with ORDER BY 1, 2, 3");
    std::vector<Computation> found;
    while (select.step())
        found.push_back({select.get<std::string>(0), select.get<std::string>(1), select.get<std::string>(2)});
    if (found.size() > 1)
        return "was computed partly with " + words_of(found[0]) + " and partly with " + words_of(found[1]) +
               ", so that its bits are those of no run; run it again, into a new file";
    if (found.empty()) return {};
    if (!common_) {
        common_ = found.front();
        first_ = database.path().string();
    }
    if (*common_ == found.front()) return {};
    return "was computed with " + words_of(found.front()) + ", but " + first_ + " with " +
           words_of(*common_) +
           ", which gives other last bits; run it again into a new file, with the same program and --simd " +
           common_->simd;
}

void SameComputation::require_same_simd_here() const {
    if (!common_ || common_->simd == simd_width()) return;
    throw Error("The shards were computed with SIMD " + common_->simd + ", and this is " + simd_width() +
                ", which gives other last bits; nothing was written. Merge them with --simd " +
                common_->simd + ", on a machine that has it.");
}

std::string words_of(const Computation& computation) {
    return "SIMD " + computation.simd + ", " + computation.compiler + ", capstan " +
           computation.program_version;
}

}  // namespace capstan::storage
