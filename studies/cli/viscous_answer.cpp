#include "capstan/cli/viscous_answer.h"

#include <fmt/format.h>

#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

constexpr paper::PaperViscous papers_numbers;

std::string row(const char* model, const paper::ResidualLine& line) {
    return fmt::format("  {:18}  {:>14.1f}  {:>9.3f}  {:>22.4f}\n", model, line.sum_of_squares_Nm2,
                       line.rms_Nm, line.slope_Nm_s_per_rad);
}

nlohmann::ordered_json line_in_json(const paper::ResidualLine& line) {
    return {{"sum_of_squares_Nm2", line.sum_of_squares_Nm2},
            {"rms_Nm", line.rms_Nm},
            {"slope_Nm_s_per_rad", line.slope_Nm_s_per_rad},
            {"offset_Nm", line.offset_Nm}};
}

}  // namespace

std::string viscous_caveat(const paper::ViscousComparison& comparison) {
    return fmt::format(
        "The paper's bench data is not published, so the bench is simulated: the same cables with a drag of {:.3g} "
        "N s/m2, a torque cell's noise of {:.0f} mN m, and three effects that neither model has (a conduit that bends "
        "with the handle, the motor's cogging, the load pulley's friction). Drag and the size of those effects are "
        "set so that the residual and its reduction come near the paper's {:.0f} mN m and about {:.0f}%; found, and "
        "not set, are the fitted drag and the slopes. The fitted drag is above the one put in, because the term also "
        "takes some of the pulley's friction for its own.",
        comparison.bench.drag_N_s_per_m2, 1e3 * comparison.bench.torque_noise_Nm,
        1e3 * papers_numbers.rms_without_term_Nm, 1e2 * papers_numbers.reduction);
}

std::string viscous_in_words(const paper::ViscousComparison& comparison) {
    std::string text = fmt::format(
        "Viscous friction (Fig. 6): {}, {:.1f} N. Residual of the load torque, simulated bench less model.\n\n"
        "  model               squares [N2m2]  rms [N m]  slope [N m s/rad of\n"
        "                                                   handle velocity]\n",
        comparison.setting, comparison.pretension_N);
    text += row("without the term", comparison.without_term) + row("with it, fitted", comparison.with_term);
    text += fmt::format(
        "\n  The term takes {:.0f}% of the sum of squares (paper: about {:.0f}%); rms without it {:.0f} mN m (paper: "
        "{:.0f}).\n  Drag put in {:.2f}, fitted {:.2f} N s/m2. Steps unsolved: {}.\n\n",
        1e2 * comparison.reduction(), 1e2 * papers_numbers.reduction, 1e3 * comparison.without_term.rms_Nm,
        1e3 * papers_numbers.rms_without_term_Nm, comparison.bench.drag_N_s_per_m2,
        comparison.fitted_drag_N_s_per_m2, comparison.unsolved_steps);
    return text + wrapped(viscous_caveat(comparison), 100, "", "") + "\n";
}

nlohmann::ordered_json viscous_in_json(const paper::ViscousComparison& comparison) {
    return {{"setting", comparison.setting},
            {"pretension_N", comparison.pretension_N},
            {"bench", "simulated"},
            {"drag_N_s_per_m2", comparison.bench.drag_N_s_per_m2},
            {"fitted_drag_N_s_per_m2", comparison.fitted_drag_N_s_per_m2},
            {"without_term", line_in_json(comparison.without_term)},
            {"with_term", line_in_json(comparison.with_term)},
            {"reduction", comparison.reduction()},
            {"unsolved_steps", comparison.unsolved_steps},
            {"paper",
             {{"rms_without_term_Nm", papers_numbers.rms_without_term_Nm},
              {"reduction", papers_numbers.reduction}}}};
}

}  // namespace capstan::cli
