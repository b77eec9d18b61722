#pragma once

#include <hwy/targets.h>

namespace capstan {

/// Makes HWY_DYNAMIC_DISPATCH(f) the function for this processor, so that its address may be kept: Highway's
/// own look-up at every call would be a tenth of a step of a short cable.
template <class Function>
Function* for_this_processor(Function* (*dispatched)()) {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return dispatched();
}

}  // namespace capstan
