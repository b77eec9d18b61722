// Counts on: `planted_undefined plant` from the largest int, `leave` from the one before.
#include <cstdio>
#include <limits>
#include <string_view>

int main(int count, char** words) {
    const bool plant = count > 1 && std::string_view(words[1]) == "plant";
    volatile int number = std::numeric_limits<int>::max() - (plant ? 0 : 1);
    number = number + 1;
    std::printf("%d\n", number);
}
