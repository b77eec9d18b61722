#include "capstan/estimation/recursive_estimator.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/recursive_sums.h"
#include "capstan/estimation/stratified_scores.h"
#include "capstan/sensing/random_stream.h"

namespace capstan {

namespace {

std::array<double, 2> uniforms(std::uint64_t seed, std::uint32_t step, std::uint32_t which) {
    const auto normals = standard_normals({seed, RandomPurpose::member_motion, 0, step, which});
    const auto fraction = [](double normal) { return 0.5 * std::erfc(-normal / std::numbers::sqrt2); };
    return {fraction(normals[0]), fraction(normals[1])};
}

bool is_slack(const CableState& state) {
    return state.last_motion.kind == MotionKind::slack;
}

// No tension is negative (nor a negative zero) and not all are zero: read off the bits, many at a time.
bool pulls_everywhere(const std::vector<double>& tension_N) {
    std::uint64_t any = 0;
    for (const double node_N : tension_N) any |= std::bit_cast<std::uint64_t>(node_N);
    return any != 0 && any >> 63 == 0;
}

std::vector<std::string> problems_of(const QuasiStaticStep& model, const CableState& start,
                                     const RecursiveSettings& settings) {
    std::vector<std::string> problems;
    const int members = settings.members;
    if (members < 8 || members > 1024 || (members & (members - 1)) != 0) {
        problems.push_back("recursive estimator: " + std::to_string(members) +
                           " members; take a power of two from 8 to 1024");
    }
    for (const double wander_m : {settings.wander.proximal_m, settings.wander.distal_m}) {
        if (!(wander_m >= 0.0) || !std::isfinite(wander_m)) {
            problems.push_back("recursive estimator: an end's wander is " + std::to_string(wander_m) +
                               " m; it must be a finite number, at least 0");
        }
    }
    if (settings.rate_friction.is_active() &&
        !(settings.interval_s > 0.0 && std::isfinite(settings.interval_s)))
        problems.push_back(
            "recursive estimator: friction that depends on speed needs the time between samples; "
            "give interval_s above 0");
    const auto nodes = static_cast<std::size_t>(model.cable().nodes());
    if (start.tension_N.size() != nodes || start.displacement_m.size() != nodes) {
        problems.push_back("recursive estimator: the start has " + std::to_string(start.tension_N.size()) +
                           " nodes, the model " + std::to_string(nodes) + "; cut both alike");
    }
    return problems;
}

}  // namespace

RecursiveEstimator::RecursiveEstimator(const QuasiStaticStep& model, const CableState& start,
                                       const RecursiveSettings& settings)
    : model_(model), settings_(settings) {
    std::vector<std::string> problems = problems_of(model, start, settings);
    if (!problems.empty()) throw InvalidInput(std::move(problems));
    const auto members = static_cast<std::size_t>(settings.members);
    known_ = {start.displacement_m.front(), start.displacement_m.back()};
    normal_scores_ = normal_scores(settings.members);
    members_.assign(members, start);
    rows_N_.assign(members, nullptr);
    rows_m_ = rows_N_;
    sensed_N_.assign(members, 0.0);
    pull_N_ = sensed_N_;
    mean_N_ = start.tension_N;
    deviation_N_.assign(start.tension_N.size(), 0.0);
    gain_ = deviation_N_;
    gain_m_per_N_ = deviation_N_;
    if (!settings.rate_friction.is_active()) return;
    const Cable& cable = model.cable();
    sliding_ = Sliding{model,
                       {settings.rate_friction, cable.relative_length(), cable.mean_segment_length_m(),
                        settings.interval_s, 1},
                       model.tables().sliding_exponent,
                       model.tables().sliding_exponent,
                       members_};
    sliding_->model.set_sliding_exponents(sliding_->exponent);
}

RecursiveReport RecursiveEstimator::step(const KnownEnds& ends, std::span<const TensionReading> readings) {
    bool finite = std::isfinite(ends.proximal_displacement_m) && std::isfinite(ends.distal_displacement_m);
    for (const TensionReading& reading : readings) finite = finite && std::isfinite(reading.value_N);
    if (!finite) throw InvalidInput({"recursive estimator: an input of this step is not a finite number"});
    for (const TensionReading& reading : readings) {
        if (reading.spot.node < 0 || reading.spot.node >= model_.cable().segments())
            throw InvalidInput({"recursive estimator: a sensor beyond the cable; its nodes are 0 to " +
                                std::to_string(model_.cable().segments())});
    }
    RecursiveReport report;
    move(ends, report);
    take_moments();
    for (const TensionReading& reading : readings) correct(reading, report);
    if (!readings.empty()) {
        forbid_pushing();
        take_moments();
    }
    known_ = ends;
    ++steps_;
    return report;
}

void RecursiveEstimator::move(const KnownEnds& ends, RecursiveReport& report) {
    if (sliding_)
        move_sliding(*sliding_, ends, report);
    else
        move_with(model_, ends, report);
}

// E41, with one speed for all members.
void RecursiveEstimator::move_sliding(Sliding& sliding, const KnownEnds& ends, RecursiveReport& report) {
    const auto set_exponents = [&] {
        const auto wrap_rad = sliding.model.cable().wrap_angle_rad();
        for (std::size_t k = 0; k < wrap_rad.size(); ++k)
            sliding.exponent[k] = sliding.rates.with_speed(k, sliding.exponent_without_speed[k], wrap_rad[k]);
        sliding.model.set_sliding_exponents(sliding.exponent);
    };
    sliding.before = members_;
    observe(sliding);
    set_exponents();
    move_with(sliding.model, ends, report);
    observe(sliding);
    if (sliding.rates.needs_second_trial()) {
        sliding.rates.end_first_trial();
        set_exponents();
        members_ = sliding.before;
        report = {};
        move_with(sliding.model, ends, report);
        observe(sliding);
    }
    sliding.rates.end_step();
}

// Means over the members that carry something.
void RecursiveEstimator::observe(Sliding& sliding) const {
    const auto taut = static_cast<double>(std::count_if(
        members_.begin(), members_.end(), [](const auto& member) { return !is_slack(member); }));
    for (std::size_t k = 0; k < sliding.rates.size(); ++k) {
        double tension_N = 0.0;
        double slid_m = 0.0;
        for (std::size_t j = 0; j < members_.size(); ++j) {
            if (is_slack(members_[j])) continue;
            const CableState& now = members_[j];
            const std::vector<double>& before_m = sliding.before[j].displacement_m;
            tension_N += 0.5 * (now.tension_N[k] + now.tension_N[k + 1]);
            slid_m +=
                0.5 * (now.displacement_m[k] - before_m[k] + now.displacement_m[k + 1] - before_m[k + 1]);
        }
        sliding.rates.observe(k, taut > 0.0 ? tension_N / taut : 0.0, taut > 0.0 ? slid_m / taut : 0.0);
    }
}

// E36. An end without wander is where it is known to be, free of the rounding of summed increments.
void RecursiveEstimator::move_with(const QuasiStaticStep& model, const KnownEnds& ends,
                                   RecursiveReport& report) {
    const EndWander& wander = settings_.wander;
    const auto scores = [&](double wander_m, std::uint32_t which) {
        using Uniforms = std::array<double, 2>;
        return StratifiedScores(normal_scores_,
                                wander_m > 0.0 ? uniforms(settings_.seed, steps_, which) : Uniforms{});
    };
    const StratifiedScores proximal = scores(wander.proximal_m, 0);
    const StratifiedScores distal = scores(wander.distal_m, 1);
    const double proximal_known_m = ends.proximal_displacement_m - known_.proximal_displacement_m;
    const double distal_known_m = ends.distal_displacement_m - known_.distal_displacement_m;
    for (std::size_t j = 0; j < members_.size(); ++j) {
        CableState& member = members_[j];
        const double proximal_m = wander.proximal_m > 0.0 ? member.displacement_m.front() + proximal_known_m +
                                                                wander.proximal_m * proximal[j]
                                                          : ends.proximal_displacement_m;
        const double distal_m = wander.distal_m > 0.0 ? member.displacement_m.back() + distal_known_m +
                                                            wander.distal_m * distal[j]
                                                      : ends.distal_displacement_m;
        const StepReport step =
            model.advance(member, {EndCondition::position_m(proximal_m), EndCondition::position_m(distal_m)});
        if (!step.verified) ++report.unverified;
        if (is_slack(member)) ++report.slack;
    }
}

// E37 and E38 for one reading; deviation_N_ is that of the members before it, then after it.
void RecursiveEstimator::correct(const TensionReading& reading, RecursiveReport& report) {
    const double count = static_cast<double>(members_.size());
    double sensed_mean_N = 0.0;
    for (std::size_t j = 0; j < members_.size(); ++j) {
        sensed_N_[j] = tension_at_N(members_[j], reading.spot);
        sensed_mean_N += sensed_N_[j] / count;
    }
    double variance = 0.0;
    for (double& sensed_N : sensed_N_) {
        sensed_N -= sensed_mean_N;
        variance += sensed_N * sensed_N / (count - 1.0);
    }
    const double noise_N = std::max(reading_deviation_N(reading.noise, sensed_mean_N), smallest_deviation_N);
    const double total = variance + noise_N * noise_N;
    // A reading at the end of its range says only that the tension is at least that.
    const bool saturated = reading.value_N >= reading.noise.range_N;
    const double innovation_N = reading.value_N - sensed_mean_N;
    report.log_evidence += -0.5 * (innovation_N * innovation_N / total + std::log(total));
    if (variance <= 0.0 || (saturated && innovation_N <= 0.0)) return;

    const double fraction = 1.0 / (1.0 + std::sqrt(noise_N * noise_N / total));
    weighted_member_sums(rows_N_, sensed_N_, gain_);
    // The deviations are what the next reading starts from; take_moments() sees to what slack members do not
    // follow.
    gains_of_sums({count, variance, total, fraction, chance_variances}, gain_, deviation_N_);
    // Elongations change with tensions (E2's mean of both ends, whatever the rules say of sliding segments).
    const std::vector<double>& half_compliance = model_.tables().half_compliance_m_per_N;
    for (std::size_t node = 0; node + 1 < gain_.size(); ++node)
        gain_m_per_N_[node + 1] =
            gain_m_per_N_[node] + half_compliance[node] * (gain_[node] + gain_[node + 1]);
    for (std::size_t j = 0; j < members_.size(); ++j)
        pull_N_[j] = is_slack(members_[j]) ? 0.0 : innovation_N - fraction * sensed_N_[j];
    add_pulls(gain_, pull_N_, rows_N_);
    add_pulls(gain_m_per_N_, pull_N_, rows_m_);
}

// No cable pushes: what a correction made negative is raised to nothing, and the cable beyond moves along.
void RecursiveEstimator::forbid_pushing() {
    const std::vector<double>& half_compliance = model_.tables().half_compliance_m_per_N;
    for (CableState& member : members_) {
        if (is_slack(member) || pulls_everywhere(member.tension_N)) continue;
        double raised_before_N = 0.0;
        double moved_m = 0.0;
        double largest_N = 0.0;
        for (std::size_t node = 0; node < member.tension_N.size(); ++node) {
            double& tension_N = member.tension_N[node];
            const double raised_N = std::max(-tension_N, 0.0);
            if (node > 0) moved_m += half_compliance[node - 1] * (raised_before_N + raised_N);
            member.displacement_m[node] += moved_m;
            tension_N = std::max(tension_N, 0.0);
            largest_N = std::max(largest_N, tension_N);
            raised_before_N = raised_N;
        }
        if (largest_N > 0.0) continue;
        member.last_motion = {};
        member.last_motion.kind = MotionKind::slack;
    }
}

void RecursiveEstimator::take_moments() {
    // A step may have given a member other memory.
    for (std::size_t j = 0; j < members_.size(); ++j) {
        rows_N_[j] = members_[j].tension_N.data();
        rows_m_[j] = members_[j].displacement_m.data();
    }
    member_moments(rows_N_, mean_N_, deviation_N_);
}

RecursiveEstimator::Moments RecursiveEstimator::at(const SensorSpot& spot) const {
    const double count = static_cast<double>(members_.size());
    Moments moments;
    for (const CableState& member : members_) moments.mean_N += tension_at_N(member, spot) / count;
    double squares = 0.0;
    for (const CableState& member : members_) {
        const double off_N = tension_at_N(member, spot) - moments.mean_N;
        squares += off_N * off_N;
    }
    moments.deviation_N = std::sqrt(squares / (count - 1.0));
    return moments;
}

}  // namespace capstan
