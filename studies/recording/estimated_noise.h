#pragma once

#include "capstan/recording/recording.h"

namespace capstan {

/// The recording with the noise of every channel stated: where the sidecar does not, from the median second
/// difference of its samples, which a slow motion hardly touches; none beside a stated step that explains it.
Recording with_estimated_noise(Recording recording);

}  // namespace capstan
