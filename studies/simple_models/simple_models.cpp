#include "capstan/simple_models/simple_models.h"

#include <cmath>

#include "capstan/simple_models/linear_models.h"

namespace capstan::simple_models {

double scored_rms(const RecordedRun& run, std::size_t output, const std::vector<double>& predicted) {
    double squares = 0.0;
    const std::size_t first = first_scored_sample(run);
    for (std::size_t sample = first; sample < predicted.size(); ++sample)
        squares += std::pow(run.values[output][sample] - predicted[sample], 2);
    return predicted.size() > first ? std::sqrt(squares / static_cast<double>(predicted.size() - first))
                                    : 0.0;
}

double rms_over(const Recording& recording, const SimpleModel& model) {
    double squares = 0.0;
    for (const RecordedRun& run : recording.runs) {
        const auto scored = static_cast<double>(run.time_s.size() - first_scored_sample(run));
        squares += scored * std::pow(scored_rms(run, model.channels.output, model.predict(run)), 2);
    }
    return std::sqrt(squares / static_cast<double>(scored_samples(recording)));
}

std::vector<SimpleModel> fit_simple_models(const Recording& recording, std::size_t output) {
    std::vector<SimpleModel> best;
    if (scored_samples(recording) == 0) return best;
    for (const ModelledOutput& channels : possible_inputs(recording, output)) {
        std::vector<SimpleModel> models = fit_linear_models(recording, channels);
        models.push_back(fit_elastic_plastic(recording, channels));
        if (best.empty()) best = models;
        for (std::size_t k = 0; k < models.size(); ++k)
            if (models[k].fitted_rms < best[k].fitted_rms) best[k] = models[k];
    }
    return best;
}

}  // namespace capstan::simple_models
