#include "capstan/simple_models/linear_models.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "capstan/recording/channel_range.h"
#include "capstan/simple_models/stop_operator.h"

namespace capstan::simple_models {

namespace {

// Keeps columns that are nearly the same from cancelling each other with huge weights; times the number of
// samples, for columns of unit mean square.
constexpr double ridge = 1e-5;
constexpr double no_column = 1e-12;

// Columns of a run from its motion and load; a column of ones is added to them.
using Features = std::function<Eigen::MatrixXd(const RecordedRun&)>;

Eigen::VectorXd column(const std::vector<double>& samples) {
    return Eigen::Map<const Eigen::VectorXd>(samples.data(), static_cast<Eigen::Index>(samples.size()));
}

// Columns side by side, and each times the load.
class FeatureColumns {
  public:
    FeatureColumns(const RecordedRun& run, const ModelledOutput& channels)
        : motion_(run.values[channels.motion]), columns_(static_cast<Eigen::Index>(run.time_s.size()), 0) {
        if (channels.load) load_ = column(run.values[*channels.load]);
    }

    void motion() { add(column(motion_)); }
    void load() {
        if (load_.size() > 0) add(load_);
    }
    void stop(double limit) {
        const Eigen::VectorXd turned = stop_operator(motion_, limit);
        add(turned);
        if (load_.size() > 0) add(turned.cwiseProduct(load_));
    }
    Eigen::MatrixXd take() {
        add(Eigen::VectorXd::Ones(columns_.rows()));
        return std::move(columns_);
    }

  private:
    void add(const Eigen::VectorXd& values) {
        columns_.conservativeResize(Eigen::NoChange, columns_.cols() + 1);
        columns_.rightCols(1) = values;
    }

    const std::vector<double>& motion_;
    Eigen::VectorXd load_;     // samples; empty without a load
    Eigen::MatrixXd columns_;  // samples x columns
};

SimpleModel ridge_fit(const Recording& recording, const ModelledOutput& channels, const Features& features) {
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;
    for (const RecordedRun& run : recording.runs) {
        const auto first = static_cast<Eigen::Index>(first_scored_sample(run));
        const Eigen::MatrixXd all = features(run);
        const Eigen::MatrixXd scored = all.bottomRows(all.rows() - first);
        if (normal.size() == 0) {
            normal = Eigen::MatrixXd::Zero(all.cols(), all.cols());
            right = Eigen::VectorXd::Zero(all.cols());
        }
        normal += scored.transpose() * scored;
        right += scored.transpose() * column(run.values[channels.output]).tail(scored.rows());
    }
    const auto samples = static_cast<double>(scored_samples(recording));
    const Eigen::VectorXd scale = (normal.diagonal() / samples).cwiseSqrt().array() + no_column;
    const Eigen::VectorXd inverse = scale.cwiseInverse();
    Eigen::MatrixXd scaled = inverse.asDiagonal() * normal * inverse.asDiagonal();
    scaled.diagonal().array() += ridge * samples;
    const Eigen::VectorXd weights =
        inverse.cwiseProduct(scaled.ldlt().solve(inverse.cwiseProduct(right)).eval());
    SimpleModel model;
    model.numbers = static_cast<std::size_t>(weights.size());
    model.channels = channels;
    model.predict = [features, weights](const RecordedRun& run) {
        const Eigen::VectorXd predicted = features(run) * weights;
        return std::vector<double>(predicted.begin(), predicted.end());
    };
    model.fitted_rms = rms_over(recording, model);
    return model;
}

// How a model is called.
struct ModelWords {
    const char* name;
    const char* title;
    const char* heading;
    const char* formula;
};

SimpleModel named(SimpleModel model, const ModelWords& words) {
    model.name = words.name;
    model.title = words.title;
    model.heading = words.heading;
    model.formula = words.formula;
    return model;
}

// The mean of the scored samples, without a ridge.
SimpleModel constant_model(const Recording& recording, const ModelledOutput& channels) {
    double sum = 0.0;
    for (const RecordedRun& run : recording.runs)
        for (std::size_t sample = first_scored_sample(run); sample < run.time_s.size(); ++sample)
            sum += run.values[channels.output][sample];
    const double mean = sum / static_cast<double>(scored_samples(recording));
    SimpleModel model;
    model.numbers = 1;
    model.channels = channels;
    model.predict = [mean](const RecordedRun& run) { return std::vector<double>(run.time_s.size(), mean); };
    model.fitted_rms = rms_over(recording, model);
    return model;
}

}  // namespace

Eigen::VectorXd stop_operator(std::span<const double> motion, double limit) {
    Eigen::VectorXd held(static_cast<Eigen::Index>(motion.size()));
    double at = 0.0;
    for (std::size_t sample = 0; sample < motion.size(); ++sample) {
        if (sample > 0) at += motion[sample] - motion[sample - 1];
        at = std::clamp(at, -limit, limit);
        held[static_cast<Eigen::Index>(sample)] = at / limit;
    }
    return held;
}

std::size_t scored_samples(const Recording& recording) {
    std::size_t samples = 0;
    for (const RecordedRun& run : recording.runs) samples += run.time_s.size() - first_scored_sample(run);
    return samples;
}

std::vector<SimpleModel> fit_linear_models(const Recording& recording, const ModelledOutput& channels) {
    const double range = largest_span(recording, channels.motion);
    const auto linear = [=](const RecordedRun& run) {
        FeatureColumns columns(run, channels);
        columns.load();
        columns.motion();
        return columns.take();
    };
    const auto closed_form = [=](double limit) {
        return [=](const RecordedRun& run) {
            FeatureColumns columns(run, channels);
            columns.load();
            columns.stop(limit);
            return columns.take();
        };
    };
    const auto prandtl_ishlinskii = [=](const RecordedRun& run) {
        FeatureColumns columns(run, channels);
        columns.load();
        columns.motion();
        for (const double threshold : stop_thresholds) columns.stop(threshold * range);
        return columns.take();
    };
    SimpleModel best;
    for (const double threshold : stop_thresholds) {
        SimpleModel tried = ridge_fit(recording, channels, closed_form(threshold * range));
        ++tried.numbers;  // the threshold
        if (!best.predict || tried.fitted_rms < best.fitted_rms) best = std::move(tried);
    }
    return {named(constant_model(recording, channels), {"constant", "constant", "constant", "the mean"}),
            named(ridge_fit(recording, channels, linear),
                  {"linear", "linear", "linear", "linear in the motion and the load"}),
            named(std::move(best), {"closed_form", "closed form", "closed",
                                    "a zero, a gain on the load, and friction that grows linearly with the "
                                    "load, built up linearly within a path after each reversal"}),
            named(ridge_fit(recording, channels, prandtl_ishlinskii),
                  {"prandtl_ishlinskii",
                   channels.load ? "Prandtl-Ishlinskii times load" : "Prandtl-Ishlinskii", "Prandtl",
                   "linear in the motion, the load, and nine stop operators with and without the load"})};
}

}  // namespace capstan::simple_models
