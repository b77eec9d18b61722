#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace capstan::logs {

/// Numbers that are appended once and read in order, in blocks. All series of a log share a store, which
/// keeps the first `memory_limit_bytes` in memory and the rest in a file without a name in the temporary
/// folder, so that a log of any size needs bounded memory. The file is gone when the store is, however the
/// program ends.
class NumberStore {
  public:
    static constexpr std::size_t block_numbers = 4096;

    explicit NumberStore(std::size_t memory_limit_bytes = 64u << 20);
    ~NumberStore();
    NumberStore(const NumberStore&) = delete;
    NumberStore& operator=(const NumberStore&) = delete;

  private:
    friend class NumberSeries;
    friend class NumberReader;

    struct Block {
        std::unique_ptr<double[]> numbers;  ///< empty: in the file
        std::int64_t offset_bytes = 0;
    };
    /// Throws std::runtime_error if the temporary folder cannot be written.
    Block kept(std::unique_ptr<double[]> numbers);
    const double* find(const Block& block, double* buffer) const;

    std::size_t memory_left_bytes_;
    int descriptor_ = -1;
    std::int64_t file_bytes_ = 0;
};

class NumberSeries {
  public:
    explicit NumberSeries(std::shared_ptr<NumberStore> store);

    void append(double number);
    std::size_t size() const { return blocks_.size() * NumberStore::block_numbers + open_.size(); }

  private:
    friend class NumberReader;

    std::shared_ptr<NumberStore> store_;
    std::vector<NumberStore::Block> blocks_;  ///< each complete
    std::vector<double> open_;                ///< the last, incomplete one
};

/// Reads a series in order. The series must not grow meanwhile.
class NumberReader {
  public:
    /// From the number with index `first` on.
    explicit NumberReader(const NumberSeries& series, std::size_t first = 0);

    /// The numbers of the next block; empty after the last. Valid until the next call.
    std::span<const double> next_block();
    /// The next number; false after the last.
    bool next(double& number) {
        if (at_ == block_.size()) {
            block_ = next_block();
            at_ = 0;
            if (block_.empty()) return false;
        }
        number = block_[at_++];
        return true;
    }

  private:
    std::span<const double> stored_block(std::size_t block);

    const NumberSeries* series_;
    std::size_t next_ = 0;
    std::size_t skipped_;  ///< of the first block
    std::span<const double> block_;
    std::size_t at_ = 0;
    std::vector<double> buffer_;
};

/// All numbers of a series, at most `limit` of them.
std::vector<double> numbers_of(const NumberSeries& series, std::size_t limit = SIZE_MAX);

}  // namespace capstan::logs
