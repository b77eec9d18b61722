#include "capstan/sensitivity/advice_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/cable/invalid_input.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/platform/work_meter.h"
#include "capstan/sensitivity/uncertain_parameter.h"

namespace capstan::sensitivity {

namespace {

// Steps from the configured value to each end of a range; a flip that reverts between two steps is missed.
constexpr int scan_steps = 6;
// A flip is found to a 64th of such a step.
constexpr int bisections = 6;

class Analysis {
  public:
    Analysis(const StudyPlan& plan, const SensitivityOptions& options)
        : plan_(plan), options_(options), question_(plan, options.noise_index) {
        for (std::size_t p = 0; p < uncertain_parameters().size(); ++p) {
            if (range_of(p)[0] < range_of(p)[1]) uncertain_.push_back(p);
        }
        if (uncertain_.empty())
            throw InvalidInput({"sensitivity: every range is [1, 1], so nothing is uncertain; widen one"});
    }

    SensitivityAnswer run() {
        answer_.noise = plan_.noise_levels[options_.noise_index].label;
        const auto parameters = static_cast<double>(uncertain_.size());
        expect_work(plan_.sensitivity.trajectories * (parameters + 1.0) + (2 * scan_steps + 1) * parameters +
                    bisections * parameters);
        const auto nominal = [&] {
            const MeterScope uncounted(nullptr);
            return question_.ask(as_configured(), nullptr);
        }();
        ++answer_.evaluations;
        answer_.advice = nominal->best;
        answer_.error = nominal->best_error;
        for (const std::size_t p : uncertain_) {
            const UncertainParameter& parameter = uncertain_parameters()[p];
            ParameterSensitivity& row = answer_.parameters.emplace_back();
            row.name = parameter.name;
            row.title = parameter.title;
            row.unit = parameter.unit;
            row.value = parameter.value(plan_, options_.noise_index);
            row.range = range_of(p);
        }
        screen();
        scan();
        bisect();
        return std::move(answer_);
    }

  private:
    using Ratios = std::vector<double>;
    using Answers = std::vector<std::optional<AdviceThere>>;

    std::vector<double> range_of(std::size_t p) const {
        return uncertain_parameters()[p].range(plan_.sensitivity);
    }
    Ratios as_configured() const { return Ratios(uncertain_parameters().size(), 1.0); }
    Ratios with(std::size_t k, double ratio) const {
        Ratios ratios = as_configured();
        ratios[uncertain_[k]] = ratio;
        return ratios;
    }

    // Each evaluation runs on one thread and fills its own slot.
    Answers ask_all(const std::vector<Ratios>& all) {
        Answers answers(all.size());
        parallel_for_each_index(static_cast<int>(all.size()), options_.jobs, [&](int k) {
            {
                const MeterScope uncounted(nullptr);
                answers[k] = question_.ask(all[k], &answer_.advice);
            }
            note_work();
        });
        answer_.evaluations += static_cast<int>(all.size());
        return answers;
    }

    bool has_changed(const std::optional<AdviceThere>& there) const {
        return there && there->regret.value_N > plan_.sensitivity.tolerance_N;
    }

    // Factors are spread evenly on a logarithmic scale.
    Ratios inside(const std::vector<double>& unit) const {
        Ratios ratios = as_configured();
        for (std::size_t k = 0; k < uncertain_.size(); ++k) {
            const auto range = range_of(uncertain_[k]);
            ratios[uncertain_[k]] = range[0] * std::pow(range[1] / range[0], unit[k]);
        }
        return ratios;
    }

    void screen() {
        const MorrisDesign design =
            morris_design(plan_.sensitivity.trajectories, static_cast<int>(uncertain_.size()), plan_.seed);
        std::vector<Ratios> all;
        for (const auto& walk : design.points) {
            for (const auto& point : walk) all.push_back(inside(point));
        }
        const Answers answers = ask_all(all);
        const double nowhere = std::numeric_limits<double>::quiet_NaN();
        std::vector<std::vector<double>> regret_N;
        std::vector<std::vector<double>> error_N;
        for (std::size_t at = 0; at < answers.size(); ++at) {
            if (at % (uncertain_.size() + 1) == 0) {
                regret_N.emplace_back();
                error_N.emplace_back();
            }
            const auto& there = answers[at];
            regret_N.back().push_back(there ? there->regret.value_N : nowhere);
            error_N.back().push_back(there ? there->best_error.value_N : nowhere);
            answer_.changed += has_changed(there);
            answer_.never += !there;
            if (there) answer_.largest_regret_N = std::max(answer_.largest_regret_N, there->regret.value_N);
        }
        answer_.screened = static_cast<int>(answers.size());
        const auto on_regret = elementary_effects(design, regret_N);
        const auto on_error = elementary_effects(design, error_N);
        for (std::size_t k = 0; k < uncertain_.size(); ++k) {
            answer_.parameters[k].on_regret = on_regret[k];
            answer_.parameters[k].on_error = on_error[k];
        }
    }

    void scan() {
        std::vector<Ratios> all;
        for (std::size_t k = 0; k < uncertain_.size(); ++k) {
            const auto range = range_of(uncertain_[k]);
            for (int step = -scan_steps; step <= scan_steps; ++step) {
                const double end = step < 0 ? range[0] : range[1];
                if (end == 1.0 && step != 0) continue;
                const double ratio = std::pow(end, std::abs(step) / static_cast<double>(scan_steps));
                all.push_back(with(k, ratio));
                answer_.parameters[k].scan.push_back({ratio, std::nullopt});
            }
        }
        const Answers answers = ask_all(all);
        std::size_t at = 0;
        for (ParameterSensitivity& parameter : answer_.parameters) {
            for (ScanPoint& point : parameter.scan) point.there = answers[at++];
        }
    }

    // A search between the last value that holds and the first that does not.
    struct Search {
        std::size_t parameter = 0;
        std::optional<Flip>* flip = nullptr;
    };

    std::vector<Search> searches() {
        std::vector<Search> all;
        for (std::size_t k = 0; k < answer_.parameters.size(); ++k) {
            ParameterSensitivity& parameter = answer_.parameters[k];
            const auto& scan = parameter.scan;
            const auto middle = std::find_if(scan.begin(), scan.end(),
                                             [](const ScanPoint& point) { return point.ratio == 1.0; });
            double held = 1.0;
            for (auto point = middle; point != scan.end(); ++point) {
                if (has_changed(point->there)) {
                    parameter.flip_above = Flip{point->ratio, held, *point->there};
                    all.push_back({k, &parameter.flip_above});
                    break;
                }
                held = point->ratio;
            }
            held = 1.0;
            for (auto point = std::make_reverse_iterator(middle); point != scan.rend(); ++point) {
                if (has_changed(point->there)) {
                    parameter.flip_below = Flip{point->ratio, held, *point->there};
                    all.push_back({k, &parameter.flip_below});
                    break;
                }
                held = point->ratio;
            }
        }
        return all;
    }

    void bisect() {
        const std::vector<Search> open = searches();
        for (int round = 0; round < bisections && !open.empty(); ++round) {
            std::vector<Ratios> all;
            for (const Search& search : open)
                all.push_back(
                    with(search.parameter, std::sqrt((*search.flip)->ratio * (*search.flip)->held_ratio)));
            const Answers answers = ask_all(all);
            for (std::size_t k = 0; k < open.size(); ++k) {
                Flip& flip = **open[k].flip;
                const double ratio = all[k][uncertain_[open[k].parameter]];
                if (has_changed(answers[k])) {
                    flip.ratio = ratio;
                    flip.there = *answers[k];
                } else {
                    flip.held_ratio = ratio;
                }
            }
        }
    }

    const StudyPlan& plan_;
    const SensitivityOptions& options_;
    AdviceQuestion question_;
    std::vector<std::size_t> uncertain_;  // numbers in uncertain_parameters()
    SensitivityAnswer answer_;
};

}  // namespace

SensitivityAnswer advice_sensitivity(const StudyPlan& plan, const SensitivityOptions& options) {
    return Analysis(plan, options).run();
}

}  // namespace capstan::sensitivity
