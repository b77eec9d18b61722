#include "capstan/paper/solver_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "capstan/reference/band_lu.h"
#include "capstan/reference/generic_solver.h"
#include "capstan/reference/linear_assumed.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan::paper {

namespace {

constexpr double preload_N = 40.0;
constexpr int steps_per_cycle = 1000;
constexpr int rounds = 5;
constexpr double longest_step_s = 1.0;

Cable preloaded_cable(int segments) {
    CableSpecification specification;
    specification.curvature = {{2.0, 0.28}};
    specification.segments = segments;
    specification.axial_stiffness_N = 2000.0;
    specification.dynamic_friction = 0.21;
    specification.static_friction = 0.63;
    specification.pretension_N = preload_N;
    return Cable(specification);
}

EndConditions ends_at(const Cable& cable, ComparedMotion motion, int step) {
    const double angle = 2.0 * std::numbers::pi * step / steps_per_cycle;
    const auto proximal = [&](double amplitude_m) {
        const double rest_m = -preload_N * cable.length_m() / cable.axial_stiffness_N();
        return EndCondition::position_m(rest_m + amplitude_m * std::sin(angle));
    };
    const EndCondition spring = distal_spring({40.0, preload_N, 0.0});
    switch (motion) {
        case ComparedMotion::mass:
            return {proximal(0.08), spring};
        case ComparedMotion::partial:
            return {proximal(0.0015), spring};
        case ComparedMotion::monodirectional:
            return {proximal(0.008), EndCondition::position_m(0.0)};
        case ComparedMotion::bidirectional:
            return {proximal(0.008),
                    EndCondition::position_m(0.006 * (std::sin(1.37 * angle + 0.4) - std::sin(0.4)))};
    }
    return {};
}

std::vector<EndConditions> cycle_of(const Cable& cable, ComparedMotion motion) {
    std::vector<EndConditions> cycle;
    for (int n = 1; n <= steps_per_cycle; ++n) cycle.push_back(ends_at(cable, motion, n));
    return cycle;
}

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

// The step goes round whole cycles in place.
class ClosedFormRunner {
  public:
    ClosedFormRunner(const Cable& cable, const std::vector<EndConditions>& cycle)
        : step_(cable, ModelRules::cured()), cycle_(cycle), state_(pretensioned(cable)) {
        run(0.0);
    }

    Lap run(double at_least_s) {
        Lap lap;
        const auto start = Clock::now();
        do {
            for (const EndConditions& ends : cycle_) step_.advance(state_, ends);
            lap.steps += static_cast<long>(cycle_.size());
            lap.seconds = seconds_since(start);
        } while (lap.seconds < at_least_s);
        return lap;
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

using Advance = std::function<reference::ReferenceReport(CableState&, const EndConditions&)>;

Advance advance_of(Solver solver, const Cable& cable) {
    const auto held = [](auto peer) -> Advance {
        return [peer](CableState& state, const EndConditions& ends) { return peer->advance(state, ends); };
    };
    switch (solver) {
        case Solver::closed_form:
            break;  // not a peer
        case Solver::band_lu:
            return held(std::make_shared<reference::BandLuSolver>(cable));
        case Solver::linear_assumed:
            return held(std::make_shared<reference::LinearAssumedSolver>(cable));
        case Solver::generic:
            return held(std::make_shared<reference::GenericSolver>(cable));
    }
    return {};
}

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
    double converged_share() const { return static_cast<double>(converged_) / static_cast<double>(taken_); }

    Lap run(double at_least_s) {
        Lap lap;
        const auto start = Clock::now();
        do {
            take(next_);
            next_ = (next_ + stride) % steps_per_cycle;
            ++lap.steps;
            lap.seconds = seconds_since(start);
        } while (lap.seconds < at_least_s);
        return lap;
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

std::string name_of(ComparedMotion motion) {
    switch (motion) {
        case ComparedMotion::mass:
            return "mass";
        case ComparedMotion::partial:
            return "partial";
        case ComparedMotion::monodirectional:
            return "monodirectional";
        case ComparedMotion::bidirectional:
            return "bidirectional";
    }
    return {};
}

std::string name_of(Solver solver) {
    switch (solver) {
        case Solver::closed_form:
            return "closed_form";
        case Solver::band_lu:
            return "band_lu";
        case Solver::linear_assumed:
            return "linear_assumed";
        case Solver::generic:
            return "generic";
    }
    return {};
}

std::vector<Agreement> compare_with_generic_solver() {
    std::vector<Agreement> rows;
    for (const ComparedMotion motion : {ComparedMotion::mass, ComparedMotion::partial,
                                        ComparedMotion::monodirectional, ComparedMotion::bidirectional}) {
        for (const int segments : {1, 2, 3, 5, 10, 20, 40, 60}) {
            const Cable cable = preloaded_cable(segments);
            const QuasiStaticStep step(cable, ModelRules::cured());
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
        std::vector<double> steps_per_s{};
        std::vector<double> ratio{};
    };
    std::vector<Entrant> entrants;
    for (const Solver solver : solvers) {
        entrants.push_back({solver});
        if (solver != Solver::closed_form) {
            entrants.back().peer.emplace(advance_of(solver, cable), cycle, before);
        }
    }

    const double slot_s = settings.seconds_per_solver / rounds;
    for (int round = 0; round < rounds; ++round) {
        const double ours = closed_form.run(slot_s).steps_per_s();
        for (Entrant& entrant : entrants) {
            if (entrant.peer && entrant.peer->too_slow()) continue;
            entrant.steps_per_s.push_back(entrant.peer ? entrant.peer->run(slot_s).steps_per_s() : ours);
            entrant.ratio.push_back(ours / entrant.steps_per_s.back());
        }
    }

    std::vector<SolverRate> rates;
    for (const Entrant& entrant : entrants) {
        SolverRate rate{entrant.solver, {}, {}, 1.0};
        if (!entrant.steps_per_s.empty()) {
            rate.steps_per_s = median(entrant.steps_per_s);
            rate.closed_form_is_faster_by = median(entrant.ratio);
            if (entrant.peer) rate.converged_share = entrant.peer->converged_share();
        }
        rates.push_back(rate);
    }
    return rates;
}

double slowest_step_s(int segments) {
    const Cable cable = preloaded_cable(segments);
    const QuasiStaticStep step(cable, ModelRules::cured());
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

}  // namespace capstan::paper
