#pragma once

#include "capstan/recording/recording.h"

namespace capstan {

/// The recording with the noise of every channel stated. Where the sidecar states none, it is estimated from
/// the median second difference of the samples, which slow motion changes little; it is 0 where the stated
/// step of the channel explains that difference.
Recording with_estimated_noise(Recording recording);

}  // namespace capstan
