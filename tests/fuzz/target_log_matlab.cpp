// MATLAB files; libmatio reads them in a process of its own.
#include "log_trial.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    capstan::fuzz::try_log(data, size);
    return 0;
}
