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
        "Run only part I of N (I from 1) into a file of its own. `capstan study merge` joins all N, "
        "with the same bits as one run. Running the command again continues the part."};

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
        "--shard is '{}', but must be I/N with I from 1 to N, for example --shard 2/8 for the second "
        "of eight",
        text));
}

void refuse_shard_file(storage::Database& database) {
    const auto mark = storage::read_shard(database);
    if (!mark) return;
    const std::string file = database.path().string();
    throw UsageError(
        fmt::format("{0} is the file of {1}. To continue it: capstan study run CONFIG --shard "
                    "{2}/{3} --db {0}\nFor a whole study name another file with --db.",
                    file, words_of({mark->shard, mark->shards}), mark->shard, mark->shards));
}

}  // namespace capstan::cli
