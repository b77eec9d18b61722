#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capstan/gap/candidate_cause.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/evidence.h"
#include "capstan/gap/screening.h"

namespace capstan::gap {

struct CauseSearchOptions {
    int segments = 40;  ///< of a cable
    int stride = 1;     ///< samples per step
    int threads = 0;    ///< 0: as many as the machine has
    /// After this time no further cause is tried, and the best answer so far is given.
    double time_limit_s = std::numeric_limits<double>::infinity();
    /// Called with the present activity and the fraction of the work that is done.
    std::function<void(const std::string& activity, double fraction_done)> on_progress =
        [](const std::string&, double) {};
};

/// All fits, best first.
struct FoundCauses {
    std::vector<ScoredFit> fits;
    double nominal_misfit = 0.0;
    int evaluations = 0;     ///< simulations of the complete recording
    bool cut_short = false;  ///< by the time limit
};

/// Searches the causes of a recording's gap: screens every cause, fits the most promising ones, and adds
/// further causes to the best of them for as long as that raises the evidence. A recording that a bench with
/// measured numbers does not explain is searched again as one of a bench as it is built, whose numbers,
/// sensors' zeros and bearings are only roughly known.
class CauseSearch {
  public:
    /// `recording` must outlive it and what it finds.
    CauseSearch(const Recording& recording, const CauseSearchOptions& options);

    /// The fits point to the causes that this search keeps.
    FoundCauses run() &;

    /// Simulates the recording as the search does most often: a pilot times it.
    void simulate_once() const;

    const CauseFitter& fitter() const { return fine_.fitter; }
    const CauseFitter& coarse_fitter() const { return coarse_.fitter; }
    const Evidence& evidence() const { return evidence_; }
    const std::vector<CandidateCause>& causes() const { return described_.causes; }

  private:
    static constexpr std::size_t max_fitted_further = 3;  // causes that get a full fit beside others
    static constexpr std::size_t max_causes = 5;          // of a set
    static constexpr std::size_t max_fitted_finely = 7;   // sets
    static constexpr std::size_t max_after_draft = 9;     // sets that are fitted again
    // An explanation so far behind the best one in evidence is a twentieth as probable: ln 20.
    static constexpr double rival_behind = 3.0 * Evidence::overstated;
    // Where the numbers of an undescribed bench leave more than this, they lead nowhere without its causes.
    static constexpr double leads_nowhere = 10.0;
    // Where they leave more than this, they may have taken up most of a cause and hide it from the screening.
    static constexpr double explains_little = 3.0;
    // A set that is so far behind the best one in evidence after a few steps of a search does not lead in the
    // end, nor does one of which the linear screening says the second.
    static constexpr double far_behind = 30.0;
    static constexpr double hopeless = 100.0;
    // A refinement that gains less evidence than this ends.
    static constexpr double clear_gain = 1.0;
    // What is known of the bench, and what could be wrong with it.
    struct Level {
        BenchKnowledge bench;
        std::vector<CandidateCause> causes;

        std::span<const CandidateCause> sought_first() const;
        std::span<const CandidateCause> sought_last() const;
        /// Null if it is not sought.
        const CandidateCause* same_cause(const std::string& effect, const std::string& variant) const;
    };
    using Fits = std::vector<ScoredFit>;
    // A cause beside those that are present, and where a fit with it starts.
    struct Further {
        const CandidateCause* cause = nullptr;
        Hypothesis start;
        double sum_of_squares = 0.0;
        /// A few steps of a search show that it will not lead.
        bool is_behind = false;
    };
    struct Model {
        Model(const Recording& recording, const EffectsTwinOptions& options, int threads);

        CauseFitter fitter;
        Discrepancy discrepancy;
        /// What is left beside floating numbers without a cause, mean square; infinite where that was not
        /// fitted.
        double left_without_cause = std::numeric_limits<double>::infinity();
        std::vector<double> left_of_channels{};  ///< the same of each predicted channel
    };

    void report(const std::string& activity);
    bool is_out_of_time();
    Model& model_of(const Level& level) { return level.bench.is_measured() ? fine_ : rough_model(); }
    // The means of blocks are sharper, by a factor of a few (E69): what is behind by so much more may lead.
    double sharpness() const { return in_blocks_ ? 4.0 : 1.0; }
    Model& rough_model() { return draft_ ? *draft_ : coarse_; }
    /// Those of the first screening. Of a drive there are none: its numbers may lead nowhere without its
    /// causes, so that the first screening tells little.
    PromisingStarts& promising_starts() {
        if (recording_.nominal_is_fitted) promising_starts_.clear();
        return promising_starts_;
    }
    void begin_draft(Fits& fits);
    void end_draft(Fits& fits);
    CauseFit fit_on(const Level& level, const Hypothesis& start, CauseFitter::FitOptions options);
    CauseFit roughly_fitted(std::span<const Hypothesis> starts, const SeriesWeights& weights,
                            const WideDerivatives& known = {});
    ScoredFit measured(const Model& model, CauseFit fit) const;
    void weigh(Model& model, ScoredFit& fit);
    Marginals beside_own_scales(const Model& model, const CauseFit& fit) const;
    Fits made_side_by_side(Model& model, std::size_t count, const std::function<CauseFit(std::size_t)>& fit,
                           std::size_t at_least = 1);
    ScoredFit scored(Model& model, CauseFit fit);
    static void remove_unstated_numbers(Level& level);
    bool is_undescribed(const BenchKnowledge& bench) const;
    double clear_delay(const CauseFit& fit, std::size_t number, double visibility) const;
    std::vector<Eigen::VectorXd> further_starts(const BenchKnowledge& bench) const;
    Hypothesis roughly_sought(const BenchKnowledge& bench) const;
    ScoredFit fitted(const Level& level, const Hypothesis& start, const CauseFitter::FitOptions& options);
    Fits fitted_again(Model& model, const Fits& fits, std::size_t max_sets);
    double held_out_log_misfit(const Hypothesis& hypothesis, const SeriesWeights& weights,
                               const std::vector<LeftOut>& parts);
    void charge_corrections(Fits& fits);
    void add_fitted_finely(const std::vector<Hypothesis>& starts, Fits& all);
    void drop_unearned_causes(Fits& fits);
    bool take_correlation_of(const ScoredFit& best);
    bool should_be_taken_as_built(const Fits& fits);
    bool stands_for_usual_numbers(const Fits& fits);
    static bool has_several_and_a_usual_number(const ScoredFit& fit);
    ScoredFit fitted_as_built(const ScoredFit& described);
    ScoredFit without_cause(const Level& level);
    Fits search_one(const Level& level);
    void sort(const Level& level, Fits& fits) const;
    void search_several(const Level& level, Fits& all);
    void try_without_idle_causes(const Level& level, Fits& all);
    bool try_fewer(const Level& level, Fits& all);
    void try_fewer_finely(Fits& all);
    void try_from_smaller_sets(const Level& level, Fits& all);
    bool try_more(const Level& level, Fits& all);
    static const ScoredFit* with_one_cause_fewer(const Fits& all);
    bool replace_the_weakest(const Level& level, Fits& all);
    void refine(const Level& level, Fits& all);
    void try_ripple_or_torque(const Level& level, Fits& all);
    Fits fitted_instead(const Level& level, const CauseFit& fit, const CandidateCause& cause,
                        const std::function<bool(const CandidateCause&)>& replaces);
    static bool has_ripple(const ScoredFit& fit);
    void try_periods(const Level& level, Fits& sets);
    void try_usual_numbers(const Level& level, Fits& all);
    void try_swapping(const Level& level, Hypothesis& swapped, Fits& all);
    void add_fits(const Level& level, const std::vector<Hypothesis>& starts, bool any_size, Fits& fits);
    void try_replacing(const Level& level, Fits& sets);
    void add_promising_pairs(const Level& level, const Fits& singles, Fits& sets);
    void try_others(const Level& level, Fits& all);
    static std::vector<Hypothesis> with_faults_of_sensors(const Level& level, const ScoredFit& fit);
    void try_faults_of_the_bench(const Level& level, Fits& fits);
    bool try_last(const Level& level, Fits& all);
    std::optional<Hypothesis> with_measured_numbers(const ScoredFit& found) const;
    void add_measured_sets(const Fits& built, Fits& all);
    std::vector<Further> screened(const Level& level, std::span<const CandidateCause> causes,
                                  const Hypothesis& present, const SeriesWeights& weights,
                                  bool begins_elsewhere);
    double behind_the_best(double sum_of_squares, const SeriesWeights& weights) const;
    void mark_those_behind(const Hypothesis& present, const SeriesWeights& weights,
                           const WideDerivatives& there, std::vector<Further>& all);
    void fit_roughly(std::vector<Further>& all, const SeriesWeights& weights,
                     std::span<const Eigen::VectorXd> elsewhere, const WideDerivatives& known = {});
    void add_from_elsewhere(const Level& level, std::span<const Further> some, const SeriesWeights& weights,
                            Fits& singles);
    void add_confusable(const Level& level, const CandidateCause& confused,
                        const std::vector<Further>& screened, Fits& fits);
    void try_confusable(const Level& level, Fits& all);
    bool try_crossing(const Level& level, Fits& all);
    static double pruned_at(const Fits& fits);
    bool only_corrects_the_model(const ScoredFit& single, const Fits& singles) const;
    Fits larger_sets(const Level& level, const Fits& smaller);
    void add_sets(const Level& level, const Hypothesis& hypothesis, const SeriesWeights& weights,
                  std::size_t max_further, Fits& sets) {
        add_sets(level, level.sought_first(), hypothesis, weights, max_further, sets);
    }
    void add_sets(const Level& level, std::span<const CandidateCause> causes, const Hypothesis& hypothesis,
                  const SeriesWeights& weights, std::size_t max_further, Fits& sets);

    const Recording& recording_;
    CauseSearchOptions options_;
    Model fine_;
    Model coarse_;
    std::optional<Model> draft_;  // coarser still, while a drive's numbers lead nowhere without its causes
    Evidence evidence_;
    Level described_;  // as the recording describes the bench
    Level built_;
    PromisingStarts promising_starts_;  // of the causes of both
    Eigen::VectorXd built_numbers_;     // of the bench as built, beside the best causes of the measured bench
    double nominal_misfit_ = 0.0;
    // The best fit so far of the bench as built by the rough model: what it leaves of the data, then the
    // priors.
    Eigen::VectorXd best_leaves_;
    double best_evidence_ = -std::numeric_limits<double>::infinity();
    bool in_blocks_;           // the evidence is of blocks (E69): the scale of each channel's error is known
    bool is_sharper_ = false;  // the evidence, because little correlation is left
    int fitted_ = 0;
    // Fits that are made side by side count and look at the time.
    std::atomic<int> evaluations_ = 0;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
    std::atomic<bool> cut_short_ = false;
};

/// In place, best first.
void sort_by_evidence(std::vector<ScoredFit>& fits);

}  // namespace capstan::gap
