#include "capstan/import/finding.h"

namespace capstan::imports {

std::string finding_name(FindingKind kind) {
    switch (kind) {
        case FindingKind::repeated_samples:
            return "repeated samples";
        case FindingKind::unordered_times:
            return "unordered times";
        case FindingKind::missing_readings:
            return "missing readings";
        case FindingKind::gap:
            return "gap";
        case FindingKind::short_stretch:
            return "short stretch";
        case FindingKind::jitter:
            return "jitter";
        case FindingKind::clock_offset:
            return "clock offset";
        case FindingKind::wrapped_counter:
            return "wrapped counter";
        case FindingKind::saturated:
            return "saturated";
        case FindingKind::constant_channel:
            return "constant channel";
        case FindingKind::swapped_channels:
            return "swapped channels";
        case FindingKind::wrong_unit:
            return "wrong unit";
        case FindingKind::wrong_sign:
            return "wrong sign";
        case FindingKind::time_unit:
            return "time unit";
        case FindingKind::unread:
            return "unread";
        case FindingKind::assumed:
            return "assumed";
    }
    return "";
}

}  // namespace capstan::imports
