#include "capstan/calibration/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/least_squares.h"
#include "capstan/calibration/twin_residuals.h"
#include "capstan/platform/statistics.h"
#include "capstan/platform/work_meter.h"

namespace capstan::gap {

namespace {

constexpr int rounds = 3;  // fits to all runs; the scales of the first come from the nominal model's misfit
// A parameter whose interval reaches twice or half its value counts as not identifiable.
constexpr double min_known_factor = 2.0;
// From this correlation on, two estimates are reported as trading with each other.
constexpr double trading_correlation = 0.95;

// Wherever a search goes, the bench can still be built.
constexpr double max_log = 3.5;

// Logarithms of the fitted parameters over their nominal values, and how they spread.
struct LogFit {
    LeastSquaresFit fit;
    Eigen::MatrixXd covariance;  // fitted x fitted
};

std::vector<double> values_of(const std::vector<TwinParameter>& parameters, const std::vector<int>& fitted,
                              const Eigen::VectorXd& logs) {
    std::vector<double> values;
    for (const TwinParameter& parameter : parameters) values.push_back(parameter.nominal);
    for (std::size_t k = 0; k < fitted.size(); ++k)
        values[static_cast<std::size_t>(fitted[k])] *=
            std::exp(std::clamp(logs[static_cast<Eigen::Index>(k)], -max_log, max_log));
    return values;
}

LogFit fit_logs(const TwinResiduals& residuals, const std::vector<TwinParameter>& parameters,
                const std::vector<int>& fitted, const std::vector<RunPart>& parts,
                const Eigen::VectorXd& start) {
    const auto function = [&](const Eigen::MatrixXd& logs) {
        std::vector<std::vector<double>> sets;
        for (Eigen::Index column = 0; column < logs.cols(); ++column)
            sets.push_back(values_of(parameters, fitted, logs.col(column)));
        const Eigen::MatrixXd measured = residuals.of(parts, sets);
        // A weak prior at the nominal values keeps parameters that the data do not determine from diverging.
        Eigen::MatrixXd all(measured.rows() + logs.rows(), logs.cols());
        all << measured, logs;
        return all;
    };
    LogFit log_fit;
    log_fit.fit = fit_least_squares(function, start);

    const Sandwich sandwich =
        sandwich_of(log_fit.fit.jacobian, log_fit.fit.residuals, residuals.block_ends(parts));
    log_fit.covariance = sandwich.covariance;
    // Never below what independent residuals of unit spread give, however few blocks there are.
    for (Eigen::Index k = 0; k < sandwich.inverse.rows(); ++k) {
        if (log_fit.covariance(k, k) < sandwich.inverse(k, k))
            log_fit.covariance(k, k) = sandwich.inverse(k, k);
    }
    return log_fit;
}

double correlation(const Eigen::MatrixXd& covariance, Eigen::Index a, Eigen::Index b) {
    return covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
}

// Half widths of 95% intervals of the logarithms: the sandwich's, or the jackknife's over runs if larger.
Eigen::VectorXd half_widths(const LogFit& all_runs, const std::vector<LogFit>& without_a_run) {
    std::vector<Eigen::VectorXd> fits;
    for (const LogFit& other : without_a_run) fits.push_back(other.fit.parameters);
    const Eigen::VectorXd widths = two_sided_95 * all_runs.covariance.diagonal().cwiseSqrt();
    return widths.cwiseMax(jackknife_half_widths(fits, widths.size()));
}

std::vector<int> indices_of(const std::vector<TwinParameter>& parameters,
                            const std::vector<std::string>& names) {
    std::vector<int> indices;
    if (names.empty()) {
        indices.resize(parameters.size());
        std::iota(indices.begin(), indices.end(), 0);
        return indices;
    }
    std::vector<std::string> problems;
    for (const std::string& name : names) {
        const auto found =
            std::find_if(parameters.begin(), parameters.end(),
                         [&](const TwinParameter& parameter) { return parameter.name == name; });
        if (found != parameters.end()) {
            const auto index = static_cast<int>(found - parameters.begin());
            if (std::find(indices.begin(), indices.end(), index) != indices.end())
                problems.push_back("'" + name + "' is named twice to be fitted");
            indices.push_back(index);
            continue;
        }
        std::string known;
        for (const TwinParameter& parameter : parameters)
            known += (known.empty() ? "" : ", ") + parameter.name;
        problems.push_back("no parameter '" + name + "' to fit; this bench has " + known);
    }
    if (!problems.empty()) throw InvalidInput(problems);
    std::sort(indices.begin(), indices.end());
    return indices;
}

class Calibrator {
  public:
    Calibrator(const Recording& recording, const CalibrationOptions& options)
        : recording_(recording),
          twin_(make_twin(recording, options.segments)),
          residuals_(recording, *twin_, options.threads),
          fitted_(indices_of(twin_->parameters(), options.fitted)),
          given_start_(options.start) {
        for (const TwinParameter& parameter : twin_->parameters()) {
            ParameterEstimate estimate;
            estimate.parameter = parameter;
            estimate.value = estimate.low = estimate.high = parameter.nominal;
            estimate.fitted = false;
            calibration_.parameters.push_back(estimate);
        }
        for (const int index : fitted_) estimate(index).fitted = true;
    }

    Calibration run() {
        const std::vector<RunPart> all = residuals_.complete_runs();
        const double runs = static_cast<double>(all.size());
        constexpr double usual_iterations = 8.0;
        expected_fits_ = rounds + (runs < 2 ? 0.0 : runs);
        expect_work(expected_fits_ * usual_iterations * static_cast<double>(fitted_.size() + 1) * runs);
        start_ = start_of_search();
        const std::vector<double> nominal = nominal_values(*twin_);
        residuals_.set_scales(nominal);
        LogFit all_runs = fit(all);
        for (int round = 1; round < rounds; ++round) {
            residuals_.set_scales(values_of(twin_->parameters(), fitted_, all_runs.fit.parameters));
            start_ = all_runs.fit.parameters;
            all_runs = fit(all);
        }
        start_ = all_runs.fit.parameters;
        std::vector<LogFit> without = fits_without_a_run();
        while (!fitted_.empty() && drop_least_known(all_runs, half_widths(all_runs, without))) {
            expected_fits_ += 1.0 + (runs < 2 ? 0.0 : runs);
            all_runs = fit(all);
            start_ = all_runs.fit.parameters;
            without = fits_without_a_run();
        }
        take_estimates(all_runs, half_widths(all_runs, without));
        score(nominal, without);
        return std::move(calibration_);
    }

  private:
    ParameterEstimate& estimate(int index) {
        return calibration_.parameters[static_cast<std::size_t>(index)];
    }

    Eigen::VectorXd start_of_search() const {
        Eigen::VectorXd logs = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fitted_.size()));
        for (std::size_t k = 0; k < fitted_.size(); ++k) {
            const TwinParameter& parameter = twin_->parameters()[static_cast<std::size_t>(fitted_[k])];
            const auto given = given_start_.find(parameter.name);
            if (given != given_start_.end())
                logs[static_cast<Eigen::Index>(k)] = std::log(given->second / parameter.nominal);
        }
        return logs;
    }

    LogFit fit(const std::vector<RunPart>& parts) {
        LogFit log_fit = fit_logs(residuals_, twin_->parameters(), fitted_, parts, start_);
        calibration_.evaluations += log_fit.fit.evaluations;
        ++fits_;
        if (MeterScope::meter() != nullptr) MeterScope::meter()->replan(fits_ / expected_fits_);
        return log_fit;
    }

    // Removes the parameter with the widest interval from the fit, if that is too wide.
    bool drop_least_known(const LogFit& all_runs, const Eigen::VectorXd& widths) {
        Eigen::Index worst = 0;
        const double width = widths.maxCoeff(&worst);
        if (width < std::log(min_known_factor)) return false;
        const int index = fitted_[static_cast<std::size_t>(worst)];
        estimate(index).identifiable = false;
        estimate(index).reason = why_unknown(all_runs, worst);
        fitted_.erase(fitted_.begin() + worst);
        start_ = start_of_search();
        return true;
    }

    std::string why_unknown(const LogFit& all_runs, Eigen::Index worst) {
        std::string partner = trading_partner(all_runs, worst);
        if (!partner.empty()) return partner;
        const double alone = two_sided_95 * std::sqrt(all_runs.covariance(worst, worst));
        return alone < std::log(min_known_factor) ? "the runs give different values"
                                                  : "it changes the measured channels too little";
    }

    // The parameter that an estimate moves together with most, if the correlation is almost 1; else empty.
    std::string trading_partner(const LogFit& all_runs, Eigen::Index row) {
        double most = trading_correlation;
        std::string reason;
        for (Eigen::Index other = 0; other < all_runs.covariance.rows(); ++other) {
            const double together = correlation(all_runs.covariance, row, other);
            if (other == row || std::abs(together) < most) continue;
            most = std::abs(together);
            reason = fmt::format("trades with {} (correlation {:.3f})",
                                 estimate(fitted_[static_cast<std::size_t>(other)]).parameter.name, together);
        }
        return reason;
    }

    std::vector<LogFit> fits_without_a_run() {
        std::vector<LogFit> fits;
        if (recording_.runs.size() < 2) return fits;
        for (std::size_t left_out = 0; left_out < recording_.runs.size(); ++left_out) {
            std::vector<RunPart> parts = residuals_.complete_runs();
            parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(left_out));
            fits.push_back(fit(parts));
        }
        return fits;
    }

    void take_estimates(const LogFit& all_runs, const Eigen::VectorXd& widths) {
        calibration_.converged = all_runs.fit.converged;
        for (std::size_t k = 0; k < fitted_.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            ParameterEstimate& found = estimate(fitted_[k]);
            found.value = found.parameter.nominal * std::exp(all_runs.fit.parameters[row]);
            found.low = found.value * std::exp(-widths[row]);
            found.high = found.value * std::exp(widths[row]);
            found.reason = trading_partner(all_runs, row);
        }
    }

    void score(const std::vector<double>& nominal, const std::vector<LogFit>& without) {
        const std::vector<double> values = calibration_.values();
        for (std::size_t run = 0; run < recording_.runs.size(); ++run) {
            const std::vector<double> others =
                without.empty() ? values
                                : values_of(twin_->parameters(), fitted_, without[run].fit.parameters);
            const ChannelErrors before = residuals_.rms(run, nominal);
            const ChannelErrors after = residuals_.rms(run, values);
            const ChannelErrors held_out = residuals_.rms(run, others);
            calibration_.unsolved_steps += after.unsolved_steps;
            for (std::size_t channel = 0; channel < recording_.channels.size(); ++channel) {
                if (!after.rms[channel]) continue;
                const Channel& described = recording_.channels[channel];
                calibration_.channels.push_back({recording_.runs[run].number, described.name, described.unit,
                                                 described.noise_std.value_or(0.0), *before.rms[channel],
                                                 *after.rms[channel], *held_out.rms[channel],
                                                 !without.empty()});
            }
        }
    }

    const Recording& recording_;
    std::unique_ptr<Twin> twin_;
    TwinResiduals residuals_;
    std::vector<int> fitted_;  // indices of the twin's parameters
    std::map<std::string, double> given_start_;
    Eigen::VectorXd start_;  // fitted: logarithms at which a fit starts
    double fits_ = 0.0;
    double expected_fits_ = 1.0;
    Calibration calibration_;
};

}  // namespace

std::vector<double> Calibration::values() const {
    std::vector<double> all;
    for (const ParameterEstimate& estimate : parameters) all.push_back(estimate.value);
    return all;
}

Calibration calibrate(const Recording& recording, const CalibrationOptions& options) {
    return Calibrator(recording, options).run();
}

}  // namespace capstan::gap
