#include "capstan/gap_trial/visibility.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

double floor_of(const TrialBench& bench, const TrialRun& run, const std::string& channel) {
    if (!bench.floor.empty()) return bench.floor.at(channel);
    const bool locked = run.output == OutputKind::locked;
    if (channel == channel::motor_angle) return locked ? 3e-4 : 1.5e-3;
    if (channel == channel::motor_torque) return 1e-3;
    if (channel != channel::load_torque) return 0.15;
    if (!bench.is_pair()) return 8e-3;
    if (locked) return 4e-3;
    return bench.kind == BenchKind::uniform_tight ? 0.02 : 8e-3;
}

double noise_of(const TrialBench& bench, const std::string& channel) {
    const auto noise = bench.noise_std.find(channel);
    if (noise != bench.noise_std.end()) return noise->second;
    const auto step = bench.encoder_step.find(channel);
    return step == bench.encoder_step.end() ? 0.0 : step->second / std::sqrt(12.0);
}

bool is_driven(const TrialRun& run, const std::string& channel) {
    return std::find(run.driven.begin(), run.driven.end(), channel) != run.driven.end();
}

void round_to_steps(const TrialBench& bench, const TrueEffects& effects, SensedSession& session) {
    const std::vector<std::string> channels = bench.channels();
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        const auto fault = effects.sensors.find(channels[channel]);
        if (fault == effects.sensors.end() || fault->second.step == 0.0) continue;
        for (SensedRun& run : session) {
            for (double& value : run[channel])
                value = fault->second.step * std::round(value / fault->second.step);
        }
    }
}

// Changes of all predicted samples in units of noise and floor, one channel of one run after the other.
struct ScaledChanges {
    Eigen::VectorXd effect;
    Eigen::MatrixXd nominal;  // a column for friction, stiffness and pretension, per `max_move` of each
    std::map<std::string, std::vector<std::pair<Eigen::Index, Eigen::Index>>> rows_of_channel;
    std::map<std::string, double> samples_of_channel;
};

// What a zero of each channel leaves of every change.
void remove_means(ScaledChanges& changes) {
    for (const auto& [channel, rows] : changes.rows_of_channel) {
        const double samples = changes.samples_of_channel.at(channel);
        double effect = 0.0;
        Eigen::RowVectorXd nominal = Eigen::RowVectorXd::Zero(changes.nominal.cols());
        for (const auto& [first, count] : rows) {
            effect += changes.effect.segment(first, count).sum() / samples;
            nominal += changes.nominal.middleRows(first, count).colwise().sum() / samples;
        }
        for (const auto& [first, count] : rows) {
            changes.effect.segment(first, count).array() -= effect;
            changes.nominal.middleRows(first, count).rowwise() -= nominal;
        }
    }
}

ScaledChanges scaled_changes(const TrialBench& bench, const std::vector<TrialRun>& runs,
                             const Baseline& baseline, const SensedSession& with,
                             const NominalFreedom& freedom) {
    const std::vector<std::string> channels = bench.channels();
    ScaledChanges changes;
    Eigen::Index rows = 0;
    const auto for_each_series = [&](const auto& body) {
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            if (!bench.is_pair() && channels[channel] == channel::load_angle) continue;
            for (std::size_t run = 0; run < runs.size(); ++run) {
                if (!is_driven(runs[run], channels[channel])) body(channel, run);
            }
        }
    };
    for_each_series([&](std::size_t channel, std::size_t run) {
        const auto count = static_cast<Eigen::Index>(with[run][channel].size());
        changes.rows_of_channel[channels[channel]].push_back({rows, count});
        changes.samples_of_channel[channels[channel]] += static_cast<double>(count);
        rows += count;
    });
    changes.effect.resize(rows);
    changes.nominal.resize(rows, static_cast<Eigen::Index>(baseline.with_more.size()));
    Eigen::Index row = 0;
    for_each_series([&](std::size_t channel, std::size_t run) {
        const double scale =
            std::hypot(noise_of(bench, channels[channel]), floor_of(bench, runs[run], channels[channel]));
        const std::vector<double>& without = baseline.sensed[run][channel];
        for (std::size_t k = 0; k < without.size(); ++k, ++row) {
            changes.effect(row) = (with[run][channel][k] - without[k]) / scale;
            for (std::size_t n = 0; n < baseline.with_more.size(); ++n)
                changes.nominal(row, static_cast<Eigen::Index>(n)) =
                    (baseline.with_more[n][run][channel][k] - without[k]) / scale *
                    (freedom.max_move_log / Baseline::more_log);
        }
    });
    if (freedom.zeros_float) remove_means(changes);
    return changes;
}

// Least squares with three coordinates between -1 and 1: the best of all choices of which lie on a bound.
Eigen::Vector3d bounded_moves(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
    const Eigen::Matrix3d products = columns.transpose() * columns;
    const Eigen::Vector3d wanted = columns.transpose() * target;
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    double best_gain = 0.0;
    constexpr int choices = 27;
    for (int choice = 0; choice < choices; ++choice) {
        const std::array<int, 3> bound = {choice % 3 - 1, choice / 3 % 3 - 1, choice / 9 - 1};  // 0: free
        Eigen::Matrix3d system = products;
        Eigen::Vector3d right = wanted;
        for (int n = 0; n < 3; ++n) {
            if (bound[static_cast<std::size_t>(n)] == 0) continue;
            system.row(n) = Eigen::RowVector3d::Unit(n);
            right(n) = bound[static_cast<std::size_t>(n)];
        }
        const Eigen::Vector3d moves = system.completeOrthogonalDecomposition().solve(right);
        constexpr double rounding = 1e-9;
        if (moves.cwiseAbs().maxCoeff() > 1.0 + rounding) continue;
        const double gain = 2.0 * wanted.dot(moves) - moves.dot(products * moves);
        if (gain > best_gain) {
            best_gain = gain;
            best = moves;
        }
    }
    return best;
}

}  // namespace

Visibility visibility(const TrialBench& bench, const std::vector<TrialRun>& runs, const Baseline& baseline,
                      const SensedSession& with, const NominalFreedom& freedom) {
    const ScaledChanges changes = scaled_changes(bench, runs, baseline, with, freedom);
    const Eigen::Vector3d moves = bounded_moves(changes.nominal, changes.effect);
    const Eigen::VectorXd left = changes.effect - changes.nominal * moves;
    Visibility best;
    for (const auto& [channel, rows] : changes.rows_of_channel) {
        double squares = 0.0;
        for (const auto& [first, count] : rows) squares += left.segment(first, count).squaredNorm();
        const double ratio = std::sqrt(squares / changes.samples_of_channel.at(channel));
        if (ratio > best.ratio) best = {ratio, channel};
    }
    return best;
}

Baseline make_baseline(const TrialBench& bench, const std::vector<TrialRun>& runs, const TrueEffects& before,
                       const SensedSession& sensed, const LumpedBenchOptions& options) {
    Baseline baseline{sensed, {}};
    for (double TrueEffects::*ratio :
         {&TrueEffects::friction_ratio, &TrueEffects::stiffness_ratio, &TrueEffects::pretension_ratio}) {
        TrueEffects more = before;
        more.*ratio *= std::exp(Baseline::more_log);
        baseline.with_more.push_back(sense_session(bench, run_session(bench, runs, more, options), more));
    }
    return baseline;
}

std::string severity_name(Severity severity) {
    return severity == Severity::mild ? "mild" : "strong";
}

VisibilityRange range_of(Severity severity) {
    return severity == Severity::mild ? VisibilityRange{1.5, 3.0} : VisibilityRange{4.0, 10.0};
}

std::vector<TrueRun> run_session(const TrialBench& bench, const std::vector<TrialRun>& runs,
                                 const TrueEffects& effects, const LumpedBenchOptions& options) {
    std::vector<TrueRun> truth;
    for (const TrialRun& run : runs) truth.push_back(run_lumped_bench(bench, run, effects, options));
    return truth;
}

SensedSession sense_session(const TrialBench& bench, const std::vector<TrueRun>& truth,
                            const TrueEffects& effects) {
    SensedSession session;
    for (const TrueRun& run : truth)
        session.push_back(sense(bench, run, effects.under(run.conditions).sensors));
    return session;
}

std::optional<SizedEffect> find_size(const EffectTrial& trial, const WithheldEffect& effect,
                                     const VisibilityRange& range, double wanted) {
    constexpr int max_tries = 7;
    constexpr double largest_change = 6.0;
    // The sizes closest from below and above so far, where the change is neither linear nor steady.
    double too_small = 0.0;
    double too_large = effect.largest_size;
    double size = effect.first_size;
    for (int attempt = 0; attempt < max_tries; ++attempt) {
        TrueEffects effects = trial.before;
        effect.apply(effects, size);
        SensedSession with = sense_session(
            trial.bench,
            effect.only_sensors ? trial.truth
                                : run_session(trial.bench, trial.runs, effects, trial.simulated),
            effects);
        round_to_steps(trial.bench, effects, with);
        const Visibility seen = visibility(trial.bench, trial.runs, trial.baseline, with, trial.freedom);
        if (!std::isfinite(seen.ratio)) return std::nullopt;
        if (seen.ratio >= range.low && seen.ratio <= range.high) return SizedEffect{size, seen};
        if (seen.ratio < wanted) {
            if (size >= effect.largest_size) return std::nullopt;
            too_small = size;
        } else {
            too_large = size;
        }
        const double change =
            std::clamp(wanted / std::max(seen.ratio, 1e-9), 1.0 / largest_change, largest_change);
        double next = size * change;
        const bool at_the_end = next >= effect.largest_size && too_large == effect.largest_size;
        if (at_the_end) {
            next = effect.largest_size;
        } else if (next <= too_small || next >= too_large) {
            next = 0.5 * (too_small + too_large);
        }
        size = next;
    }
    return std::nullopt;
}

}  // namespace capstan::gap_trial
