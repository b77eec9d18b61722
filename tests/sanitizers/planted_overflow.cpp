// Reads a list: `planted_overflow plant` one number beyond its end, `leave` its last one.
#include <cstdio>
#include <memory>
#include <string_view>

int main(int count, char** words) {
    constexpr int size = 8;
    const auto numbers = std::make_unique<int[]>(size);
    volatile int last = count > 1 && std::string_view(words[1]) == "plant" ? size : size - 1;
    std::printf("%d\n", numbers[static_cast<std::size_t>(last)]);
}
