#include "capstan/paper/solver_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "capstan/paper/compared_cycle.h"
#include "capstan/paper/compared_solvers.h"
#include "capstan/reference/generic_solver.h"
#include "capstan/solver/replicate_step.h"

namespace capstan::paper {

namespace {

constexpr int rounds = 5;
constexpr double longest_step_s = 1.0;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

// Steps taken, and how long that took.
struct Lap {
    long steps = 0;
    double seconds = 0.0;
    double steps_per_s() const { return static_cast<double>(steps) / seconds; }
};

// Whole laps of `steps` steps each, until the time is over.
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

// The step goes round whole cycles in place.
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

// Replicates go round the same cycle together, each with a stroke of its own. A lap counts each one's steps.
class ReplicatesRunner {
  public:
    ReplicatesRunner(const Cable& cable, ComparedMotion motion)
        : step_(cable, ModelRules::consistent()),
          cycle_(steps_per_cycle, ReplicateEnds(replicates)),
          states_(pretensioned(cable), replicates) {
        for (int replicate = 0; replicate < replicates; ++replicate) {
            const double fraction = (replicate + 0.5) / replicates;
            const auto cycle = cycle_of(cable, motion, 1.0 + stroke_spread * (2.0 * fraction - 1.0));
            for (int n = 0; n < steps_per_cycle; ++n) cycle_[n].set(replicate, cycle[n]);
        }
        run(0.0);
    }

    Lap run(double at_least_s) {
        return laps_of(replicates * steps_per_cycle, at_least_s, [&] {
            for (const ReplicateEnds& ends : cycle_) step_.advance(states_, ends);
        });
    }

  private:
    static constexpr int replicates = 64;
    static constexpr double stroke_spread = 0.1;

    ReplicateStep step_;
    std::vector<ReplicateEnds> cycle_;
    ReplicateStates states_;
};

class PeerRunner {
  public:
    PeerRunner(Advance advance, const std::vector<EndConditions>& cycle,
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
        converged_ += advance_(state_, cycle_[step]).converged;
        ++taken_;
    }

    Advance advance_;
    const std::vector<EndConditions>& cycle_;
    const std::vector<CableState>& before_;
    CableState state_;
    int next_ = 0;
    long taken_ = 0;
    long converged_ = 0;
    bool too_slow_ = false;
};

}  // namespace

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

std::vector<SolverRate> race(const RaceSettings& settings, const std::vector<Solver>& solvers) {
    const Cable cable = preloaded_cable(settings.segments);
    const std::vector<EndConditions> cycle = cycle_of(cable, settings.motion);
    ClosedFormRunner closed_form(cable, cycle);
    const std::vector<CableState> before = closed_form.states_of_a_cycle();

    struct Entrant {
        Solver solver;
        std::optional<PeerRunner> peer{};
        std::optional<ReplicatesRunner> replicates{};
        std::vector<double> steps_per_s{};
        std::vector<double> ratio{};
    };
    std::vector<Entrant> entrants;
    for (const Solver solver : solvers) {
        entrants.push_back({solver});
        if (solver == Solver::replicates) {
            entrants.back().replicates.emplace(cable, settings.motion);
        } else if (solver != Solver::closed_form) {
            entrants.back().peer.emplace(advance_of(solver, cable), cycle, before);
        }
    }

    const double slot_s = settings.seconds_per_solver / rounds;
    for (int round = 0; round < rounds; ++round) {
        const double ours = closed_form.run(slot_s).steps_per_s();
        for (Entrant& entrant : entrants) {
            if (entrant.peer && entrant.peer->too_slow()) continue;
            entrant.steps_per_s.push_back(entrant.peer         ? entrant.peer->run(slot_s).steps_per_s()
                                          : entrant.replicates ? entrant.replicates->run(slot_s).steps_per_s()
                                                               : ours);
            entrant.ratio.push_back(ours / entrant.steps_per_s.back());
        }
    }

    std::vector<SolverRate> rates;
    for (const Entrant& entrant : entrants) {
        SolverRate rate{entrant.solver, {}, {}, 1.0};
        if (!entrant.steps_per_s.empty()) {
            rate.steps_per_s = median(entrant.steps_per_s);
            rate.closed_form_is_faster_by = median(entrant.ratio);
            if (entrant.peer) rate.converged_fraction = entrant.peer->converged_fraction();
        }
        rates.push_back(rate);
    }
    return rates;
}

double slowest_step_s(int segments) {
    const Cable cable = preloaded_cable(segments);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    const std::vector<EndConditions> cycle = cycle_of(cable, ComparedMotion::mass);
    CableState state = pretensioned(cable);
    for (const EndConditions& ends : cycle) step.advance(state, ends);
    std::vector<double> fastest_s(cycle.size(), 1e9);
    for (int repeat = 0; repeat < 3; ++repeat) {
        for (std::size_t n = 0; n < cycle.size(); ++n) {
            const auto start = Clock::now();
            step.advance(state, cycle[n]);
            fastest_s[n] = std::min(fastest_s[n], seconds_since(start));
        }
    }
    return *std::max_element(fastest_s.begin(), fastest_s.end());
}

double bare_write_s(int segments) {
    const Cable cable = preloaded_cable(segments);
    const PrefixTables tables(cable, ModelRules::consistent());
    const SideTable& table = tables.proximal(sign(Direction::forward));
    CableState state = pretensioned(cable);
    double fastest_s = 1e9;
    for (int repeat = 0; repeat < 30; ++repeat) {
        const double scale_N = 1.0 + repeat;
        const auto start = Clock::now();
        for (int node = 0; node < cable.nodes(); ++node) {
            state.tension_N[node] = scale_N * table.tension_ratio[node];
            state.displacement_m[node] = scale_N * table.elongation_m_per_N[node];
        }
        fastest_s = std::min(fastest_s, seconds_since(start));
    }
    return fastest_s;
}

}  // namespace capstan::paper
