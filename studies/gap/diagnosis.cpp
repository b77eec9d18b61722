#include "capstan/gap/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "capstan/gap/next_experiment.h"
#include "capstan/platform/statistics.h"

namespace capstan::gap {

namespace {

// A cause that closes nothing on held-out data may only have fitted noise. Up to this misfit the recording
// may well have no gap, and `none` is put first; beyond it the cause loses evidence.
constexpr double tenable_misfit = 1.2;
// Half of noise and floor (rms) is within what the model may be wrong by: there is no gap, however well a
// cause fits it. Recordings without noise, as simulations are, show that much. Where zeros and bearings float
// they take up a part of that, and less may be left of a visible gap.
constexpr double misfit_without_gap = 0.25;
constexpr double unproven_penalty = 4.0;
// So much evidence of the means of blocks against `none` stands, although two short runs predict each other
// badly: e^-20.
constexpr double beyond_doubt = 20.0;

class Diagnoser {
  public:
    Diagnoser(const Recording& recording, const DiagnosisOptions& options)
        : recording_(recording), options_(options), search_(recording, options), fitter_(search_.fitter()) {}

    Diagnosis run() {
        FoundCauses found = search_.run();
        nominal_misfit_ = found.nominal_misfit;
        evaluations_ = found.evaluations;
        cut_short_ = found.cut_short;
        return verdict(std::move(found.fits));
    }

  private:
    void report(const std::string& activity, double done) {
        progress_ = std::max(progress_, done);
        options_.on_progress(activity, progress_);
    }

    Diagnosis verdict(std::vector<ScoredFit> fits) {
        Diagnosis diagnosis;
        for (ScoredFit& each : fits) each.charge_further_causes();
        sort_by_evidence(fits);
        const ScoredFit& nothing = nothing_in(fits);
        if (!is_nothing(fits.front().fit.causes) && nothing.fit.bench->is_measured() &&
            nothing.misfit < misfit_without_gap && nothing.nominal_penalty < tenable_nominal_penalty)
            put_nothing_first(fits, unproven_penalty);
        describe(diagnosis, fits);
        replace_what_closes_nothing(diagnosis, fits);
        const std::vector<WeighedHypothesis> weighed = search_.evidence().weigh(fits);
        diagnosis.ranked = Evidence::rank(search_.causes(), weighed);
        report("comparing possible experiments", 0.97);
        diagnosis.non_identifiable = discriminating_experiments(recording_, search_.coarse_fitter(),
                                                                non_identifiable(weighed), options_.threads);
        diagnosis.non_identifiable.is_unknown = is_probably_unknown(weighed);
        diagnosis.independent_samples = fitter_.independent_samples();
        for (const ScoredFit& each : fits) {
            CandidateScore score{
                {},           {}, open_numbers(each.fit), each.misfit, each.nominal_penalty, each.visibility,
                each.evidence};
            score.is_only_the_bench = names_only_the_bench(each);
            for (const CandidateCause* cause : each.fit.causes) {
                score.effects.push_back(cause->effect);
                score.variants.push_back(cause->variant);
            }
            diagnosis.candidates.push_back(score);
        }
        diagnosis.evaluations = evaluations_;
        diagnosis.cut_short = cut_short_;
        return diagnosis;
    }

    void describe(Diagnosis& diagnosis, std::vector<ScoredFit>& fits) {
        describe(diagnosis, fits.front(), runner_up_of(fits.front(), fits));
    }

    static ScoredFit& nothing_in(std::vector<ScoredFit>& fits) {
        return *std::find_if(fits.begin(), fits.end(),
                             [](const ScoredFit& fit) { return is_nothing(fit.fit.causes); });
    }

    // `ahead`: of the evidence of the best cause.
    static void put_nothing_first(std::vector<ScoredFit>& fits, double ahead) {
        nothing_in(fits).evidence = fits.front().evidence + ahead;
        sort_by_evidence(fits);
    }

    // Causes that close nothing on held-out data give way to the next best, which may close nothing, either.
    void replace_what_closes_nothing(Diagnosis& diagnosis, std::vector<ScoredFit>& fits) {
        constexpr std::size_t max_replaced = 4;
        std::vector<std::vector<const CandidateCause*>> unproven;
        while (!diagnosis.causes.empty() && closes_nothing(diagnosis.gap) && unproven.size() < max_replaced &&
               std::none_of(unproven.begin(), unproven.end(),
                            [&](const auto& set) { return are_same_causes(set, fits.front().fit.causes); })) {
            unproven.push_back(fits.front().fit.causes);
            const ScoredFit& nothing = nothing_in(fits);
            const bool may_be_nothing =
                nothing.misfit < tenable_misfit &&
                !(nothing.of_blocks && nothing.evidence < fits.front().evidence - beyond_doubt);
            if (may_be_nothing) {
                put_nothing_first(fits, Evidence::overstated);
            } else {
                charge_unproven(fits, fits.front().fit.causes);
            }
            diagnosis = {};
            describe(diagnosis, fits);
            if (may_be_nothing) return;
        }
    }

    // Several searches may have ended with these causes.
    static void charge_unproven(std::vector<ScoredFit>& fits, std::vector<const CandidateCause*> causes) {
        for (ScoredFit& each : fits) {
            if (are_same_causes(each.fit.causes, causes)) each.charge_unproven(unproven_penalty);
        }
        sort_by_evidence(fits);
    }

    // No channel comes closer to its noise in the parts that were left out of the fit.
    static bool closes_nothing(const GapMeasure& gap) {
        return std::none_of(gap.channels.begin(), gap.channels.end(),
                            [](const ChannelGap& channel) { return channel.closed > 0.0; });
    }

    // The best cause that the verdict does not name.
    static const ScoredFit& runner_up_of(const ScoredFit& leading, const std::vector<ScoredFit>& fits) {
        for (const ScoredFit& each : fits) {
            if (each.fit.causes.size() > 1) continue;
            const auto named = [&](const CandidateCause* cause) {
                return cause->effect == each.fit.causes.front()->effect;
            };
            if (std::none_of(leading.fit.causes.begin(), leading.fit.causes.end(), named)) return each;
        }
        return leading;
    }

    // What the scatter between runs tells of the leading numbers is part of how probable they are.
    void describe(Diagnosis& diagnosis, ScoredFit& leading, const ScoredFit& runner_up) {
        const CauseFit& fit = leading.fit;
        const BenchNumbers numbers = bench_numbers(fit.hypothesis());
        diagnosis.friction_ratio = numbers.friction_ratio;
        diagnosis.stiffness_ratio = numbers.stiffness_ratio;
        diagnosis.pretension_ratio = numbers.pretension_ratio;
        const std::vector<PartFit> parts = held_out(fit);
        std::vector<Eigen::VectorXd> without_a_run;
        std::vector<HeldOut> models;
        for (const PartFit& part : parts) {
            if (part.left_out.is_complete_run()) without_a_run.push_back(part.fit.coordinates);
            models.push_back({part.left_out, bench_numbers(part.fit.hypothesis())});
        }
        const Eigen::VectorXd widths = fitter_.half_widths(fit, without_a_run);
        evaluations_ += static_cast<int>(2 * widths.size());
        leading.widen_stated_numbers(widths.head<nominal_coordinates>() / two_sided_95);
        const auto ratio_interval = [&](Eigen::Index k) -> FittedInterval {
            return {std::exp(fit.coordinates[k] - widths[k]), std::exp(fit.coordinates[k] + widths[k])};
        };
        diagnosis.friction_interval = ratio_interval(0);
        diagnosis.stiffness_interval = ratio_interval(1);
        diagnosis.pretension_interval = ratio_interval(2);
        diagnosis.misfit_before = nominal_misfit_;
        diagnosis.misfit_after = leading.misfit;
        diagnosis.corrected = numbers;
        Eigen::Index next = fit.bench->size();
        for (Eigen::Index k = nominal_coordinates; k < next; ++k) {
            const FloatingNumber& number = fit.bench->numbers[static_cast<std::size_t>(k)];
            diagnosis.bench.push_back({number.name, number.unit, number.value(fit.coordinates[k]),
                                       FittedInterval{number.value(fit.coordinates[k] - widths[k]),
                                                      number.value(fit.coordinates[k] + widths[k])},
                                       number.is_at_bound(fit.coordinates[k])});
        }
        for (Eigen::Index k = 0; k < nominal_coordinates; ++k) {
            const FloatingNumber& number = fit.bench->numbers[static_cast<std::size_t>(k)];
            if (number.is_at_bound(fit.coordinates[k])) diagnosis.at_bounds.push_back(number.name);
        }
        for (const CandidateCause* cause : fit.causes) {
            if (cause->effect == "none") continue;
            FittedCause fitted{cause->effect, cause->variant, cause->component, cause->end, {}, {}};
            for (const OpenNumber& number : cause->numbers) {
                const double one = number.value(fit.coordinates[next] - widths[next]);
                const double other = number.value(fit.coordinates[next] + widths[next]);
                const double value = number.value(fit.coordinates[next]);
                fitted.numbers.push_back({number.name, number.unit, value,
                                          FittedInterval{std::min(one, other), std::max(one, other)},
                                          number.is_at_bound(value)});
                ++next;
                if (number.kind == OpenNumber::Kind::place) fitted.position_m = fitted.numbers.back().value;
            }
            for (const auto& given : cause->given)
                fitted.numbers.push_back({given.name, given.unit, given.value});
            diagnosis.causes.push_back(fitted);
        }
        put_clearest_first(diagnosis.causes, leading.visibility);
        for (const ScoredFit::FarNumber& each : leading.far_numbers) {
            if (leading.probability_of(each) < far_from) continue;
            const FloatingNumber& number = fit.bench->numbers[each.number];
            FittedCause far{number.effect, number.variant, number.component, number.end, {}, {}};
            if (number.kind != FloatingNumber::Kind::ratio) {
                far.numbers = {diagnosis.bench[each.number - nominal_coordinates]};
                far.numbers.front().name = number.kind == FloatingNumber::Kind::zero ? "size" : "coulomb";
            }
            diagnosis.causes.push_back(far);
        }
        if (!diagnosis.causes.empty()) {
            diagnosis.component = diagnosis.causes.front().component;
            diagnosis.end = diagnosis.causes.front().end;
            diagnosis.position_m = diagnosis.causes.front().position_m;
        }
        diagnosis.gap = measure_gap(recording_, fitter_,
                                    {numbers, bench_numbers(runner_up.fit.hypothesis()), std::move(models)});
    }

    // `visibility`: of each cause.
    static void put_clearest_first(std::vector<FittedCause>& causes, const std::vector<double>& visibility) {
        std::vector<std::size_t> order(causes.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return visibility[a] > visibility[b]; });
        std::vector<FittedCause> sorted;
        for (const std::size_t place : order) sorted.push_back(std::move(causes[place]));
        causes = std::move(sorted);
    }

    // A fit without a part of the recording.
    struct PartFit {
        LeftOut left_out;
        CauseFit fit;
    };

    // Without each part in turn.
    std::vector<PartFit> held_out(const CauseFit& leading) {
        report("predicting each run from the others", 0.95);
        const std::vector<LeftOut> left_out = left_out_in_turn(recording_.runs.size(), leading.causes);
        std::vector<CauseFit> fits = fitter_.fits_without(leading, left_out);
        std::vector<PartFit> parts;
        for (std::size_t part = 0; part < fits.size(); ++part) {
            evaluations_ += fits[part].evaluations;
            parts.push_back({left_out[part], std::move(fits[part])});
        }
        return parts;
    }

    const Recording& recording_;
    DiagnosisOptions options_;
    CauseSearch search_;
    const CauseFitter& fitter_;
    double progress_ = 0.0;
    double nominal_misfit_ = 0.0;
    bool cut_short_ = false;
    int evaluations_ = 0;
};

}  // namespace

Diagnosis diagnose(const Recording& recording, const DiagnosisOptions& options) {
    return Diagnoser(recording, options).run();
}

}  // namespace capstan::gap
