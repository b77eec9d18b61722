// Excel workbooks.
#include "log_trial.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    capstan::fuzz::try_log(data, size, "PK\x03\x04");
    return 0;
}
