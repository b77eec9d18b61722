#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "capstan/calibration/least_squares.h"
#include "capstan/recording/channel_range.h"
#include "capstan/simple_models/linear_models.h"

namespace capstan::simple_models {

namespace {

constexpr std::size_t elements = 6;
// Every so many samples count in the fit: neighbours say the same.
constexpr std::size_t fitted_stride = 5;

// The model's numbers. Yields and offsets are in units of the output.
struct ElasticPlastic {
    double way = 1.0;  ///< +1: the output grows with the motion
    double yield = 0.0;
    double yield_per_load = 0.0;
    double zero = 0.0;
    double gain = 0.0;
    std::array<double, elements> stiffness{};  // output per motion
    std::array<double, elements> share{};      // of the yield; sums to 1
};

std::vector<double> predicted_by(const ElasticPlastic& model, const ModelledOutput& channels,
                                 const RecordedRun& run) {
    const std::vector<double>& motion = run.values[channels.motion];
    std::vector<double> output(motion.size());
    std::array<double, elements> stretch{};
    std::array<double, elements> yield_per_stiffness{};
    for (std::size_t k = 0; k < elements; ++k) yield_per_stiffness[k] = model.share[k] / model.stiffness[k];
    for (std::size_t sample = 0; sample < motion.size(); ++sample) {
        const double load = channels.load ? run.values[*channels.load][sample] : 0.0;
        const double yield = std::max(model.yield + model.yield_per_load * std::abs(load), 0.0);
        const double moved = sample > 0 ? motion[sample] - motion[sample - 1] : 0.0;
        double friction = 0.0;
        for (std::size_t k = 0; k < elements; ++k) {
            const double limit = yield * yield_per_stiffness[k];
            stretch[k] = std::min(std::max(stretch[k] + moved, -limit), limit);
            friction += model.stiffness[k] * stretch[k];
        }
        output[sample] = model.zero + model.gain * load + model.way * friction;
    }
    return output;
}

// The scales in which the search moves.
struct SearchScales {
    double output = 1.0;  ///< standard deviation of the output
    double load = 1.0;    ///< RMS
    double motion_range = 1.0;
};

SearchScales scales_of(const Recording& recording, const ModelledOutput& channels) {
    double sum = 0.0;
    double squares = 0.0;
    double load_squares = 0.0;
    const auto samples = static_cast<double>(scored_samples(recording));
    for (const RecordedRun& run : recording.runs) {
        for (std::size_t sample = first_scored_sample(run); sample < run.time_s.size(); ++sample) {
            sum += run.values[channels.output][sample] / samples;
            squares += std::pow(run.values[channels.output][sample], 2) / samples;
            if (channels.load) load_squares += std::pow(run.values[*channels.load][sample], 2) / samples;
        }
    }
    const double spread = std::sqrt(std::max(0.0, squares - sum * sum));
    return {spread > 0.0 ? spread : 1.0, load_squares > 0.0 ? std::sqrt(load_squares) : 1.0,
            largest_span(recording, channels.motion)};
}

// Coordinates: yield, zero, logarithms of the stiffnesses and of the shares, then what belongs to the load.
class ElasticPlasticSearch {
  public:
    ElasticPlasticSearch(const Recording& recording, const ModelledOutput& channels)
        : recording_(recording), channels_(channels), scales_(scales_of(recording, channels)) {}

    // `stiffening`: how stiff the elements are compared with the usual start.
    Eigen::VectorXd start(double stiffening) const {
        constexpr double yield = 0.3;  // of the output's standard deviation, and of it at the RMS load
        constexpr std::array stiffness = {200.0, 100.0, 50.0, 25.0, 12.0, 6.0};
        Eigen::VectorXd at = Eigen::VectorXd::Zero(2 + 2 * elements + (channels_.load ? 2 : 0));
        at[0] = yield / unit;
        for (std::size_t k = 0; k < elements; ++k)
            at[static_cast<Eigen::Index>(2 + k)] = std::log(stiffening * stiffness[k]);
        if (channels_.load) at[2 + 2 * elements] = yield / unit;
        return at;
    }

    ElasticPlastic model_at(const Eigen::VectorXd& at, double way) const {
        ElasticPlastic model;
        model.way = way;
        model.yield = unit * scales_.output * at[0];
        model.zero = unit * scales_.output * at[1];
        double sum = 0.0;
        for (std::size_t k = 0; k < elements; ++k) {
            model.stiffness[k] =
                scales_.output / scales_.motion_range * std::exp(at[static_cast<Eigen::Index>(2 + k)]);
            model.share[k] = std::exp(at[static_cast<Eigen::Index>(2 + elements + k)]);
            sum += model.share[k];
        }
        for (double& share : model.share) share /= sum;
        if (channels_.load) {
            model.yield_per_load = unit * scales_.output / scales_.load * at[2 + 2 * elements];
            model.gain = unit * scales_.output / scales_.load * at[3 + 2 * elements];
        }
        return model;
    }

    /// From several starts, each continued as long as that helps: an element whose slider never yields, or
    /// always does, has no gradient, and the search stops beside it.
    gap::LeastSquaresFit fit(double way) const {
        constexpr std::array stiffenings = {0.3, 1.0, 3.0};
        constexpr int continuations = 6;
        constexpr double worthwhile = 0.999;
        gap::LeastSquaresFit best;
        best.sum_of_squares = std::numeric_limits<double>::infinity();
        for (const double stiffening : stiffenings) {
            gap::LeastSquaresFit found = fit_from(start(stiffening), way);
            for (int k = 0; k < continuations; ++k) {
                gap::LeastSquaresFit next = fit_from(found.parameters, way);
                const bool helped = next.sum_of_squares < worthwhile * found.sum_of_squares;
                found = std::move(next);
                if (!helped) break;
            }
            if (found.sum_of_squares < best.sum_of_squares) best = std::move(found);
        }
        return best;
    }

  private:
    gap::LeastSquaresFit fit_from(const Eigen::VectorXd& from, double way) const {
        const auto residuals = [&](const Eigen::MatrixXd& each) {
            Eigen::MatrixXd all;
            for (Eigen::Index column = 0; column < each.cols(); ++column) {
                const Eigen::VectorXd of = residuals_of(model_at(each.col(column), way));
                if (column == 0) all.resize(of.size(), each.cols());
                all.col(column) = of;
            }
            return all;
        };
        return gap::fit_least_squares(residuals, from, {.jacobian_at_end = false});
    }

    // The step of a coordinate of the search, in parts of the output's standard deviation.
    static constexpr double unit = 0.1;

    Eigen::VectorXd residuals_of(const ElasticPlastic& model) const {
        std::vector<double> all;
        for (const RecordedRun& run : recording_.runs) {
            const std::vector<double> predicted = predicted_by(model, channels_, run);
            for (std::size_t sample = first_scored_sample(run); sample < predicted.size();
                 sample += fitted_stride)
                all.push_back((predicted[sample] - run.values[channels_.output][sample]) / scales_.output);
        }
        return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
    }

    const Recording& recording_;
    ModelledOutput channels_;
    SearchScales scales_;
};

}  // namespace

SimpleModel fit_elastic_plastic(const Recording& recording, const ModelledOutput& channels) {
    const ElasticPlasticSearch search(recording, channels);
    double least = std::numeric_limits<double>::infinity();
    ElasticPlastic best;
    Eigen::Index numbers = 0;
    for (const double way : {1.0, -1.0}) {
        const gap::LeastSquaresFit fit = search.fit(way);
        numbers = fit.parameters.size();
        if (fit.sum_of_squares < least) {
            least = fit.sum_of_squares;
            best = search.model_at(fit.parameters, way);
        }
    }
    SimpleModel model;
    model.name = "elastic_plastic";
    model.title = "elastic-plastic elements";
    model.heading = "elastic";
    model.formula =
        "a zero, a gain on the load, and six springs in series with sliders whose yield is linear in "
        "the load";
    model.numbers = static_cast<std::size_t>(numbers);
    model.channels = channels;
    model.predict = [best, channels](const RecordedRun& run) { return predicted_by(best, channels, run); };
    model.fitted_rms = rms_over(recording, model);
    return model;
}

}  // namespace capstan::simple_models
