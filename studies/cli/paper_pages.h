#pragma once

#include <string>
#include <vector>

#include "capstan/paper/error_reduction_tunnel.h"
#include "capstan/paper/solver_comparison.h"
#include "capstan/paper/viscous_tunnel.h"
#include "capstan/reports/experiment_page.h"

namespace capstan::cli {

// The paper's experiments as pages, one file each: page_exp1.cpp, ...

struct RatesOfCable {
    int segments = 0;
    std::vector<paper::SolverRate> rates;  // closed form, linear-assumed, generic
};

reports::ExperimentPage exp1_page(const std::vector<std::vector<paper::RampRun>>& runs);
reports::ExperimentPage exp2_page(const std::vector<std::vector<paper::TunnelRun>>& runs,
                                  const paper::ViscousComparison& viscous);
reports::ExperimentPage solver_page(const std::vector<paper::Agreement>& agreements,
                                    const std::vector<RatesOfCable>& rates);

}  // namespace capstan::cli
