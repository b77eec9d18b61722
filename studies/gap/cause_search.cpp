#include "capstan/gap/cause_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "capstan/platform/parallel_for.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// How many causes get a full fit after the screening.
constexpr std::size_t max_fitted = 8;
// Fits of single causes that are made side by side. What they are pruned at does not depend on the threads.
constexpr std::size_t fits_at_once = 4;
constexpr int segments_of_a_drive = 9;

int samples_skipped(const Recording& recording, double enough_Hz) {
    return std::max(1, static_cast<int>(recording.sample_rate_Hz / enough_Hz));
}

// The screening uses fewer segments and samples. A drive of unknown geometry has no bend at a place, so few
// segments are enough; a band, whose tension falls by a factor round its drum, needs as many as a described
// cable. But both are moved by recorded channels: what is left of their noise moves them to and fro, and
// friction remembers it, so samples are skipped only of what was recorded faster than a hand moves, or for
// long. A described bench is moved by its true motion, of which the turns matter, and the twin keeps those.
EffectsTwinOptions coarse_options(const Recording& recording, int stride) {
    constexpr double enough_Hz = 100.0;
    constexpr double enough_of_a_long_recording_Hz = 50.0;
    constexpr double long_s = 80.0;
    constexpr int segments = 24;
    if (!recording.nominal_is_fitted) return {.segments = segments, .stride = 4 * stride};
    const bool is_long =
        recording.is_undescribed_drive() && recording.samples() > long_s * recording.sample_rate_Hz;
    return {
        .segments = recording.is_undescribed_drive() ? segments_of_a_drive : segments,
        .stride = stride * samples_skipped(recording, is_long ? enough_of_a_long_recording_Hz : enough_Hz)};
}

// More segments than these change nothing of what is found on a drive.
EffectsTwinOptions fine_options(const Recording& recording, const CauseSearchOptions& options) {
    const int segments = recording.is_undescribed_drive() ? 2 * segments_of_a_drive : options.segments;
    return {.segments = std::min(options.segments, segments), .stride = options.stride};
}

// Where much more than noise is left, what noise does to friction does not matter, and a hand's motion is
// known from few samples.
EffectsTwinOptions draft_options(const Recording& recording, int stride) {
    constexpr double enough_Hz = 25.0;
    return {.segments = segments_of_a_drive, .stride = samples_skipped(recording, enough_Hz) * stride};
}

// Fits that a search usually makes; progress is stated in parts of it.
constexpr double usual_fits = 30.0;

// Whether a fit leaves clearly more than noise and floor. A cause may then be hidden by several wrong numbers
// and zeros at once.
bool leaves_much(const ScoredFit& fit) {
    constexpr double much = 2.0;
    return fit.misfit > much;
}

// Of a bench whose numbers float widely, no number can be wrong beyond that.
void remove_wrong_numbers(std::vector<CandidateCause>& causes) {
    std::erase_if(
        causes, [](const CandidateCause& cause) { return cause.numbers.empty() && cause.effect != "none"; });
}

// Whoever states the numbers of a bench knows of a spring or a cam at its motor.
void remove_undescribed_parts(std::vector<CandidateCause>& causes) {
    std::erase_if(causes, [](const CandidateCause& cause) {
        return cause.effect == "position_torque" || cause.effect == "eccentric_pulley";
    });
}

// Not that of gears, which grows with the torque.
bool is_friction_of_a_bearing(const CandidateCause& cause) {
    return cause.effect == "pulley_friction" && cause.numbers.front().name == "coulomb";
}

// Zeros and bearings of an undescribed bench float by factors. Its radii and routing are not known, so the
// gain of a sensor and a bend at a place are part of what was fitted.
void remove_what_is_fitted(std::vector<CandidateCause>& causes) {
    remove_wrong_numbers(causes);
    std::erase_if(causes, [](const CandidateCause& cause) {
        return !cause.is_of_runs && (cause.effect == "sensor_offset" || is_friction_of_a_bearing(cause) ||
                                     cause.effect == "sensor_gain" || cause.effect == "local_bend");
    });
}

}  // namespace

void sort_by_evidence(std::vector<ScoredFit>& fits) {
    std::stable_sort(fits.begin(), fits.end(),
                     [](const ScoredFit& a, const ScoredFit& b) { return a.evidence > b.evidence; });
}

// A search is pruned if its linear model promises more than this many times the best misfit so far: with 300
// independent samples, 70 units of evidence.
double CauseSearch::pruned_at(const Fits& fits) {
    constexpr double factor = 1.6;
    double least = std::numeric_limits<double>::infinity();
    for (const ScoredFit& each : fits) least = std::min(least, each.fit.sum_of_squares);
    return factor * least;
}

CauseSearch::Model::Model(const Recording& recording, const EffectsTwinOptions& options, int threads)
    : fitter(recording, options, threads),
      discrepancy(recording, fitter.series(), options.stride, fitter.independent_samples()) {}

CauseSearch::CauseSearch(const Recording& recording, const CauseSearchOptions& options)
    : recording_(recording),
      options_(options),
      fine_(recording, fine_options(recording, options), options.threads),
      coarse_(recording, coarse_options(recording, options.stride), options.threads),
      evidence_(fine_.fitter.independent_samples()),
      described_{recording.nominal_is_fitted ? undescribed_bench(recording)
                                             : measured_bench(recording.nominal->spread),
                 candidate_causes(recording)},
      built_{built_bench(recording), candidate_causes(recording)},
      in_blocks_(described_.bench.is_measured()) {
    if (in_blocks_) {
        for (Model* model : {&fine_, &coarse_}) model->fitter.weigh_blocks();
    }
    if (recording.nominal_is_fitted) {
        remove_what_is_fitted(described_.causes);
        if (recording.nominal->load_compliance_rad_per_Nm > 0.0)
            std::erase_if(described_.causes, [](const CandidateCause& cause) {
                return cause.effect == "environment_coupling";  // it floats
            });
    } else {
        remove_undescribed_parts(described_.causes);
    }
    remove_unstated_numbers(described_);
    remove_wrong_numbers(built_.causes);
    remove_undescribed_parts(built_.causes);
}

void CauseSearch::simulate_once() const {
    const Hypothesis nominal = nominal_hypothesis(described_.bench);
    (void)coarse_.fitter.data_residuals({&nominal, 1});
}

FoundCauses CauseSearch::run() & {
    report("nominal model");
    const Hypothesis nominal = nominal_hypothesis(described_.bench);
    nominal_misfit_ =
        fine_.fitter.data_residuals({&nominal, 1}).squaredNorm() / fine_.fitter.determined_rows();
    FoundCauses found;
    const bool is_measured = described_.bench.is_measured();
    found.fits = search_one(described_);
    bool built = is_measured && should_be_taken_as_built(found.fits);
    if (built && leaves_much(found.fits.front())) {
        // A cause that is sought last may look like one that asks for far numbers.
        try_last(described_, found.fits);
    } else {
        // Two causes may explain what one of them explains only beside far numbers.
        search_several(described_, found.fits);
        const ScoredFit& best = found.fits.front();
        built = built ||
                (is_measured && (leaves_much(best) || has_several_and_a_usual_number(best) ||
                                 (best.fit.causes.size() > 1 && (should_be_taken_as_built(found.fits) ||
                                                                 stands_for_usual_numbers(found.fits)))));
    }
    if (built) {
        evidence_.set_below_noise_weight(below_noise_weight_beside_floating_numbers);
        for (ScoredFit& each : found.fits) each.evidence = evidence_.of(each);
        Fits coarse = search_one(built_);
        search_several(built_, coarse);
        Fits rougher = fitted_again(fine_, coarse, max_fitted_finely);
        try_fewer_finely(rougher);
        found.fits.insert(found.fits.end(), rougher.begin(), rougher.end());
        sort_by_evidence(found.fits);
        add_measured_sets(rougher, found.fits);
    } else if (!is_measured) {
        found.fits = fitted_again(fine_, found.fits, max_fitted_finely);
        // A sharper evidence also tells whether a fit is quite at its minimum.
        if (is_sharper_) found.fits = fitted_again(fine_, found.fits, max_fitted_finely);
    }
    charge_corrections(found.fits);
    drop_unearned_causes(found.fits);
    found.nominal_misfit = nominal_misfit_;
    found.evaluations = evaluations_;
    found.cut_short = cut_short_;
    return found;
}

// A zero or a bearing's friction among several causes: a bench as built has others, too.
bool CauseSearch::has_several_and_a_usual_number(const ScoredFit& fit) {
    const std::vector<const CandidateCause*>& causes = fit.fit.causes;
    return causes.size() > 1 && std::any_of(causes.begin(), causes.end(), [](const CandidateCause* cause) {
               return cause->effect == "sensor_offset" || cause->effect == "pulley_friction";
           });
}

// Whether the best explanation, or one that is at least a twentieth as probable, asks for numbers far from
// those stated, or the best one leaves much and gains clearly by rough knowledge of the bench.
bool CauseSearch::should_be_taken_as_built(const Fits& fits) {
    constexpr double clearly = 3.0;
    if (is_out_of_time()) return false;
    const ScoredFit& best = fits.front();
    const auto is_rival_with_far_numbers = [&](const ScoredFit& each) {
        return each.evidence > best.evidence - rival_behind && each.nominal_penalty > tenable_nominal_penalty;
    };
    if (std::any_of(fits.begin(), fits.end(), is_rival_with_far_numbers)) return true;
    return worth_a_further_cause(best) && fitted_as_built(best).evidence > best.evidence + clearly;
}

// Whether zeros, bearings and the like explain more than one of the causes of the best set does, for which it
// then stood.
bool CauseSearch::stands_for_usual_numbers(const Fits& fits) {
    const ScoredFit* fewer = with_one_cause_fewer(fits);
    return fewer != nullptr && !is_out_of_time() && fitted_as_built(*fewer).evidence > fits.front().evidence;
}

// The same causes beside the numbers of a bench as built.
ScoredFit CauseSearch::fitted_as_built(const ScoredFit& described) {
    report("fitting the bench's own numbers");
    Hypothesis built = nominal_hypothesis(built_.bench);
    built.coordinates.head(nominal_coordinates) = described.fit.coordinates.head(nominal_coordinates);
    Eigen::Index next = nominal_coordinates;
    for (const CandidateCause* cause : described.fit.causes) {
        const auto count = static_cast<Eigen::Index>(cause->numbers.size());
        const CandidateCause* same = built_.same_cause(cause->effect, cause->variant);
        if (same != nullptr && same->effect != "none")
            built = with_cause(built, same, described.fit.coordinates.segment(next, count));
        next += count;
    }
    if (built.causes.empty()) built = with_cause(built, &built_.causes.front(), {});
    CauseFitter::FitOptions options;
    options.any_size = false;
    ScoredFit fit = scored(fine_, fine_.fitter.fit(built, options));
    built_numbers_ = fit.fit.coordinates.head(built_.bench.size());
    return fit;
}

void CauseSearch::begin_draft(Fits& fits) {
    const EffectsTwinOptions options = draft_options(recording_, options_.stride);
    if (options.stride <= coarse_.fitter.twin().stride()) return;
    draft_.emplace(recording_, options, options_.threads);
    fits = fitted_again(*draft_, fits, max_after_draft);
}

void CauseSearch::end_draft(Fits& fits) {
    draft_.reset();
    fits = fitted_again(coarse_, fits, max_after_draft);
}

CauseSearch::Fits CauseSearch::search_one(const Level& level) {
    const Hypothesis start = nominal_hypothesis(level.bench);
    Fits singles = {without_cause(level)};
    if (recording_.is_undescribed_drive() && singles.front().misfit > leads_nowhere) begin_draft(singles);
    // Numbers that float widely move first, for every cause is screened beside them.
    const Hypothesis nothing = level.bench.is_measured() && !level.bench.has_unknown_number()
                                   ? start
                                   : Hypothesis{{}, singles.front().fit.coordinates, &level.bench};
    report("screening all causes");
    const bool leads_somewhere = singles.front().misfit < leads_nowhere;
    const std::vector<Further> all =
        screened(level, level.sought_first(), nothing, singles.front().fit.weights,
                 is_undescribed(level.bench) || !leads_somewhere);
    // Every cause is fitted where the screening does not tell which ones are promising.
    const bool is_told = !is_undescribed(level.bench) || singles.front().misfit < explains_little;
    constexpr std::size_t always_fitted = 2;  // each is tried with a further cause
    const std::size_t max_count = is_told ? max_fitted : all.size();
    // A wrong nominal number is always fitted, because the screening lets every cause vary the nominal
    // numbers; and so is a cause that the values themselves show.
    std::vector<Further> chosen;
    std::size_t fitted = 0;
    for (const Further& each : all) {
        const bool is_always_fitted = each.cause->numbers.empty() || each.cause->is_seen;
        if ((fitted == max_count || (fitted >= always_fitted && each.is_behind)) && !is_always_fitted)
            continue;
        if (!is_always_fitted) ++fitted;
        chosen.push_back(each);
    }
    const SeriesWeights weights = singles.front().fit.weights;
    for (std::size_t k = 0; k < chosen.size() && !is_out_of_time(); k += fits_at_once) {
        std::vector<Hypothesis> starts;
        for (std::size_t next = k; next < std::min(k + fits_at_once, chosen.size()); ++next)
            starts.push_back(chosen[next].start);
        report("fitting " + in_words(starts.front().causes));
        add_fits(level, starts, level.bench.is_measured(), singles);
    }
    if (is_undescribed(level.bench) && !is_out_of_time()) {
        // A few rough steps do not show which start leads to the best fit: promising causes, by the screening
        // or by their fit, are fitted from all starts; where one closes much, not those that close nothing.
        constexpr double promising_factor = 2.5;
        constexpr double closes_much = 0.5;
        constexpr double closes_something = 0.95;
        const auto misfit = [](const ScoredFit& a, const ScoredFit& b) { return a.misfit < b.misfit; };
        const double least = std::min_element(singles.begin(), singles.end(), misfit)->misfit;
        const double without = singles.front().misfit;
        double promises = promising_factor * least;
        if (least < closes_much * without) promises = std::min(promises, closes_something * without);
        std::vector<Further> promising;
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            if (k < max_fitted || singles[k + 1].misfit < promises) promising.push_back(chosen[k]);
        }
        add_from_elsewhere(level, promising, weights, singles);
    }
    sort_by_evidence(singles);
    try_faults_of_the_bench(level, singles);
    if (!worth_a_further_cause(singles.front()) && !is_out_of_time()) {
        add_confusable(level, *singles.front().fit.causes.front(), all, singles);
        sort_by_evidence(singles);
    }
    return singles;
}

// A number of which the sidecar states a range, or nothing, cannot be wrong beside that.
void CauseSearch::remove_unstated_numbers(Level& level) {
    std::erase_if(level.causes, [&](const CandidateCause& cause) {
        if (!cause.numbers.empty() || cause.effect == "none") return false;
        for (Eigen::Index k = 0; k < nominal_coordinates; ++k) {
            if (cause.nominal_std(k) > nominal_log_std &&
                level.bench.numbers[static_cast<std::size_t>(k)].effect.empty())
                return true;
        }
        return false;
    });
}

// A grid over the numbers of which next to nothing is stated.
Hypothesis CauseSearch::roughly_sought(const BenchKnowledge& bench) const {
    constexpr double steps[] = {-2.0, -1.0, 0.0, 1.0, 2.0};  // standard deviations
    std::vector<Hypothesis> grid = {nominal_hypothesis(bench)};
    for (Eigen::Index k = 0; k < nominal_coordinates; ++k) {
        const double spread = bench.numbers[static_cast<std::size_t>(k)].prior_std;
        if (spread <= nominal_log_std) continue;
        std::vector<Hypothesis> finer;
        for (const Hypothesis& each : grid) {
            for (const double step : steps) {
                finer.push_back(each);
                finer.back().coordinates[k] = step * spread;
            }
        }
        grid = std::move(finer);
    }
    Eigen::Index best = 0;
    coarse_.fitter.data_residuals(grid).colwise().squaredNorm().minCoeff(&best);
    return grid[static_cast<std::size_t>(best)];
}

bool CauseSearch::is_undescribed(const BenchKnowledge& bench) const {
    return &bench == &described_.bench && !bench.is_measured();
}

ScoredFit CauseSearch::without_cause(const Level& level) {
    const Hypothesis nominal = with_cause(level.bench.has_unknown_number() && !is_undescribed(level.bench)
                                              ? roughly_sought(level.bench)
                                              : nominal_hypothesis(level.bench),
                                          &level.causes.front(), {});
    std::vector<Hypothesis> starts = {nominal};
    // A search from the stated numbers may end far off; the best causes of the measured bench lead elsewhere.
    if (&level.bench == &built_.bench && built_numbers_.size() > 0) {
        starts.push_back(nominal);
        starts.back().coordinates = built_numbers_;
    }
    for (const Eigen::VectorXd& from : further_starts(level.bench)) {
        starts.push_back(nominal);
        starts.back().coordinates = from;
    }
    Fits fits = made_side_by_side(model_of(level), starts.size(),
                                  [&](std::size_t k) { return fit_on(level, starts[k], {}); });
    sort_by_evidence(fits);
    return std::move(fits.front());
}

// Beside the nominal numbers. Of an undescribed bench these are a guess; stiffness and pretension make much
// the same loop, so that searches begin at several ratios of the two.
std::vector<Eigen::VectorXd> CauseSearch::further_starts(const BenchKnowledge& bench) const {
    if (!is_undescribed(bench)) return {};
    std::vector<Eigen::VectorXd> starts;
    for (const Eigen::Vector3d& numbers :
         {Eigen::Vector3d(0.0, 0.0, -1.0), Eigen::Vector3d(0.0, 0.5, -1.0), Eigen::Vector3d(0.0, 0.0, 1.0)}) {
        starts.push_back(nominal_hypothesis(bench).coordinates);
        starts.back().head(nominal_coordinates) = numbers;
    }
    return starts;
}

bool CauseSearch::is_out_of_time() {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun_;
    if (taken.count() > options_.time_limit_s) cut_short_ = true;
    return cut_short_;
}

void CauseSearch::report(const std::string& activity) {
    const double done = static_cast<double>(fitted_) / usual_fits;
    options_.on_progress(activity, 0.9 * (1.0 - std::exp(-done)));
}

// A bench with many floating numbers is searched with the coarse model, and its best sets are fitted again.
// On a measured bench the coarse model leads every fit close to its minimum.
CauseFit CauseSearch::fit_on(const Level& level, const Hypothesis& start, CauseFitter::FitOptions options) {
    if (level.bench.is_measured()) {
        CauseFitter::FitOptions coarsely = options;
        coarsely.pruned_sum_of_squares *= coarse_.fitter.determined_rows() / fine_.fitter.determined_rows();
        const CauseFit close = coarse_.fitter.fit(start, coarsely);
        CauseFitter::FitOptions from_there = options;
        from_there.any_size = false;
        from_there.balanced = true;
        from_there.is_close = true;
        CauseFit fit = fine_.fitter.fit(close.hypothesis(), from_there);
        fit.evaluations += close.evaluations;
        return fit;
    }
    options.balanced = true;
    // There each channel has a scale of its own, and the sum of squares decides nothing.
    if (is_undescribed(level.bench)) options.pruned_sum_of_squares = std::numeric_limits<double>::infinity();
    return model_of(level).fitter.fit(start, options);
}

ScoredFit CauseSearch::fitted(const Level& level, const Hypothesis& start,
                              const CauseFitter::FitOptions& options) {
    return scored(model_of(level), fit_on(level, start, options));
}

CauseFit CauseSearch::roughly_fitted(std::span<const Hypothesis> starts, const SeriesWeights& weights,
                                     const WideDerivatives& known) {
    CauseFit rough = rough_model().fitter.rough_fit(starts, weights, known);
    evaluations_ += rough.evaluations;
    return rough;
}

// The probability that the time of a sensor explains a part of the gap although it is usual, if that is more
// probable than not; else 0. In a drive without a description much else can stand for it.
double CauseSearch::clear_delay(const CauseFit& fit, std::size_t number, double visibility) const {
    if (fit.bench->numbers[number].effect != "time_misalignment" || is_undescribed(*fit.bench)) return 0.0;
    const auto row = static_cast<Eigen::Index>(number);
    const double deviations =
        std::abs(fit.coordinates[row]) / std::sqrt(fit.bench_variances_without_blocks[row]);
    const double log_odds = log_odds_of_usual_number(fit, deviations, visibility);
    return log_odds > 0.0 ? 1.0 / (1.0 + std::exp(-log_odds)) : 0.0;
}

// All of a fit's score that does not depend on other fits.
ScoredFit CauseSearch::measured(const Model& model, CauseFit fit) const {
    ScoredFit scored;
    scored.fit = std::move(fit);
    scored.misfit = model.fitter.misfit(scored.fit);
    scored.nominal_penalty = model.fitter.nominal_penalty(scored.fit);
    scored.shape_penalty = model.fitter.shape_penalty(scored.fit);
    const StatedNumbers stated =
        scored.fit.bench->is_measured()
            ? StatedNumbers{}
            : weigh_stated_numbers(*scored.fit.bench, scored.fit.coordinates.head<nominal_coordinates>(),
                                   scored.fit.nominal_covariance);
    scored.stated_gain = stated.log_gain;
    const Visibility visibility = model.fitter.visibility(scored.fit);
    scored.visibility = visibility.of_causes;
    constexpr double visible = 2.0;
    constexpr double visible_in_blocks = 0.5;  // a stated number; its probability is that of E63
    for (std::size_t k = 0; k < visibility.of_the_bench.size(); ++k) {
        const FloatingNumber& number = scored.fit.bench->numbers[k];
        const double coordinate = scored.fit.coordinates[static_cast<Eigen::Index>(k)];
        const bool is_stated = k < nominal_coordinates;
        const double enough = in_blocks_ && is_stated ? visible_in_blocks : visible;
        const bool is_visible = visibility.of_the_bench[k] > enough;
        const double clear = clear_delay(scored.fit, k, visibility.of_the_bench[k]);
        if ((!is_visible && clear == 0.0) || number.effect.empty()) continue;
        if (is_visible) scored.visible_numbers.push_back(k);
        const auto row = static_cast<Eigen::Index>(k);
        // A law may hold for another reference than the stated number does.
        const auto is_one_with = [&](const CandidateCause* cause) {
            return is_slowness_of_one_sensor(number.effect, number.variant, *cause) ||
                   (number.effect == "sensor_gain" && cause->effect == number.effect &&
                    cause->variant == number.variant) ||
                   (is_stated && cause->nominal_std(row) > nominal_log_std);
        };
        if (std::any_of(scored.fit.causes.begin(), scored.fit.causes.end(), is_one_with)) continue;
        const bool is_far = number.is_far(coordinate);
        if (!is_far && clear == 0.0) continue;
        // That a number with usual values is beyond them is told almost for certain.
        constexpr double beyond_what_is_usual = 0.99;
        const bool may_correct = is_stated || number.usual > 0.0;
        ScoredFit::FarNumber far{k, is_stated ? stated.wrong[row] : may_correct ? beyond_what_is_usual : 1.0};
        far.is_usual = !is_far;
        if (far.is_usual) far.probability = std::min(far.probability, clear);
        if (may_correct)
            far.closes = std::sqrt(std::max(1.0, scored.misfit) * coordinate * coordinate /
                                   scored.fit.bench_variances_without_blocks[row] /
                                   model.fitter.independent_samples());
        scored.far_numbers.push_back(far);
        // A number that has usual values is a fault beyond them; others, such as zeros, are usual at any
        // value.
        const double of_others = far.is_usual ? far.probability : number.usual > 0.0 ? 1.0 : 0.0;
        const double is_a_cause = is_stated ? stated.one_alone : of_others;
        scored.far_numbers_are_usual = std::min(scored.far_numbers_are_usual, 1.0 - is_a_cause);
    }
    scored.has_unknown_scales = is_undescribed(*scored.fit.bench);
    if (!scored.has_unknown_scales) {
        scored.beside = model.discrepancy.within_blocks(scored.fit.residuals);
        scored.of_blocks = model.discrepancy.of_blocks(scored.fit.residuals);
        scored.channel_misfits = model.fitter.channel_misfits(scored.fit);
        scored.channel_floors = model.fitter.channel_floors();
    }
    return scored;
}

// In the order of the fits.
void CauseSearch::weigh(Model& model, ScoredFit& fit) {
    ++fitted_;
    evaluations_ += fit.fit.evaluations;
    if (!fit.fit.bench->is_measured()) {
        if (is_nothing(fit.fit.causes) && fit.misfit < model.left_without_cause) {
            model.left_without_cause = fit.misfit;
            model.left_of_channels = model.fitter.channel_misfits(fit.fit);
        }
        fit.max_visibility = std::sqrt(std::max(0.0, model.left_without_cause - fit.misfit));
    }
    if (fit.has_unknown_scales) fit.beside = beside_own_scales(model, fit.fit);
    fit.evidence = evidence_.of(fit);
    if (fit.fit.bench == &built_.bench && &model == &coarse_ && fit.evidence > best_evidence_) {
        best_evidence_ = fit.evidence;
        best_leaves_ = fit.fit.residuals;
    }
}

ScoredFit CauseSearch::scored(Model& model, CauseFit fit) {
    ScoredFit scored = measured(model, std::move(fit));
    weigh(model, scored);
    return scored;
}

// Fits that do not depend on one another. Out of time only the first ones are made.
CauseSearch::Fits CauseSearch::made_side_by_side(Model& model, std::size_t count,
                                                 const std::function<CauseFit(std::size_t)>& fit,
                                                 std::size_t at_least) {
    std::vector<std::optional<ScoredFit>> made(count);
    parallel_for_each_index(static_cast<int>(count), options_.threads, [&](int index) {
        const auto k = static_cast<std::size_t>(index);
        if (k < at_least || !is_out_of_time()) made[k] = measured(model, fit(k));
    });
    Fits fits;
    for (std::optional<ScoredFit>& each : made) {
        if (!each) continue;
        weigh(model, *each);
        fits.push_back(std::move(*each));
    }
    return fits;
}

}  // namespace capstan::gap
