#include "capstan/gap/diagnosis.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "capstan/gap/cause_fit.h"

namespace capstan::gap {

namespace {

// How many causes the quick look leaves for a full fit.
constexpr std::size_t most_fitted = 8;
constexpr std::size_t most_pairs = 3;
// Mean square residuals below this are as good as one: the floor is not known better.
constexpr double as_good_as_noise = 1.06;
// What goes on below that still tells two causes apart, but counts for less.
constexpr double below_noise_weight = 0.2;
// A cause nobody has thought of is granted to leave this share of the gap.
constexpr double share_left_by_unknown = 0.12;
// Only what a single cause leaves above this is looked at for a second.
constexpr double worth_a_second_cause = 1.15;
// A second cause must raise the evidence by this much, and explain this share of the gap.
constexpr double second_cause_evidence = 12.0;
constexpr double second_cause_share = 0.05;

struct Screened {
    const CandidateCause* cause = nullptr;
    Eigen::VectorXd start;
    double sum_of_squares = 0.0;
};

struct Scored {
    CauseFit fit;
    double evidence = 0.0;
};

// Least squares of `target` on the columns of `directions`: what is left. The last direction may be a
// cause's, which cannot be there less than not at all: against it, it explains nothing.
double left_after(const Eigen::VectorXd& target, const Eigen::MatrixXd& directions, bool last_is_a_cause) {
    const Eigen::MatrixXd normal = directions.transpose() * directions;
    const Eigen::VectorXd weights =
        (normal + 1e-9 * normal.trace() * Eigen::MatrixXd::Identity(normal.rows(), normal.cols()))
            .ldlt()
            .solve(-directions.transpose() * target);
    if (last_is_a_cause && weights[weights.size() - 1] < 0.0)
        return left_after(target, directions.leftCols(directions.cols() - 1), false);
    return (target + directions * weights).squaredNorm();
}

// Residual energy of the nominal model beyond noise, in units of noise.
struct GapEnergy {
    int run = 0;
    std::string channel;
    double energy = 0.0;
};

std::vector<GapShare> gap_map(const std::vector<GapEnergy>& energies) {
    double sum = 0.0;
    std::map<int, double> by_run;
    std::map<std::string, double> by_channel;
    for (const GapEnergy& each : energies) {
        sum += each.energy;
        by_run[each.run] += each.energy;
        by_channel[each.channel] += each.energy;
    }
    std::vector<GapShare> map;
    if (sum == 0.0) return map;
    for (const auto& [run, energy] : by_run) map.push_back({"run", std::to_string(run), energy / sum});
    for (const auto& [channel, energy] : by_channel) map.push_back({"channel", channel, energy / sum});
    return map;
}

class Diagnoser {
  public:
    Diagnoser(const Recording& recording, const DiagnosisOptions& options)
        : recording_(recording),
          options_(options),
          fitter_(recording, {options.segments, options.stride}, options.threads),
          causes_(candidate_causes(recording)) {}

    Diagnosis run() {
        fit_nominal();
        const std::vector<Screened> screened = screen({}, nominal_);
        std::vector<Scored> singles = {none_};
        fit_best(screened, {}, singles);
        sort_by_evidence(singles);
        std::vector<Scored> pairs = pairs_with(singles.front());
        return verdict(singles, pairs);
    }

  private:
    void tell(const std::string& doing, double done) { options_.on_progress(doing, done); }

    double data_sum(const CauseFit& fit) const {
        return fit.residuals.head(static_cast<Eigen::Index>(fitter_.data_rows())).squaredNorm();
    }
    double misfit(const CauseFit& fit) const {
        return fit.sum_of_squares / static_cast<double>(fitter_.data_rows());
    }

    double evidence_of(double mean_square, std::size_t open_numbers) const {
        const double samples = fitter_.independent_samples();
        return -0.5 * samples *
                   (std::log(std::max(mean_square, as_good_as_noise)) +
                    below_noise_weight * std::log(mean_square)) -
               0.5 * static_cast<double>(open_numbers) * std::log(samples);
    }

    std::size_t open_numbers(const CauseFit& fit) const {
        std::size_t count = 0;
        for (const CandidateCause* cause : fit.causes) {
            count += cause->numbers.size();
            for (const double std : {cause->friction_std, cause->stiffness_std, cause->pretension_std})
                count += std > nominal_log_std ? 1 : 0;
        }
        return count;
    }

    Scored scored(CauseFit fit) {
        evaluations_ += fit.evaluations;
        const double evidence = evidence_of(misfit(fit), open_numbers(fit));
        return {std::move(fit), evidence};
    }

    void fit_nominal() {
        tell("nominal model", 0.0);
        nominal_.causes = {&causes_.front()};
        nominal_.coordinates = Eigen::VectorXd::Zero(nominal_coordinates);
        nominal_.residuals = fitter_.residuals(nominal_.causes, nominal_.coordinates).col(0);
        nominal_.sum_of_squares = nominal_.residuals.squaredNorm();
        none_ = scored(fitter_.fit({&causes_.front()}, Eigen::VectorXd::Zero(nominal_coordinates),
                                   {Eigen::VectorXd(0)}));
    }

    // What each cause could explain on top of a fit, by the direction in which it moves the residuals, the
    // fit's own numbers free to follow.
    std::vector<Screened> screen(const std::vector<const CandidateCause*>& present, const CauseFit& fit) {
        // The nominal numbers and those of the causes already there, with their priors.
        constexpr double step = 0.02;
        const Eigen::Index known = fit.coordinates.size();
        const Eigen::Index rows = static_cast<Eigen::Index>(fitter_.data_rows()) + known;
        const Eigen::VectorXd here = fit.residuals.head(rows);
        Eigen::MatrixXd moved = fit.coordinates.replicate(1, known);
        moved.diagonal().array() += step;
        Eigen::MatrixXd directions(rows, known + 1);
        directions.leftCols(known) =
            (fitter_.residuals(fit.causes, moved).topRows(rows).colwise() - here) / step;
        evaluations_ += static_cast<int>(known);

        std::vector<Screened> all;
        for (std::size_t index = 1; index < causes_.size(); ++index) {
            tell("looking for " + causes_[index].effect, progress(index));
            const CandidateCause* cause = &causes_[index];
            if (std::find(present.begin(), present.end(), cause) != present.end()) continue;
            std::vector<const CandidateCause*> together = present;
            together.push_back(cause);
            Screened best{cause, {}, here.squaredNorm()};
            const std::vector<Eigen::VectorXd> starts = start_grid(*cause);
            Eigen::MatrixXd grid(known + starts.front().size(), static_cast<Eigen::Index>(starts.size()));
            for (std::size_t k = 0; k < starts.size(); ++k)
                grid.col(static_cast<Eigen::Index>(k)) << fit.coordinates, starts[k];
            best.start = starts.front();
            if (starts.front().size() ==
                0) {  // a nominal number that may go far: its direction is there already
                best.sum_of_squares = left_after(here, directions.leftCols(known), false);
                all.push_back(best);
                continue;
            }
            const Eigen::MatrixXd there = fitter_.residuals(together, grid).topRows(rows);
            evaluations_ += static_cast<int>(starts.size());
            for (std::size_t k = 0; k < starts.size(); ++k) {
                directions.col(known) = there.col(static_cast<Eigen::Index>(k)) - here;
                const double left = std::min(
                    left_after(here, directions, true),
                    left_after(there.col(static_cast<Eigen::Index>(k)), directions.leftCols(known), false));
                if (left < best.sum_of_squares) best = {cause, starts[k], left};
            }
            all.push_back(best);
        }
        std::stable_sort(all.begin(), all.end(), [](const Screened& a, const Screened& b) {
            return a.sum_of_squares < b.sum_of_squares;
        });
        return all;
    }

    double progress(std::size_t index) const {
        return 0.3 * static_cast<double>(index) / static_cast<double>(causes_.size());
    }

    // Full fits of the most promising.
    void fit_best(const std::vector<Screened>& screened, const std::vector<const CandidateCause*>& present,
                  std::vector<Scored>& fits) {
        std::size_t fitted = 0;
        for (const Screened& each : screened) {
            // A wrong nominal number is always worth a fit: the quick look lets every cause have it on top.
            const bool nominal_number = each.cause->numbers.empty();
            if (fitted == most_fitted && !nominal_number) continue;
            if (!nominal_number) ++fitted;
            tell("fitting " + each.cause->effect + " " + each.cause->variant,
                 0.3 + 0.4 * static_cast<double>(fitted) / most_fitted);
            std::vector<const CandidateCause*> together = present;
            together.push_back(each.cause);
            fits.push_back(scored(fitter_.fit(together, nominal_.coordinates, {each.start})));
        }
    }

    static void sort_by_evidence(std::vector<Scored>& fits) {
        std::stable_sort(fits.begin(), fits.end(),
                         [](const Scored& a, const Scored& b) { return a.evidence > b.evidence; });
    }

    // The best single cause with each of the most promising others.
    std::vector<Scored> pairs_with(const Scored& best) {
        std::vector<Scored> pairs;
        const CandidateCause* first = best.fit.causes.front();
        if (first == &causes_.front() || misfit(best.fit) < worth_a_second_cause) return pairs;
        const std::vector<Screened> screened = screen({first}, best.fit);
        for (const Screened& each : screened) {
            if (pairs.size() == most_pairs) break;
            if (each.cause->effect == first->effect) continue;
            tell("fitting " + first->effect + " with " + each.cause->effect,
                 0.7 + 0.06 * static_cast<double>(pairs.size()));
            pairs.push_back(scored(fitter_.fit({first, each.cause}, best.fit.coordinates, {each.start})));
        }
        sort_by_evidence(pairs);
        return pairs;
    }

    Diagnosis verdict(const std::vector<Scored>& singles, const std::vector<Scored>& pairs) {
        Diagnosis diagnosis;
        const Scored& best = singles.front();
        const double nominal_misfit = misfit(nominal_);
        const bool two =
            !pairs.empty() && pairs.front().evidence > best.evidence + second_cause_evidence &&
            misfit(best.fit) - misfit(pairs.front().fit) > second_cause_share * (nominal_misfit - 1.0);
        const Scored& leading = two ? pairs.front() : best;
        const double left = 1.0 + share_left_by_unknown * std::max(0.0, nominal_misfit - 1.0);
        const double unknown = evidence_of(left, 4);
        rank(diagnosis, singles, leading, unknown, two);
        describe(diagnosis, leading);
        diagnosis.evaluations = evaluations_;
        return diagnosis;
    }

    void rank(Diagnosis& diagnosis, const std::vector<Scored>& singles, const Scored& leading, double unknown,
              bool two) const {
        std::map<std::string, double> evidence = {{"unknown", unknown}};
        const auto raise = [&](const std::string& effect, double value) {
            const auto [known, added] = evidence.emplace(effect, value);
            if (!added) known->second = std::max(known->second, value);
        };
        for (const Scored& each : singles) raise(each.fit.causes.front()->effect, each.evidence);
        if (two) {
            for (const CandidateCause* cause : leading.fit.causes) raise(cause->effect, leading.evidence);
        }
        for (const CandidateCause& cause : causes_) raise(cause.effect, leading.evidence - 60.0);
        double most = unknown;
        for (const auto& [effect, value] : evidence) most = std::max(most, value);
        double sum = 0.0;
        for (const auto& [effect, value] : evidence) sum += std::exp(value - most);
        for (const auto& [effect, value] : evidence)
            diagnosis.ranked.push_back({effect, std::exp(value - most) / sum});
        std::stable_sort(
            diagnosis.ranked.begin(), diagnosis.ranked.end(),
            [](const RankedEffect& a, const RankedEffect& b) { return a.probability > b.probability; });
    }

    void describe(Diagnosis& diagnosis, const Scored& leading) {
        const CauseFit& fit = leading.fit;
        const BenchNumbers numbers = CauseFitter::numbers(fit.causes, fit.coordinates);
        diagnosis.friction_ratio = numbers.friction_ratio;
        diagnosis.stiffness_ratio = numbers.stiffness_ratio;
        diagnosis.pretension_ratio = numbers.pretension_ratio;
        diagnosis.misfit_before = misfit(nominal_);
        diagnosis.misfit_after = misfit(fit);
        Eigen::Index next = nominal_coordinates;
        for (const CandidateCause* cause : fit.causes) {
            if (cause->effect == "none") continue;
            FittedCause fitted{cause->effect, cause->variant, cause->component, cause->end, {}, {}};
            for (const OpenNumber& number : cause->numbers) {
                fitted.numbers.push_back({number.name, number.unit, number.value(fit.coordinates[next++])});
                if (number.kind == OpenNumber::Kind::place) fitted.position_m = fitted.numbers.back().value;
            }
            diagnosis.causes.push_back(fitted);
        }
        if (!diagnosis.causes.empty()) {
            diagnosis.component = diagnosis.causes.front().component;
            diagnosis.end = diagnosis.causes.front().end;
            diagnosis.position_m = diagnosis.causes.front().position_m;
        }
        measure_gap(diagnosis, numbers, fit);
    }

    // Before and after with every sample, nominal numbers before as the sidecar says.
    void measure_gap(Diagnosis& diagnosis, const BenchNumbers& numbers, const CauseFit& leading) {
        std::vector<GapEnergy> energies;
        const EffectsTwin twin(recording_, {options_.segments, 1});
        struct Sum {
            double before = 0.0;
            double after = 0.0;
            double held_out = 0.0;
            double samples = 0.0;
        };
        std::vector<Sum> sums(recording_.channels.size());
        double worst = -1.0;
        for (std::size_t run = 0; run < recording_.runs.size(); ++run) {
            const TwinRun before = twin.run(run, {});
            const TwinRun after = twin.run(run, numbers);
            const TwinRun held_out = twin.run(run, numbers_without(run, leading));
            for (std::size_t channel = 0; channel < sums.size(); ++channel) {
                if (before.values[channel].empty()) continue;
                Sum here;
                for (std::size_t sample = 0; sample < before.values[channel].size(); ++sample) {
                    const double measured = recording_.runs[run].values[channel][sample];
                    here.before += std::pow(measured - before.values[channel][sample], 2);
                    here.after += std::pow(measured - after.values[channel][sample], 2);
                    here.held_out += std::pow(measured - held_out.values[channel][sample], 2);
                    here.samples += 1.0;
                }
                const double noise = sample_noise(recording_.channels[channel]);
                const double ratio = std::sqrt(here.before / here.samples) / (noise > 0.0 ? noise : 1.0);
                if (ratio > worst) {
                    worst = ratio;
                    diagnosis.worst_run = recording_.runs[run].number;
                    diagnosis.worst_channel = recording_.channels[channel].name;
                }
                sums[channel].before += here.before;
                sums[channel].after += here.after;
                sums[channel].held_out += here.held_out;
                energies.push_back(
                    {recording_.runs[run].number, recording_.channels[channel].name,
                     std::max(0.0, here.before / (noise > 0.0 ? noise * noise : 1.0) - here.samples)});
                sums[channel].samples += here.samples;
            }
        }
        for (std::size_t channel = 0; channel < sums.size(); ++channel) {
            if (sums[channel].samples == 0.0) continue;
            const Channel& described = recording_.channels[channel];
            diagnosis.channels.push_back({described.name, described.unit, sample_noise(described),
                                          std::sqrt(sums[channel].before / sums[channel].samples),
                                          std::sqrt(sums[channel].after / sums[channel].samples),
                                          std::sqrt(sums[channel].held_out / sums[channel].samples)});
        }
        diagnosis.map = gap_map(energies);
    }

    // The bench as fitted without one run; with one run only there is nothing to fit to.
    BenchNumbers numbers_without(std::size_t run, const CauseFit& leading) {
        tell("holding out run " + std::to_string(recording_.runs[run].number), 0.95);
        if (recording_.runs.size() < 2) return CauseFitter::numbers(leading.causes, leading.coordinates);
        const Eigen::VectorXd own =
            leading.coordinates.tail(leading.coordinates.size() - nominal_coordinates);
        const CauseFit fit =
            fitter_.fit(leading.causes, leading.coordinates.head(nominal_coordinates), {own}, run);
        evaluations_ += fit.evaluations;
        return CauseFitter::numbers(fit.causes, fit.coordinates);
    }

    const Recording& recording_;
    DiagnosisOptions options_;
    CauseFitter fitter_;
    std::vector<CandidateCause> causes_;
    Scored none_;
    CauseFit nominal_;  // nothing fitted: where searches start, for the nominal fit may have gone astray
    int evaluations_ = 0;
};

}  // namespace

Diagnosis diagnose(const Recording& recording, const DiagnosisOptions& options) {
    return Diagnoser(recording, options).run();
}

}  // namespace capstan::gap
