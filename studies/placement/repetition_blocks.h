#pragma once

namespace capstan {

/// Repetitions are worked on, and summed, in fixed consecutive blocks, so that neither the number of threads
/// nor their timing can change a bit of a sum.
struct RepetitionBlocks {
    int repetitions = 0;

    /// At most this many: enough for the spread between blocks, few enough to store for every cell.
    static constexpr int max_blocks = 40;

    int block_size() const { return (repetitions + max_blocks - 1) / max_blocks; }
    int count() const { return (repetitions + block_size() - 1) / block_size(); }
    int first(int block) const { return block * block_size(); }
    int end(int block) const {
        const int past = first(block) + block_size();
        return past < repetitions ? past : repetitions;
    }
    int size(int block) const { return end(block) - first(block); }
};

}  // namespace capstan
