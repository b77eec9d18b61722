#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/gap/cause_fit.h"
#include "capstan/gap/discrepancy.h"

namespace capstan::gap {

/// An effect, `none` or `unknown`, and how probable it is.
struct RankedEffect {
    std::string effect;
    double probability = 0.0;  ///< its share of the hypotheses that hold it; sums to 1 over all effects
    double present = 0.0;      ///< that it is there at all, whatever else is
    std::string varies{};      ///< the condition of the runs that its numbers probably follow; empty: none
};

/// The same in the names that an answer gives: an effect that has no canonical name is part of `unknown`.
std::vector<RankedEffect> in_answered_names(const std::vector<RankedEffect>& ranked);

/// The weight of what is left below noise and floor (E64). The floor is an upper value of the model's error,
/// and a fit may follow that error.
inline constexpr double below_noise_weight = 0.3;
/// Where the bench's numbers float they take up a part of the model's error, so that the floor is no longer
/// what a fit leaves.
inline constexpr double below_noise_weight_beside_floating_numbers = 1.0;

/// A law of the catalogue is an idealisation, good to this part of what its cause does.
inline constexpr double law_error = 0.1;
/// One that stands for an effect outside the list has another law than that effect, and is good to this part.
inline constexpr double law_error_outside_the_list = 0.5;

/// The probability that what is named is not there, however clear the evidence is. Of what was stated with
/// 0.8 and more on spent trials, 2 of 85 effects of measured benches were not there, and of benches as built
/// 9 of the 238 that were the clearest of their verdicts.
inline constexpr double mistaken_cause_fraction = 0.05;
/// An effect beside a clearer one on a bench as built is mistaken more often, by this: it may stand for what
/// that one's law and the bench's numbers are wrong by. 18 of 149 were not there.
inline constexpr double mistaken_beside_a_clearer_one = 0.05;

/// What each cause beside another loses in the verdict on a bench as built, in units of log-evidence: its law
/// also follows the model's own error, which is not noise. On 80 spent rigs, 3 of the 8 further causes that
/// gained less than nine units were there. A search with this penalty would stop before causes that close
/// most of a gap together.
inline constexpr double further_cause_penalty_as_built = 8.0;

/// From this probability on, a stated number is far from what was stated.
inline constexpr double far_from = 0.5;

/// How well a set of causes explains a recording.
struct ScoredFit {
    CauseFit fit;
    double misfit = 0.0;  ///< mean square residual, in units of noise and floor
    double nominal_penalty = 0.0;
    double shape_penalty = 0.0;
    double stated_gain = 0.0;        ///< because stated numbers may be as stated (E63)
    double unproven_penalty = 0.0;   ///< for causes that close nothing in held-out data
    std::vector<double> visibility;  ///< of each cause: its rms change of the clearest channel, in units of
                                     ///< noise and floor
    /// Beside numbers that float widely a cause is no more visible than what is left without any, by rms.
    double max_visibility = std::numeric_limits<double>::infinity();
    Marginals beside{};  ///< what the fit leaves beside a discrepancy of each size
    /// What the means of blocks say; then `beside` is of the deviations from them. None: `beside` is of all.
    std::optional<BlockLikelihoods> of_blocks{};
    bool has_unknown_scales = false;  ///< of the channels' errors (E54)
    /// Mean square residual of each predicted channel, in units of noise and floor. Empty where the scale of
    /// a channel's error is not known.
    std::vector<double> channel_misfits{};
    std::vector<double> channel_floors{};  ///< the same of the model's floor alone
    /// Of the bench's floating numbers those that visibly change what is measured,
    std::vector<std::size_t> visible_numbers{};
    /// and of these those that may be further from what was stated than is usual, and how probably.
    struct FarNumber {
        std::size_t number = 0;
        double probability = 0.0;
        /// What a fit with the number as stated would leave more, rms in units of noise and floor.
        double closes = std::numeric_limits<double>::infinity();
        bool is_usual = false;  ///< no further than that, but clear all the same, as a delay can be
    };
    std::vector<FarNumber> far_numbers{};
    /// The probability that none of them is a cause. A zero, a bearing's friction and numbers from tables are
    /// usual on a bench as built; one wrong number among right ones and a sensor that is late are causes.
    double far_numbers_are_usual = 1.0;

    /// That the number is far from what was stated, and does not only correct the model's error, the law of a
    /// cause (E68) or what is left for an unknown one to explain (rms in units of noise and floor).
    double probability_of(const FarNumber& far, double left_unexplained = 0.0) const;
    /// The effects that they stand for, each by its most probable number.
    std::map<std::string, double> of_the_bench(double left_unexplained = 0.0) const;
    double evidence = 0.0;  ///< logarithm, up to a constant

    /// Whether its causes may follow the model's own error (E70): the means of blocks are weighed, or no more
    /// than noise and floor is left where the scale of the channels' errors is not known.
    bool may_follow_model_error() const;
    /// Weighs the stated numbers again (E63) where these standard deviations of their logarithms are wider
    /// than those of the fit. Beside a law that is an idealisation, and where the means of blocks are weighed
    /// (E69), a fit is too sure of them.
    void widen_stated_numbers(const Eigen::Vector3d& deviations);
    /// Lowers the evidence of its causes, also beside an unknown one.
    void charge_unproven(double penalty) {
        unproven_penalty += penalty;
        evidence -= penalty;
    }
    /// Takes further_cause_penalty_as_built for each cause beside another; nothing on a measured bench.
    void charge_further_causes();
    double uncharged_evidence() const { return evidence + unproven_penalty; }
};

/// Logarithm of the odds that a number of a bench as built explains a part of the gap although its value is
/// usual: what it gains, so many standard deviations from nothing, less what a cause that changes a channel
/// by `visibility`, in units of noise and floor, costs beside the causes of the fit.
double log_odds_of_usual_number(const CauseFit& fit, double deviations, double visibility);

/// The first of these fits with these causes, on this bench if one is given; null where there is none.
const ScoredFit* fit_of(const std::vector<ScoredFit>& fits, const std::vector<const CandidateCause*>& causes,
                        const BenchKnowledge* bench = nullptr);
/// The same of no cause at all.
const ScoredFit* fit_without_cause(const std::vector<ScoredFit>& fits, const BenchKnowledge* bench = nullptr);

/// An explanation and how probable it is; its best fit where several variants were tried.
struct WeighedHypothesis {
    std::vector<std::string> effects;            ///< sorted; `unknown` stands for a cause outside the list
    std::map<std::string, double> of_the_bench;  ///< effects of far numbers, if the hypothesis holds
    double probability = 0.0;
    double evidence = 0.0;
    const ScoredFit* fit = nullptr;
    bool with_unknown = false;
    /// Of what the hypothesis explains, the part that the named causes do not; 0 without an unknown cause.
    double unknown_fraction = 0.0;
};

/// Compares explanations of a recording by the residuals that they leave.
///
/// A hypothesis has any number of causes, of which one may be outside the list. Its evidence is the
/// likelihood of the mean square residual over the independent samples, integrated over the numbers with
/// their priors by Laplace's method (E57). Residuals are correlated in time, so only independent samples
/// count. They are noise plus a discrepancy (Discrepancy), whose size is integrated over: small beside named
/// causes, whose laws are good to a tenth; of any visible size for a cause outside the list, which may also
/// be no function of the motion at all. On a bench that is taken as built, the means of blocks are weighed
/// apart from the deviations from them (E69). Two terms go beyond that: the prior probability of each kind of
/// hypothesis, and that of the scale of each channel's residuals, which is known where noise and floor are
/// (E56). The constants stand in evidence.cpp, each with its reason.
class Evidence {
  public:
    /// `independent_samples`: the number of instants with independent residuals.
    explicit Evidence(double independent_samples) : samples_(independent_samples) {}

    /// From now on.
    void set_samples(double independent_samples) { samples_ = independent_samples; }
    /// How much what is left below noise and floor counts (E64), from now on.
    void set_below_noise_weight(double weight) { below_noise_weight_ = weight; }
    /// The logarithm of a mean square residual as the likelihood counts it.
    double log_of(double mean_square) const { return weighed_log(mean_square, below_noise_weight_); }

    double of(const ScoredFit& fit) const;
    /// The penalty of a set for causes that only correct the model, however visible they are beside numbers
    /// that make up for them: without such a cause the others, fitted again, leave less than the model's own
    /// error more (rms), which is a quarter of noise and floor and a tenth of what the clearest of them does.
    /// `fits` tell what smaller sets leave; 0 where they do not. Where the scale of the channels' errors is
    /// not known (E54), it is 0 if more than noise and floor is left.
    double penalty_of_corrections(const ScoredFit& fit, const std::vector<ScoredFit>& fits) const;
    /// The evidence of a fit's causes together with one outside the list.
    double with_unknown(const ScoredFit& fit) const;

    /// Every explanation that was tried, alone and with an unknown cause, best first. `fits` must outlive the
    /// result.
    std::vector<WeighedHypothesis> weigh(const std::vector<ScoredFit>& fits) const;

    /// The effects of all hypotheses, most probable first. Causes that act together share the probability of
    /// their hypothesis, an unknown one by the part that it explains. Probabilities sum to 1.
    static std::vector<RankedEffect> rank(const std::vector<CandidateCause>& causes,
                                          const std::vector<WeighedHypothesis>& weighed);

    /// The evidence is divided by this factor, because residuals are a little more correlated than assumed.
    static constexpr double overstated = 1.3;

  private:
    double log_likelihood(const ScoredFit& fit, double misfit) const;
    double priors(const ScoredFit& fit) const;
    double marginal(const ScoredFit& fit, const std::function<double(double size)>& weight) const;
    double of_any_residuals(const ScoredFit& fit) const;

    double samples_;
    double below_noise_weight_ = below_noise_weight;
};

/// Half the squared distance of three numbers from what was stated that one bench in twenty exceeds.
inline constexpr double tenable_nominal_penalty = 3.91;

/// How many numbers a fit chose freely, beyond the nominal numbers within their uncertainty.
std::size_t open_numbers(const CauseFit& fit);

/// Whether a fit has no cause, or none but several zeros and bearings' friction, which every bench as built
/// has.
bool names_only_the_bench(const ScoredFit& fit);

/// True if a fit leaves enough to look for a further cause: more than noise, and more than the law of its
/// clearest cause may be wrong by, or numbers that are not tenable; always where the scale of a channel's
/// error is not known (E54).
bool worth_a_further_cause(const ScoredFit& fit);

}  // namespace capstan::gap
