// MCAP files.
#include "log_trial.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    capstan::fuzz::try_log(data, size, "\x89MCAP0\r\n");
    return 0;
}
