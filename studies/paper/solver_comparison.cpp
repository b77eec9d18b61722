#include "capstan/paper/solver_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "capstan/paper/compared_cycle.h"
#include "capstan/placement/cell_statistics.h"
#include "capstan/platform/statistics.h"
#include "capstan/reference/generic_solver.h"
#include "capstan/reference/linear_assumed.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan::paper {

namespace {

constexpr int rounds = 5;
constexpr double longest_step_s = 1.0;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Steps taken, and how long that took.
struct Lap {
    long steps = 0;
    double seconds = 0.0;
    double steps_per_s() const { return static_cast<double>(steps) / seconds; }
};

// Complete laps of `steps` steps each, until the time is over.
template <class TakeSteps>
Lap laps_of(long steps, double at_least_s, TakeSteps&& take_steps) {
    Lap lap;
    const auto start = Clock::now();
    do {
        take_steps();
        lap.steps += steps;
        lap.seconds = seconds_since(start);
    } while (lap.seconds < at_least_s);
    return lap;
}

// The step goes round complete cycles in place.
class ClosedFormRunner {
  public:
    ClosedFormRunner(const Cable& cable, const std::vector<EndConditions>& cycle)
        : step_(cable, ModelRules::consistent()), cycle_(cycle), state_(pretensioned(cable)) {
        run(0.0);
    }

    Lap run(double at_least_s) {
        return laps_of(steps_per_cycle, at_least_s, [&] {
            for (const EndConditions& ends : cycle_) step_.advance(state_, ends);
        });
    }

    // The state before every step of the next cycle.
    std::vector<CableState> states_of_a_cycle() {
        std::vector<CableState> states;
        for (const EndConditions& ends : cycle_) {
            states.push_back(state_);
            step_.advance(state_, ends);
        }
        return states;
    }

  private:
    QuasiStaticStep step_;
    const std::vector<EndConditions>& cycle_;
    CableState state_;
};

class PeerRunner {
  public:
    PeerRunner(Peer::Advance advance, const std::vector<EndConditions>& cycle,
               const std::vector<CableState>& before)
        : advance_(std::move(advance)), cycle_(cycle), before_(before), state_(before.front()) {
        // In mass motion, and behind a turn, where a front is on its way.
        for (const int step : {0, 300}) {
            const auto start = Clock::now();
            take(step);
            too_slow_ = too_slow_ || seconds_since(start) > longest_step_s;
            if (too_slow_) break;
        }
        taken_ = converged_ = 0;
    }

    bool too_slow() const { return too_slow_; }
    double converged_fraction() const {
        return static_cast<double>(converged_) / static_cast<double>(taken_);
    }

    Lap run(double at_least_s) {
        return laps_of(1, at_least_s, [&] {
            take(next_);
            next_ = (next_ + stride) % steps_per_cycle;
        });
    }

  private:
    static constexpr int stride =
        619;  // prime to the cycle, near its golden section: any few steps lie evenly

    void take(int step) {
        state_ = before_[step];
        converged_ += advance_(state_, cycle_[step]) ? 1 : 0;
        ++taken_;
    }

    Peer::Advance advance_;
    const std::vector<EndConditions>& cycle_;
    const std::vector<CableState>& before_;
    CableState state_;
    int next_ = 0;
    long taken_ = 0;
    long converged_ = 0;
    bool too_slow_ = false;
};

template <class Solver>
Peer::Advance advance_with(const Cable& cable) {
    return [solver = std::make_shared<Solver>(cable)](CableState& state, const EndConditions& ends) {
        return solver->advance(state, ends).converged;
    };
}

}  // namespace

Peer linear_assumed_peer() {
    return {"linear_assumed", "dense linear-assumed (paper's)", advance_with<reference::LinearAssumedSolver>};
}

Peer generic_peer() {
    return {"generic", "generic root finder (MINPACK)", advance_with<reference::GenericSolver>};
}

std::vector<Agreement> compare_with_generic_solver() {
    std::vector<Agreement> rows;
    for (const ComparedMotion motion : {ComparedMotion::mass, ComparedMotion::partial,
                                        ComparedMotion::monodirectional, ComparedMotion::bidirectional}) {
        for (const int segments : {1, 2, 3, 5, 10, 20, 40, 60}) {
            const Cable cable = preloaded_cable(segments);
            const QuasiStaticStep step(cable, ModelRules::consistent());
            const reference::GenericSolver generic(cable);
            Agreement row{motion, segments, 0, 0, 0.0};
            CableState state = pretensioned(cable);
            for (const EndConditions& ends : cycle_of(cable, motion)) {
                CableState other = state;
                step.advance(state, ends);
                ++row.steps;
                if (!generic.advance(other, ends).converged) continue;
                ++row.converged;
                for (int node = 0; node < cable.nodes(); ++node) {
                    const double difference_N = std::abs(other.tension_N[node] - state.tension_N[node]);
                    row.largest_difference_N = std::max(row.largest_difference_N, difference_N);
                }
            }
            rows.push_back(row);
        }
    }
    return rows;
}

std::vector<SolverRate> race(const RaceSettings& settings, const std::vector<Peer>& peers) {
    const Cable cable = preloaded_cable(settings.segments);
    const std::vector<EndConditions> cycle = cycle_of(cable, settings.motion);
    ClosedFormRunner closed_form(cable, cycle);
    const std::vector<CableState> before = closed_form.states_of_a_cycle();

    struct Entrant {
        PeerRunner runner;
        std::vector<double> steps_per_s;
        std::vector<double> ratio;
    };
    std::vector<Entrant> entrants;
    for (const Peer& peer : peers) entrants.push_back({{peer.solver_for(cable), cycle, before}, {}, {}});

    const double slot_s = settings.seconds_per_solver / rounds;
    std::vector<double> closed_form_steps_per_s;
    for (int round = 0; round < rounds; ++round) {
        const double ours = closed_form.run(slot_s).steps_per_s();
        closed_form_steps_per_s.push_back(ours);
        for (Entrant& entrant : entrants) {
            if (entrant.runner.too_slow()) continue;
            entrant.steps_per_s.push_back(entrant.runner.run(slot_s).steps_per_s());
            entrant.ratio.push_back(ours / entrant.steps_per_s.back());
        }
    }

    std::vector<SolverRate> rates = {{.name = "closed_form",
                                      .title = "closed form (capstan)",
                                      .steps_per_s = upper_median(closed_form_steps_per_s),
                                      .closed_form_is_faster_by = 1.0}};
    for (std::size_t k = 0; k < peers.size(); ++k) {
        const Entrant& entrant = entrants[k];
        SolverRate rate{.name = peers[k].name, .title = peers[k].title};
        if (!entrant.steps_per_s.empty()) {
            rate.steps_per_s = upper_median(entrant.steps_per_s);
            rate.closed_form_is_faster_by = upper_median(entrant.ratio);
            rate.converged_fraction = entrant.runner.converged_fraction();
        }
        rates.push_back(rate);
    }
    return rates;
}

}  // namespace capstan::paper
