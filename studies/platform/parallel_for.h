#pragma once

#include <functional>

namespace capstan {

/// Calls body(i) for i from 0 to count - 1 on up to `jobs` threads (0: as many as processors; a larger
/// number really is that many threads), in any order. The first exception that a call throws comes out
/// here. Give each call a slot of its own to fill and sum the slots in order afterwards: then neither
/// the number of threads nor their timing changes a bit. Within a StopScope it throws WorkStopped once
/// the work is no longer wanted.
void parallel_for_each_index(int count, int jobs, const std::function<void(int)>& body);

}  // namespace capstan
