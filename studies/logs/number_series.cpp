#include "capstan/logs/number_series.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace capstan::logs {

namespace {

constexpr std::size_t block_bytes = NumberStore::block_numbers * sizeof(double);

[[noreturn]] void fail(const char* what) {
    throw std::runtime_error(fmt::format(
        "{}: {} a temporary file: {}. A large log is kept there while it is read; set TMPDIR to a "
        "folder on a disk with more room",
        std::filesystem::temp_directory_path().string(), what, std::strerror(errno)));
}

// A file that has no name from its first moment on.
int nameless_file() {
    const std::string folder = std::filesystem::temp_directory_path().string();
    int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0) return descriptor;
    std::string name = folder + "/capstan-XXXXXX";  // for file systems without O_TMPFILE
    descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0) fail("cannot make");
    ::unlink(name.c_str());
    return descriptor;
}

}  // namespace

NumberStore::NumberStore(std::size_t memory_limit_bytes) : memory_left_bytes_(memory_limit_bytes) {}

NumberStore::~NumberStore() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

NumberStore::Block NumberStore::kept(std::unique_ptr<double[]> numbers) {
    if (memory_left_bytes_ >= block_bytes) {
        memory_left_bytes_ -= block_bytes;
        return {std::move(numbers), 0};
    }
    if (descriptor_ < 0) descriptor_ = nameless_file();
    Block block{nullptr, file_bytes_};
    const char* bytes = reinterpret_cast<const char*>(numbers.get());
    for (std::size_t written = 0; written < block_bytes;) {
        const ssize_t count = ::pwrite(descriptor_, bytes + written, block_bytes - written, file_bytes_);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail("cannot write");
        written += static_cast<std::size_t>(count);
        file_bytes_ += count;
    }
    return block;
}

const double* NumberStore::find(const Block& block, double* buffer) const {
    if (block.numbers) return block.numbers.get();
    char* bytes = reinterpret_cast<char*>(buffer);
    for (std::size_t got = 0; got < block_bytes;) {
        const ssize_t count = ::pread(descriptor_, bytes + got, block_bytes - got,
                                      block.offset_bytes + static_cast<std::int64_t>(got));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail("cannot read");
        got += static_cast<std::size_t>(count);
    }
    return buffer;
}

NumberSeries::NumberSeries(std::shared_ptr<NumberStore> store) : store_(std::move(store)) {}

void NumberSeries::append(double number) {
    open_.push_back(number);
    if (open_.size() < NumberStore::block_numbers) return;
    auto numbers = std::make_unique_for_overwrite<double[]>(NumberStore::block_numbers);
    std::copy(open_.begin(), open_.end(), numbers.get());
    blocks_.push_back(store_->kept(std::move(numbers)));
    open_.clear();
}

NumberReader::NumberReader(const NumberSeries& series, std::size_t first)
    : series_(&series),
      next_(first / NumberStore::block_numbers),
      skipped_(first % NumberStore::block_numbers) {}

std::span<const double> NumberReader::next_block() {
    std::span<const double> block = stored_block(next_++);
    block = block.subspan(std::min(skipped_, block.size()));
    skipped_ = 0;
    return block;
}

std::span<const double> NumberReader::stored_block(std::size_t block) {
    if (block < series_->blocks_.size()) {
        buffer_.resize(NumberStore::block_numbers);
        return {series_->store_->find(series_->blocks_[block], buffer_.data()), NumberStore::block_numbers};
    }
    if (block == series_->blocks_.size()) return series_->open_;
    return {};
}

std::vector<double> numbers_of(const NumberSeries& series, std::size_t limit) {
    std::vector<double> numbers;
    numbers.reserve(std::min(limit, series.size()));
    NumberReader reader(series);
    for (double number = 0.0; numbers.size() < limit && reader.next(number);) numbers.push_back(number);
    return numbers;
}

}  // namespace capstan::logs
