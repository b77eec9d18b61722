#include "capstan/cli/shard_option.h"

#include <fmt/format.h>

#include <charconv>

#include "capstan/cli/command.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

const Option shard_option{
    .name = "shard",
    .kind = OptionKind::string,
    .value = "I/N",
    .meaning =
        "Run only part I of N into a file of its own; I from 1. `capstan study merge` joins "
        "all N, to the bits of one run. Given again, it goes on where it was."};

Shard parse_shard(const std::string& text) {
    Shard shard;
    const char* const end = text.data() + text.size();
    const auto [slash, problem] = std::from_chars(text.data(), end, shard.number);
    if (problem == std::errc{} && slash != end && *slash == '/') {
        const auto [last, other] = std::from_chars(slash + 1, end, shard.count);
        const bool in_range = shard.number >= 1 && shard.number <= shard.count;
        if (other == std::errc{} && last == end && in_range) return shard;
    }
    throw UsageError(fmt::format(
        "--shard is '{}', but must be I/N with I from 1 to N, as --shard 2/8 for the second of eight", text));
}

void refuse_shard_file(storage::Database& database) {
    const auto mark = storage::read_shard(database);
    if (!mark) return;
    const std::string file = database.path().string();
    throw UsageError(
        fmt::format("{0} is the file of {1}. To go on with it: capstan study run CONFIG --shard "
                    "{2}/{3} --db {0}\nFor a whole study name another file with --db.",
                    file, words_of({mark->shard, mark->shards}), mark->shard, mark->shards));
}

}  // namespace capstan::cli
