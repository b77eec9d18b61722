#include "capstan/gap/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "capstan/effects/known_causes.h"

namespace capstan::gap {

namespace {

// Penalties and log priors are natural logarithms.

// A gap is a visible change. A cause that changes no channel by as much as noise and floor (rms) is within
// what the model may be wrong by, and its fit follows that, so that hardly any likelihood may name it: one
// that changes nothing is e^-20 as probable. Where the bench's numbers float they take up a part of that
// error, and a fainter cause shows.
constexpr double visible = 1.0;
constexpr double invisible_penalty = 20.0;
constexpr double invisible_penalty_beside_floating_numbers = 8.0;
// Whoever diagnoses a recording has seen a gap. One in twenty is none, and the others have one of about fifty
// causes: e / (e + 50).
constexpr double none_log_prior_of_a_measured_bench = 1.0;
// The model's own error resembles a faulty sensor, so a sensor fault has to explain more than that.
constexpr double sensor_fault_penalty = 2.0;
// That error is not independent from block to block, and so a fault of one reading that changes it by less
// than noise and floor is none, however well it follows what is left of that channel (E70).
constexpr double faint_fault_penalty = 200.0;
// A further cause is one of about fifty: ln 50. That a recording has one is as probable as that it has none.
constexpr double further_cause_penalty = 3.9;
// On a bench whose zeros and bearings float, these explain what is usual. That there is a cause beside them
// is as probable as that there is none, and it is one of about fifty: ln 50.
constexpr double cause_beside_floating_numbers_penalty = 3.9;
// Values of a channel lie on an unstated lattice by chance with no probability to speak of: e^-10.
constexpr double seen_gain = 10.0;
// Pulleys are turned: the radius of one in a thousand changes by more than their tolerance, as a cam's does.
// No more often is anything tensioned or zeroed between the runs of a session, or a gear behind the torque
// sensor.
constexpr double rare_cause_penalty = 6.9;
// A cause outside the list is rarer than the causes in it.
constexpr double unknown_penalty = 4.0;
// A model's floor is known to about a quarter, and a cause's law to law_error of what the cause does. A
// discrepancy of that size belongs to the model of a named cause.
constexpr double floor_error = 0.25;
// The standard deviation of noise and floor together is known to a tenth: of ln variance twice that.
constexpr double scale_error = 0.2;
// What a number costs that a recording determines to a fiftieth of what was probable: ln 50 (E57).
constexpr double usual_number = 3.9;
// No excess says more against named causes than that another one of some size acts beside them: noise may be
// wrongly stated, and then all named causes leave too much.
constexpr double max_scale_penalty = unknown_penalty + further_cause_penalty + usual_number;
// A further cause that is fainter than what the law of the clearest one may be wrong by only corrects that.
constexpr double faint_penalty = 60.0;
// What follows the model's own error is no cause, however clearly the means of blocks show it (E70). Numbers
// that float take up a part of that error, so that a cause can follow a half of it at most. On spent
// recordings, what followed a fifth of it gained up to 50 units.
constexpr double within_floor_penalty = 40.0;
constexpr double within_floor_penalty_beside_floating_numbers = 80.0;
constexpr double floor_beside_floating_numbers = 0.5;
// That something is there although nothing shows: the list of hypotheses is never complete.
constexpr double mistaken_none_fraction = 0.05;

// A number of the bench that is far from what was stated is named, but after the causes. That nothing else
// acts beside such numbers comes after them, and before every cause that would.
constexpr double bench_fraction = 0.25;
constexpr double none_beside_numbers_fraction = 0.1;
// From this probability on an effect is said to follow a condition of the runs.
constexpr double varies_from = 0.5;
// Numbers that float take up a part of what a cause does. Where nothing shows beside them, a cause that is
// too faint to be told from none is as probable as none. It may be any effect.
constexpr double faint_cause_fraction = 0.5;

// Whether the residuals have to tell that the cause is there: not of what a channel's values show.
bool is_inferred(const CandidateCause& cause) {
    return cause.effect != "none" && !cause.is_seen;
}

// What it costs to name something, in the list or outside it, that changes no channel.
double invisible_at_most(const ScoredFit& fit) {
    return fit.fit.bench->is_measured() ? invisible_penalty : invisible_penalty_beside_floating_numbers;
}

double none_log_prior(const ScoredFit& fit) {
    return fit.fit.bench->is_measured() ? none_log_prior_of_a_measured_bench : 0.0;
}

// The same of what changes a channel by this rms, in units of noise and floor.
double invisible(const ScoredFit& fit, double change) {
    return invisible_at_most(fit) * std::max(0.0, 1.0 - change / visible);
}

// Of a discrepancy, in units of noise and floor. Where the scale of the channels' errors is not known, it was
// sought in proportion to that.
double absolute_size(const ScoredFit& fit, std::size_t k) {
    return discrepancy_sizes[k] * (fit.has_unknown_scales ? std::sqrt(fit.beside[k].misfit) : 1.0);
}

using Effects = std::vector<std::string>;  // of a hypothesis, sorted

Effects effects_of(const CauseFit& fit) {
    Effects effects;
    for (const CandidateCause* cause : fit.causes) effects.push_back(cause->effect);
    std::sort(effects.begin(), effects.end());
    return effects;
}

// What the laws of the causes may be wrong by, rms in units of noise and floor, apart from the law of one of
// them.
double error_of_laws(const ScoredFit& fit, std::size_t apart_from) {
    double most = 0.0;
    for (std::size_t k = 0; k < fit.fit.causes.size(); ++k) {
        const CandidateCause& cause = *fit.fit.causes[k];
        if (k == apart_from || cause.is_exact) continue;
        most = std::max(most, (cause.is_outside_the_list ? law_error_outside_the_list : law_error) *
                                  std::min(fit.visibility[k], fit.max_visibility));
    }
    return most;
}

double error_of_laws(const ScoredFit& fit) {
    return error_of_laws(fit, fit.fit.causes.size());
}

// What floor and laws may be wrong by (rms).
double model_error(const ScoredFit& fit) {
    return std::hypot(floor_error, error_of_laws(fit));
}

// What a channel may leave where the laws are good to law_error of what their causes do.
double tenable_mean_square(const ScoredFit& fit) {
    return 1.0 + std::pow(error_of_laws(fit), 2);
}

// What an unknown cause explains, rms in the same units.
double left_unexplained(const ScoredFit& fit) {
    return std::sqrt(std::max(0.0, fit.misfit - 1.0));
}

// Less than noise and floor is not a sign of anything: the floor is an upper value (E56).
double scale_penalty(const ScoredFit& fit) {
    double penalty = 0.0;
    for (const double mean_square : fit.channel_misfits) {
        const double excess = std::max(0.0, std::log(mean_square / tenable_mean_square(fit)));
        penalty += 0.5 * std::pow(excess / scale_error, 2);
    }
    return std::min(penalty, max_scale_penalty);
}

// The fraction of a gap that a cause outside the list explains beside the named ones. `without_cause`: the
// mean square residual where nothing is named.
double unknown_fraction(const ScoredFit& fit, double without_cause) {
    constexpr double neither_leaves = 0.5;  // where there is no gap to divide
    const double left = std::max(0.0, fit.misfit - 1.0);
    const double closed = std::max(0.0, without_cause - fit.misfit);
    return left + closed > 0.0 ? left / (left + closed) : neither_leaves;
}

// The fits of the same bench with all effects of a fit but that of one cause; without any, where it was the
// only one.
std::vector<const ScoredFit*> fits_without(const ScoredFit& fit, std::size_t cause,
                                           const std::vector<ScoredFit>& fits) {
    Effects others = effects_of(fit.fit);
    others.erase(std::find(others.begin(), others.end(), fit.fit.causes[cause]->effect));
    if (others.empty()) others.push_back("none");
    std::vector<const ScoredFit*> without;
    for (const ScoredFit& other : fits) {
        if (other.fit.bench == fit.fit.bench && effects_of(other.fit) == others) without.push_back(&other);
    }
    return without;
}

// E70. What a fit leaves less than one without a cause, rms in the channel where that is clearest, as a part
// of what the model, whose error may exceed the floor, and the other causes' laws may be wrong by there.
double closed_of_floor(const ScoredFit& without, const ScoredFit& fit, std::size_t cause) {
    constexpr double min_floor = 0.02;
    const double law = error_of_laws(fit, cause);
    double most = 0.0;
    for (std::size_t c = 0; c < fit.channel_misfits.size(); ++c)
        most = std::max(
            most,
            (without.channel_misfits[c] - fit.channel_misfits[c]) /
                (std::max(min_floor, largest_floor * largest_floor * fit.channel_floors[c]) + law * law));
    return std::sqrt(most);
}

// E70 where the scale of the channels' errors is not known.
double penalty_within_unknown_scales(const ScoredFit& fit, const std::vector<ScoredFit>& fits) {
    double penalty = 0.0;
    for (std::size_t k = 0; k < fit.fit.causes.size(); ++k) {
        if (!is_inferred(*fit.fit.causes[k])) continue;
        double min_left = std::numeric_limits<double>::infinity();
        for (const ScoredFit* other : fits_without(fit, k, fits))
            min_left = std::min(min_left, other->misfit);
        const double closed = std::sqrt(std::max(0.0, min_left - fit.misfit));
        penalty += invisible_penalty_beside_floating_numbers * std::max(0.0, 1.0 - closed / floor_error);
    }
    return penalty;
}

// Whether a fit has numbers that are not tenable, and that do not only correct the model or a law (E68).
bool has_far_numbers(const ScoredFit& fit) {
    if (fit.nominal_penalty <= tenable_nominal_penalty) return false;
    const auto is_wrong = [&](const ScoredFit::FarNumber& far) {
        const FloatingNumber& number = fit.fit.bench->numbers[far.number];
        return (far.number < nominal_coordinates || number.usual > 0.0) && !far.is_usual &&
               fit.probability_of(far) >= far_from;
    };
    return error_of_laws(fit) == 0.0 || std::any_of(fit.far_numbers.begin(), fit.far_numbers.end(), is_wrong);
}

// Whether the cause is one of the bench's own numbers, which float beside every other cause as well.
bool is_wrong_number(const CandidateCause& cause) {
    return cause.effect.starts_with("param_") && !cause.is_of_runs;
}

// Several zeros or bearings' friction and nothing else, searched as causes: what is usual of a bench as
// built.
bool are_usual_numbers(const ScoredFit& fit) {
    const std::vector<const CandidateCause*>& causes = fit.fit.causes;
    return causes.size() > 1 && std::all_of(causes.begin(), causes.end(), [](const CandidateCause* cause) {
               return !cause->is_rare &&
                      (cause->effect == "sensor_offset" || cause->effect == "pulley_friction");
           });
}

// The part of the probability of `none` that a cause has which is too faint to show.
double faint_part(const ScoredFit& fit) {
    return fit.fit.bench->is_measured() && !are_usual_numbers(fit) ? 0.0 : faint_cause_fraction;
}

// How visible the effect is in an explanation.
double visibility_in(const WeighedHypothesis& hypothesis, const std::string& effect) {
    double most = 0.0;
    const std::vector<const CandidateCause*>& causes = hypothesis.fit->fit.causes;
    for (std::size_t k = 0; k < causes.size(); ++k) {
        if (causes[k]->effect == effect) most = std::max(most, hypothesis.fit->visibility[k]);
    }
    return most;
}

// Whether a cause of the explanation is clearer than the effect. Any is clearer than a number of the bench.
bool is_beside_a_clearer_one(const WeighedHypothesis& hypothesis, const std::string& effect) {
    const double own = visibility_in(hypothesis, effect);
    const ScoredFit& fit = *hypothesis.fit;
    return std::any_of(fit.visibility.begin(), fit.visibility.end(), [&](double its) { return its > own; });
}

// The probability that an effect of a hypothesis is there, if the hypothesis holds.
double is_there(const WeighedHypothesis& hypothesis, const std::string& effect) {
    if (effect == "none") return (1.0 - faint_part(*hypothesis.fit)) * hypothesis.fit->far_numbers_are_usual;
    const auto far = hypothesis.of_the_bench.find(effect);
    const bool is_cause =
        std::find(hypothesis.effects.begin(), hypothesis.effects.end(), effect) != hypothesis.effects.end();
    const double probability = is_cause || far == hypothesis.of_the_bench.end() ? 1.0 : far->second;
    const bool may_stand_for_another =
        !hypothesis.fit->fit.bench->is_measured() && is_beside_a_clearer_one(hypothesis, effect);
    return may_stand_for_another ? (1.0 - mistaken_beside_a_clearer_one) * probability : probability;
}

// The probability that something else is there, however clear the evidence is.
double mistaken_fraction(const WeighedHypothesis& hypothesis) {
    return hypothesis.effects == Effects{"none"} ? mistaken_none_fraction : mistaken_cause_fraction;
}

// Gives `unknown` this fraction of all shares; all of it where it stands alone.
void give_unknown_its_fraction(std::map<std::string, double>& shares, double fraction) {
    shares.erase("unknown");
    double named = 0.0;
    for (const auto& [effect, share] : shares) named += share;
    for (auto& [effect, share] : shares) share *= (1.0 - fraction) / named;
    shares["unknown"] = shares.empty() ? 1.0 : fraction;
}

// The condition that the effect follows in an explanation; empty: none.
std::string varies_in(const WeighedHypothesis& hypothesis, const std::string& effect) {
    for (const CandidateCause* cause : hypothesis.fit->fit.causes) {
        if (cause->effect == effect && !cause->varies.empty()) return cause->varies;
    }
    return "";
}

// Whether a delay among the numbers of the bench, where a small one needs no cause, is so long that it is
// one, and was fitted as one: that explains the same, with the penalty of a cause.
bool has_a_delay_that_is_a_cause(const ScoredFit& fit, const std::vector<ScoredFit>& fits) {
    const auto is_one = [&](const ScoredFit::FarNumber& far) {
        const FloatingNumber& number = fit.fit.bench->numbers[far.number];
        return number.usual > 0.0 && !far.is_usual &&
               std::any_of(fits.begin(), fits.end(), [&](const ScoredFit& other) {
                   std::vector<const CandidateCause*> others = other.fit.causes;
                   const auto delays = std::erase_if(others, [&](const CandidateCause* cause) {
                       return cause->effect == number.effect && cause->variant == number.variant;
                   });
                   if (delays == 0 || other.fit.bench != fit.fit.bench) return false;
                   return others.empty() ? is_nothing(fit.fit.causes)
                                         : are_same_causes(others, fit.fit.causes);
               });
    };
    return !fit.has_unknown_scales && std::any_of(fit.far_numbers.begin(), fit.far_numbers.end(), is_one);
}

}  // namespace

const ScoredFit* fit_of(const std::vector<ScoredFit>& fits, const std::vector<const CandidateCause*>& causes,
                        const BenchKnowledge* bench) {
    const auto found = std::find_if(fits.begin(), fits.end(), [&](const ScoredFit& each) {
        return (bench == nullptr || each.fit.bench == bench) && are_same_causes(each.fit.causes, causes);
    });
    return found == fits.end() ? nullptr : &*found;
}

const ScoredFit* fit_without_cause(const std::vector<ScoredFit>& fits, const BenchKnowledge* bench) {
    const auto found = std::find_if(fits.begin(), fits.end(), [&](const ScoredFit& each) {
        return (bench == nullptr || each.fit.bench == bench) && is_nothing(each.fit.causes);
    });
    return found == fits.end() ? nullptr : &*found;
}

double log_odds_of_usual_number(const CauseFit& fit, double deviations, double visibility) {
    const double gain = 0.5 * deviations * deviations;
    const double faint =
        invisible_penalty_beside_floating_numbers * std::max(0.0, 1.0 - visibility / visible);
    const bool is_beside_a_cause = std::any_of(fit.causes.begin(), fit.causes.end(),
                                               [](const auto* cause) { return is_inferred(*cause); });
    return gain - faint - (is_beside_a_cause ? further_cause_penalty_as_built : 0.0);
}

// E68.
double ScoredFit::probability_of(const FarNumber& far, double left_unexplained) const {
    const double law = std::max(left_unexplained, model_error(*this));
    if (far.closes >= law || far.probability == 1.0) return far.probability;
    const double odds = far.probability / (1.0 - far.probability) *
                        std::exp(-invisible_at_most(*this) * (1.0 - far.closes / law));
    return odds / (1.0 + odds);
}

bool ScoredFit::may_follow_model_error() const {
    constexpr double noise_and_floor = 1.0;
    return of_blocks.has_value() || (has_unknown_scales && misfit < noise_and_floor);
}

void ScoredFit::charge_further_causes() {
    if (fit.bench->is_measured()) return;
    const auto inferred = std::count_if(fit.causes.begin(), fit.causes.end(),
                                        [](const CandidateCause* cause) { return is_inferred(*cause); });
    if (inferred > 1) charge_unproven(further_cause_penalty_as_built * static_cast<double>(inferred - 1));
}

void ScoredFit::widen_stated_numbers(const Eigen::Vector3d& deviations) {
    if (fit.bench->is_measured() || (error_of_laws(*this) == 0.0 && !of_blocks)) return;
    const Eigen::Vector3d own = fit.nominal_covariance.diagonal().cwiseSqrt();
    const Eigen::Vector3d wider = deviations.cwiseMax(own).cwiseQuotient(own);
    const StatedNumbers stated =
        weigh_stated_numbers(*fit.bench, fit.coordinates.head<nominal_coordinates>(),
                             wider.asDiagonal() * fit.nominal_covariance * wider.asDiagonal());
    for (FarNumber& far : far_numbers) {
        if (far.number < nominal_coordinates)
            far.probability = stated.wrong[static_cast<Eigen::Index>(far.number)];
    }
}

std::map<std::string, double> ScoredFit::of_the_bench(double left_unexplained) const {
    std::map<std::string, double> effects;
    for (const FarNumber& far : far_numbers) {
        double& most = effects[fit.bench->numbers[far.number].effect];
        most = std::max(most, probability_of(far, left_unexplained));
    }
    return effects;
}

// The log-likelihood of Gaussian residuals with a free scale is -n/2 ln(mean square), up to a constant.
double Evidence::log_likelihood(const ScoredFit& fit, double misfit) const {
    const double log = fit.has_unknown_scales ? log_of_unknown_scale(misfit) : log_of(misfit);
    return -0.5 * samples_ * log;
}

double Evidence::penalty_of_corrections(const ScoredFit& fit, const std::vector<ScoredFit>& fits) const {
    if (!fit.may_follow_model_error()) return 0.0;
    if (fit.has_unknown_scales) return penalty_within_unknown_scales(fit, fits);
    const std::vector<const CandidateCause*>& causes = fit.fit.causes;
    const bool is_measured = fit.fit.bench->is_measured();
    const double most = is_measured ? within_floor_penalty : within_floor_penalty_beside_floating_numbers;
    const double enough = is_measured ? 1.0 : floor_beside_floating_numbers;
    double penalty = 0.0;
    for (std::size_t k = 0; k < causes.size(); ++k) {
        if (!is_inferred(*causes[k])) continue;
        // By the fit without the cause that makes most of it.
        double largest = 0.0;
        for (const ScoredFit* other : fits_without(fit, k, fits)) {
            const double own = most * std::max(0.0, 1.0 - closed_of_floor(*other, fit, k) / enough);
            const double gain = fit.uncharged_evidence() + fit.nominal_penalty - other->uncharged_evidence() -
                                other->nominal_penalty;
            // Numbers far from those stated ask for a cause whatever the residuals follow. A wrong number is
            // one of them: it follows no more of the model's error than the same number does without it.
            if (!has_far_numbers(*other))
                largest = std::max(largest, own);
            else if (!is_wrong_number(*causes[k]))
                largest = std::max(largest, std::clamp(gain + further_cause_penalty, 0.0, own));
        }
        penalty += largest;
    }
    return penalty;
}

double Evidence::of(const ScoredFit& fit) const {
    const double law = model_error(fit);
    return priors(fit) - scale_penalty(fit) +
           marginal(fit, [&](double size) { return std::exp(-0.5 * size * size / (law * law)); });
}

double Evidence::with_unknown(const ScoredFit& fit) const {
    const bool named = !is_nothing(fit.fit.causes);
    const double prior =
        priors(fit) - unknown_penalty - (named ? further_cause_penalty : none_log_prior(fit));
    const double function = marginal(fit, [&](double size) { return std::exp(-invisible(fit, size)); });
    if (!fit.of_blocks) return prior + function;
    const double any = of_any_residuals(fit);
    const double most = std::max(function, any);
    // Both kinds are equally probable beforehand.
    return prior + most + std::log(0.5 * (std::exp(function - most) + std::exp(any - most)));
}

// What comes once, wanders or interferes is not a function of the motion. Its size is one more fitted number,
// and it is as visible as any cause.
double Evidence::of_any_residuals(const ScoredFit& fit) const {
    const double most = *std::max_element(fit.channel_misfits.begin(), fit.channel_misfits.end());
    const double size = std::sqrt(std::max(0.0, most - tenable_mean_square(fit)));
    return log_likelihood(fit, fit.beside.front().misfit) + fit.of_blocks->beside_any +
           fit.fit.log_volume_ratio - invisible(fit, size);
}

// The logarithm of the likelihood's mean over the sizes of the discrepancy.
double Evidence::marginal(const ScoredFit& fit, const std::function<double(double)>& weight) const {
    double most = -std::numeric_limits<double>::infinity();
    std::array<double, discrepancy_sizes.size()> each{};
    for (std::size_t k = 0; k < each.size(); ++k) {
        each[k] = log_likelihood(fit, fit.beside[k].misfit) - 0.5 * fit.beside[k].log_determinant +
                  (fit.of_blocks ? fit.of_blocks->beside[k] : 0.0);
        if (weight(absolute_size(fit, k)) > 0.0) most = std::max(most, each[k]);
    }
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t k = 0; k < each.size(); ++k) {
        const double its = weight(absolute_size(fit, k));
        weights += its;
        if (its > 0.0) sum += its * std::exp(each[k] - most);
    }
    return fit.fit.log_volume_ratio + most + std::log(sum / weights);
}

double Evidence::priors(const ScoredFit& fit) const {
    double evidence = -fit.nominal_penalty - fit.shape_penalty + fit.stated_gain - fit.unproven_penalty;
    double inferred = 0.0;  // causes
    double faintest = 1.0;  // of the inferred causes, relative to what the laws beside it may be wrong by
    for (std::size_t k = 0; k < fit.fit.causes.size(); ++k) {
        const CandidateCause& cause = *fit.fit.causes[k];
        if (cause.effect == "none") continue;
        if (cause.is_seen) {
            evidence += seen_gain;
            continue;
        }
        inferred += 1.0;
        evidence -= invisible(fit, fit.visibility[k]);
        if (cause.family == "sensor") evidence -= sensor_fault_penalty;
        if (cause.family == "sensor" && fit.of_blocks)
            evidence -= faint_fault_penalty * std::max(0.0, 1.0 - fit.visibility[k] / visible);
        if (cause.is_rare) evidence -= rare_cause_penalty;
        if (cause.is_outside_the_list) evidence -= unknown_penalty;
        const double law = error_of_laws(fit, k);
        if (law > 0.0) faintest = std::min(faintest, fit.visibility[k] / law);
    }
    if (inferred == 0.0) return evidence + none_log_prior(fit);
    if (!fit.fit.bench->is_measured()) evidence -= cause_beside_floating_numbers_penalty;
    return evidence - further_cause_penalty * (inferred - 1.0) -
           faint_penalty * std::max(0.0, 1.0 - faintest);
}

std::vector<WeighedHypothesis> Evidence::weigh(const std::vector<ScoredFit>& fits) const {
    std::vector<WeighedHypothesis> weighed;
    const auto take = [&](WeighedHypothesis hypothesis) {
        const auto same = std::find_if(weighed.begin(), weighed.end(), [&](const WeighedHypothesis& other) {
            return other.effects == hypothesis.effects;
        });
        if (same == weighed.end()) {
            weighed.push_back(std::move(hypothesis));
        } else if (hypothesis.evidence > same->evidence) {
            *same = std::move(hypothesis);
        }
    };
    for (const ScoredFit& each : fits) {
        if (has_a_delay_that_is_a_cause(each, fits)) continue;
        Effects effects = effects_of(each.fit);
        take({effects, each.of_the_bench(), 0.0, each.evidence, &each, false});
        std::erase(effects, "none");
        effects.push_back("unknown");
        const ScoredFit* nothing = fit_without_cause(fits, each.fit.bench);
        const double without_cause = nothing == nullptr ? each.misfit : nothing->misfit;
        take({effects, each.of_the_bench(left_unexplained(each)), 0.0, with_unknown(each), &each, true,
              unknown_fraction(each, without_cause)});
    }
    std::stable_sort(weighed.begin(), weighed.end(),
                     [](const WeighedHypothesis& a, const WeighedHypothesis& b) {
                         return a.evidence != b.evidence ? a.evidence > b.evidence : a.effects < b.effects;
                     });
    const double most = weighed.front().evidence;
    double sum = 0.0;
    for (const WeighedHypothesis& each : weighed) sum += std::exp((each.evidence - most) / overstated);
    for (WeighedHypothesis& each : weighed)
        each.probability = std::exp((each.evidence - most) / overstated) / sum;
    return weighed;
}

std::vector<RankedEffect> Evidence::rank(const std::vector<CandidateCause>& causes,
                                         const std::vector<WeighedHypothesis>& weighed) {
    std::map<std::string, RankedEffect> ranked_by_name = {{"unknown", {"unknown"}}};
    for (const CandidateCause& cause : causes) ranked_by_name[cause.effect].effect = cause.effect;
    // Effects with almost no probability are ordered by their best hypothesis, and causes that act together
    // by how clear they are in it.
    struct Best {
        double evidence = -std::numeric_limits<double>::infinity();
        double visibility = 0.0;
    };
    std::map<std::string, Best> best;
    std::map<std::string, std::map<std::string, double>> varying;  // effect, condition: probability
    double of_faint_causes = 0.0;
    double mistaken = 0.0;  // shared equally by all effects
    for (const WeighedHypothesis& each : weighed) {
        const double its_mistaken = each.probability * mistaken_fraction(each);
        const double its_probability = each.probability - its_mistaken;
        mistaken += its_mistaken;
        std::map<std::string, double> shares;
        for (const std::string& effect : each.effects) shares[effect] = 1.0;
        double any_far = 0.0;
        for (const auto& [effect, probability] : each.of_the_bench) {
            shares.emplace(effect, bench_fraction * probability);
            any_far = std::max(any_far, probability);
        }
        if (shares.count("none") > 0)
            shares["none"] =
                each.fit->far_numbers_are_usual * (1.0 - (1.0 - none_beside_numbers_fraction) * any_far);
        else if (!each.with_unknown && are_usual_numbers(*each.fit))
            shares["none"] = none_beside_numbers_fraction;
        if (each.with_unknown) give_unknown_its_fraction(shares, each.unknown_fraction);
        double sum = 0.0;
        for (const auto& [effect, share] : shares) sum += share;
        for (const auto& [effect, share] : shares) {
            RankedEffect& ranked = ranked_by_name[effect];
            ranked.effect = effect;
            const double probability = its_probability * share / sum;
            const double faint = effect == "none" ? faint_part(*each.fit) * probability : 0.0;
            of_faint_causes += faint;
            ranked.probability += probability - faint;
            const double present = its_probability * is_there(each, effect);
            ranked.present += present;
            best.emplace(effect, Best{each.evidence, visibility_in(each, effect)});
            if (const std::string condition = varies_in(each, effect); !condition.empty())
                varying[effect][condition] += present;
        }
    }
    for (const auto& [effect, conditions] : varying) {
        for (const auto& [condition, probability] : conditions) {
            if (probability >= varies_from) ranked_by_name[effect].varies = condition;
        }
    }
    std::vector<RankedEffect> ranked;
    const auto effects = static_cast<double>(ranked_by_name.size());
    const double faint = of_faint_causes / (effects - 1.0);
    for (auto& [effect, each] : ranked_by_name) {
        const double anything = mistaken / effects + (effect == "none" ? 0.0 : faint);
        each.probability += anything;
        each.present += anything;
        ranked.push_back(each);
    }
    const auto best_of = [&](const RankedEffect& each) {
        const auto known = best.find(each.effect);
        return known == best.end() ? Best{} : known->second;
    };
    std::stable_sort(ranked.begin(), ranked.end(), [&](const RankedEffect& a, const RankedEffect& b) {
        constexpr double equal = 1e-9;
        if (std::abs(a.probability - b.probability) > equal) return a.probability > b.probability;
        const Best of_a = best_of(a);
        const Best of_b = best_of(b);
        return of_a.evidence != of_b.evidence ? of_a.evidence > of_b.evidence
                                              : of_a.visibility > of_b.visibility;
    });
    return ranked;
}

std::vector<RankedEffect> in_answered_names(const std::vector<RankedEffect>& ranked) {
    std::vector<RankedEffect> answered;
    for (const RankedEffect& each : ranked) {
        if (answered_name(each.effect) == each.effect) answered.push_back(each);
    }
    for (const RankedEffect& each : ranked) {
        const std::string name = answered_name(each.effect);
        if (name == each.effect) continue;
        RankedEffect together{name, each.probability, each.present};
        const auto same = std::find_if(answered.begin(), answered.end(),
                                       [&](const RankedEffect& other) { return other.effect == name; });
        if (same != answered.end()) {
            together.probability += same->probability;
            together.present = std::min(1.0, together.present + same->present);
            answered.erase(same);
        }
        answered.insert(
            std::find_if(answered.begin(), answered.end(),
                         [&](const RankedEffect& other) { return other.probability < together.probability; }),
            together);
    }
    return answered;
}

bool names_only_the_bench(const ScoredFit& fit) {
    return is_nothing(fit.fit.causes) || are_usual_numbers(fit);
}

bool worth_a_further_cause(const ScoredFit& fit) {
    constexpr double close_to_noise = 1.1;
    // Numbers that float widely take up a part of the floor, and leave room for a cause below it.
    constexpr double close_when_numbers_float = 0.25;
    if (fit.has_unknown_scales) return true;
    if (!fit.fit.bench->is_measured()) return fit.misfit > close_when_numbers_float;
    // A fit can pay for a small misfit with numbers far from those stated.
    return fit.nominal_penalty > tenable_nominal_penalty ||
           fit.misfit > std::max(close_to_noise, tenable_mean_square(fit));
}

std::size_t open_numbers(const CauseFit& fit) {
    // Of a measured bench nothing is chosen freely.
    const auto floats_widely = [&](Eigen::Index number) {
        return fit.bench->numbers[static_cast<std::size_t>(number)].prior_std > nominal_log_std;
    };
    std::size_t count = 0;
    for (const CandidateCause* cause : fit.causes) {
        count += cause->numbers.size();
        for (Eigen::Index number = 0; number < nominal_coordinates; ++number)
            count += cause->nominal_std(number) > nominal_log_std && !floats_widely(number) ? 1 : 0;
    }
    for (Eigen::Index number = 0; number < fit.bench->size(); ++number)
        count += floats_widely(number) ? 1 : 0;
    return count;
}

}  // namespace capstan::gap
