#pragma once

#include "capstan/cable/motion_pattern.h"

namespace capstan {

/// The word for a kind of motion in tables and messages.
constexpr const char* name_of(MotionKind kind) {
    switch (kind) {
        case MotionKind::rest:
            return "rest";
        case MotionKind::partial:
            return "partial";
        case MotionKind::mass:
            return "mass";
        case MotionKind::opposed:
            return "opposed";
        case MotionKind::slack:
            return "slack";
    }
    return "";
}

}  // namespace capstan
