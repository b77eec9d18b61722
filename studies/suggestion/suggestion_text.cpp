// A suggestion as the file import.toml, with its reasons.
#include <fmt/format.h>

#include <algorithm>

#include "capstan/suggestion/suggestion.h"

namespace capstan::imports {

namespace {

const char* doubt_words(Doubt doubt) {
    switch (doubt) {
        case Doubt::stated:
            return "Note";
        case Doubt::likely:
            return "Likely";
        case Doubt::doubtful:
            break;
    }
    return "DOUBTFUL";
}

}  // namespace

std::string Suggestion::text() const {
    std::vector<std::pair<std::string, std::string>> reasons = {
        {"file",
         "A suggestion by `capstan import --suggest`. Every guess has its reason; correct what is wrong, then run"},
        {"file", "  capstan import LOG... --mapping THIS_FILE -o NAME"}};
    for (const Guess& guess : guesses) {
        std::string reason = guess.reason;
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        reasons.emplace_back(guess.about, fmt::format("{}: {}", doubt_words(guess.doubt), reason));
    }
    return mapping_text(mapping, reasons);
}

}  // namespace capstan::imports
