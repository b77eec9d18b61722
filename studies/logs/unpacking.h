#pragma once

#include <string>
#include <string_view>

namespace capstan::logs {

/// A compressed chunk, unpacked as far as it goes.
struct Unpacked {
    std::string bytes;
    bool is_complete = false;  ///< false: damaged or cut, or more than the limit
};

/// At most `limit_bytes` are unpacked. LZ4 and zstd in their frame formats, as bags and MCAP files have them.
Unpacked unpack_bzip2(std::string_view packed, std::size_t limit_bytes);
Unpacked unpack_lz4(std::string_view packed, std::size_t limit_bytes);
Unpacked unpack_zstd(std::string_view packed, std::size_t limit_bytes);

}  // namespace capstan::logs
