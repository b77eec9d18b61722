#include "capstan/paper/compared_solvers.h"

#include <memory>

#include "capstan/reference/band_lu.h"
#include "capstan/reference/generic_solver.h"
#include "capstan/reference/linear_assumed.h"

namespace capstan::paper {

std::string name_of(Solver solver) {
    switch (solver) {
        case Solver::closed_form:
            return "closed_form";
        case Solver::replicates:
            return "replicates";
        case Solver::band_lu:
            return "band_lu";
        case Solver::linear_assumed:
            return "linear_assumed";
        case Solver::generic:
            return "generic";
    }
    return {};
}

Advance advance_of(Solver solver, const Cable& cable) {
    const auto held = [](auto peer) -> Advance {
        return [peer](CableState& state, const EndConditions& ends) { return peer->advance(state, ends); };
    };
    switch (solver) {
        case Solver::closed_form:
        case Solver::replicates:
            break;  // not peers
        case Solver::band_lu:
            return held(std::make_shared<reference::BandLuSolver>(cable));
        case Solver::linear_assumed:
            return held(std::make_shared<reference::LinearAssumedSolver>(cable));
        case Solver::generic:
            return held(std::make_shared<reference::GenericSolver>(cable));
    }
    return {};
}

}  // namespace capstan::paper
