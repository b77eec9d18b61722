#pragma once

namespace capstan::cli {

/// What `read` gives, and where it finds a mistake, what it finds the second time. The streams in the
/// libraries that read options, files and TOML take a lack of memory for a wrong letter; what is wrong is
/// wrong again.
template <class Mistake, class Read>
auto read_again_if_wrong(const Read& read) {
    try {
        return read();
    } catch (const Mistake&) {
        return read();
    }
}

}  // namespace capstan::cli
