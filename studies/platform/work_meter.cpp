#include "capstan/platform/work_meter.h"

#include <algorithm>

#include "capstan/platform/clocks.h"

namespace capstan {

thread_local WorkMeter* MeterScope::meter_ = nullptr;

WorkMeter::WorkMeter(std::function<void(double)> show) : show_(std::move(show)) {}

void WorkMeter::expect(double units) {
    expected_ += units;
}

void WorkMeter::note(double units) {
    done_ += units;
    show();
}

void WorkMeter::replan(double fraction) {
    expected_ = done_ / fraction;
    show();
}

void WorkMeter::show() {
    constexpr double interval_s = 0.1;
    const double now_s = wall_time_s();
    if (now_s < next_show_s_ || !mutex_.try_lock()) return;
    const std::lock_guard lock(mutex_, std::adopt_lock);
    next_show_s_ = now_s + interval_s;
    const double expected = expected_;
    if (expected <= 0.0) return;
    // It is done when the command says so, not when a plan has been used up.
    shown_ = std::max(shown_, std::min(done_ / expected, 0.995));
    show_(shown_);
}

}  // namespace capstan
