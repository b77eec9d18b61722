// Runs a target with any compiler on inputs that are kept, and on variants of them: `target_query [--variants
// N] PATH...`, each path a file or a folder of them, N variants of each. The same variants every time. A
// finding ends it as it ends libFuzzer; the input is then in ./finding.
#include <algorithm>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <random>
#include <string_view>
#include <vector>

#include "target.h"
#include "temporary_folder.h"

namespace {

using Random = std::mt19937_64;

struct Input {
    std::string name;
    std::string bytes;
};

std::vector<Input> inputs_at(const std::vector<std::filesystem::path>& paths) {
    std::vector<std::filesystem::path> files;
    for (const auto& path : paths) {
        if (!std::filesystem::is_directory(path)) {
            files.push_back(path);
            continue;
        }
        for (const auto& entry : std::filesystem::directory_iterator(path)) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<Input> inputs;
    for (const auto& file : files) inputs.push_back({file.string(), capstan::fuzz::bytes_of(file)});
    return inputs;
}

std::size_t below(Random& random, std::size_t count) {
    return count == 0 ? 0 : random() % count;
}

// What is hard to take, for a reader of numbers or of texts.
constexpr std::string_view hard_words[] = {
    "0",    "-1",      "1e308", "-1e-308", "nan", "inf", "2147483648", "-9223372036854775808",
    "1e9",  "\"",      "[",     "]]",      "{",   "\n",  ",",          "null",
    "true", "\\u0000", "''",    ";",       "%",   "\xff"};

// A few bytes changed, taken out, put in, or a piece of another input.
void change_once(std::string& bytes, const std::vector<Input>& others, Random& random) {
    const std::size_t place = below(random, bytes.size());
    const std::size_t length = 1 + below(random, 8);
    switch (random() % 6) {
        case 0:
            if (!bytes.empty()) bytes[place] = static_cast<char>(random());
            break;
        case 1:
            bytes.erase(place, length);
            break;
        case 2:
            bytes.insert(place, bytes.substr(below(random, bytes.size()), length * 4));
            break;
        case 3:
            bytes.insert(place, hard_words[below(random, std::size(hard_words))]);
            break;
        case 4: {  // a complete number becomes another
            const auto digit = std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(place), bytes.end(),
                                            [](char c) { return c >= '0' && c <= '9'; });
            const auto start = static_cast<std::size_t>(digit - bytes.begin());
            const std::size_t end = std::min(bytes.find_first_not_of("0123456789.", start), bytes.size());
            if (start < end) bytes.replace(start, end - start, hard_words[below(random, 9)]);
            break;
        }
        default: {
            const std::string& other = others[below(random, others.size())].bytes;
            const std::size_t from = below(random, other.size());
            bytes.insert(place, other.substr(from, below(random, 64)));
        }
    }
}

std::string variant_of(const Input& input, std::size_t number, const std::vector<Input>& others) {
    std::seed_seq address(input.bytes.begin(), input.bytes.end());
    Random random(address);
    random.seed(random() + number);
    std::string bytes = input.bytes;
    for (std::size_t changes = 1 + below(random, 4); changes > 0; --changes)
        change_once(bytes, others, random);
    return bytes;
}

std::string under_trial;
const std::filesystem::path finding =
    std::filesystem::absolute("finding");  // a target may move to another folder

void keep_finding() {
    std::ofstream(finding, std::ios::binary) << under_trial;
}

extern "C" void keep_and_die(int signal) {
    keep_finding();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

void try_bytes(const std::string& bytes) {
    under_trial = bytes;
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

void try_one(const Input& input) {
    std::cout << input.name << std::endl;
    try_bytes(input.bytes);
}

}  // namespace

int main(int count, char** words) {
    std::size_t variants = 0;
    std::vector<std::filesystem::path> paths;
    std::vector<std::filesystem::path> varied_paths;
    for (int k = 1; k < count; ++k) {
        const std::string_view word = words[k];
        if (word == "--variants" && k + 1 < count) {
            const std::string_view number = words[++k];
            std::from_chars(number.data(), number.data() + number.size(), variants);
        } else {
            (variants == 0 ? paths : varied_paths).emplace_back(word);
        }
    }
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) std::signal(signal, keep_and_die);
    const std::vector<Input> inputs = inputs_at(paths);
    const std::vector<Input> varied = inputs_at(varied_paths);
    for (const Input& input : inputs) try_one(input);
    for (const Input& input : varied) {
        try_one(input);
        for (std::size_t number = 0; number < variants; ++number)
            try_bytes(variant_of(input, number, varied));
    }
    const std::size_t tried = inputs.size() + varied.size() * (1 + variants);
    std::cout << tried << " inputs, no finding\n";
    return tried == 0 ? 1 : 0;
}
