#include "capstan/worlds/world.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "capstan/cable/cable_cut.h"
#include "capstan/plan/true_motion.h"
#include "capstan/sensing/random_stream.h"
#include "capstan/solver/pull_pull.h"
#include "capstan/worlds/sensor_places.h"

namespace capstan {

namespace {

double deviation_of(const Uncertainty& uncertainty, double fraction) {
    return uncertainty.distribution == FactorDistribution::normal ? std::log1p(fraction) / deviations_of_95
                                                                  : fraction / std::numbers::sqrt3;
}

// The logarithm of a factor.
double log_factor(const Uncertainty& uncertainty, double fraction, double normal) {
    const double width = fraction * uncertainty.worlds_ratio;
    if (uncertainty.distribution == FactorDistribution::normal)
        return deviation_of(uncertainty, fraction) * uncertainty.worlds_ratio * normal;
    const double evenly = std::erf(normal / std::numbers::sqrt2);  // -1 to 1
    return std::log(std::max(1.0 + width * evenly, 0.01));
}

bool is_as_truth_says(const WorldQuestion& question, std::uint32_t index) {
    const double normal = standard_normals({question.seed, RandomPurpose::world_cable, 1, index, 0})[0];
    return 0.5 * std::erfc(-normal / std::numbers::sqrt2) < question.uncertainty.truth_probability;
}

// The stated uncertainty; where the truth's own is known, that of the truth.
Uncertainty uncertainty_of(const WorldQuestion& question, std::uint32_t index) {
    Uncertainty unknown = question.uncertainty;
    if (!is_as_truth_says(question, index)) return unknown;
    const TrueCable& truth = question.truth;
    if (truth.friction_fraction > 0.0) unknown.friction_fraction = truth.friction_fraction;
    if (truth.stiffness_fraction > 0.0) unknown.stiffness_fraction = truth.stiffness_fraction;
    if (truth.pretension_fraction > 0.0) unknown.pretension_fraction = truth.pretension_fraction;
    return unknown;
}

// The effects of a world that is as the truth says.
EffectValues draw_effects(const WorldQuestion& question, std::uint32_t index) {
    EffectValues effects = question.truth.effects;
    std::uint32_t which = 0;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        const std::vector<double>& deviations = question.truth.effect_deviations[e];
        for (std::size_t p = 0; p < effects[e].size(); ++p, ++which) {
            if (p >= deviations.size() || deviations[p] <= 0.0) continue;
            const EffectParameter& parameter = effect_catalogue()[e].parameters[p];
            const double normal =
                standard_normals({question.seed, RandomPurpose::world_cable, 2, index, which})[0];
            effects[e][p] += question.uncertainty.worlds_ratio * deviations[p] * normal;
            effects[e][p] = std::clamp(effects[e][p], parameter.low, parameter.high);
        }
    }
    return effects;
}

// What each cable of a pair has of the effects: those of both, and its own.
EffectValues effects_of_cable(EffectValues effects, int cable) {
    const auto& catalogue = effect_catalogue();
    for (std::size_t of_a = 0; of_a < catalogue.size(); ++of_a) {
        if (catalogue[of_a].variant != "cable A") continue;
        for (std::size_t of_b = 0; of_b < catalogue.size(); ++of_b) {
            if (catalogue[of_b].variant != "cable B" || catalogue[of_b].name != catalogue[of_a].name)
                continue;
            if (cable == 1) effects[of_a] = effects[of_b];  // it is simulated by itself, as a cable A
            effects[of_b] = catalogue[of_b].absent;
        }
    }
    return effects;
}

CableFactors draw_factors(const WorldQuestion& question, std::uint32_t index, int cable) {
    const auto first = static_cast<std::uint32_t>(cable * EnsembleCable::drawn_numbers(question.cable));
    const Uncertainty unknown = uncertainty_of(question, index);
    const auto factor = [&](double fraction, std::uint32_t which) {
        return log_factor(
            unknown, fraction,
            standard_normals({question.seed, RandomPurpose::world_cable, 0, index, first + which})[0]);
    };
    CableFactors factors{factor(unknown.friction_fraction, 0),
                         factor(unknown.stiffness_fraction, 1),
                         factor(unknown.pretension_fraction, 2),
                         {}};
    for (int bend = 0; bend < question.cable.bends(); ++bend)
        factors.log_wrap.push_back(factor(unknown.wrap_fraction, 3 + static_cast<std::uint32_t>(bend)));
    return factors;
}

// A stretch of the log, counted from where it begins, because the cable begins at rest.
std::vector<double> recorded_far_end(const WorldQuestion& question, std::uint32_t index) {
    const std::vector<double>& log_m = question.uncertainty.far_end_samples_m;
    const auto samples = static_cast<std::size_t>(question.motion.samples);
    const double normal = standard_normals({question.seed, RandomPurpose::world_far_end, 0, index, 0})[0];
    const double evenly = 0.5 * std::erfc(-normal / std::numbers::sqrt2);  // 0 to 1
    const std::size_t starts = log_m.size() - samples;
    const std::size_t start =
        std::min(static_cast<std::size_t>(evenly * static_cast<double>(starts)), starts - 1);
    std::vector<double> displacement_m;
    for (std::size_t k = 1; k <= samples; ++k) displacement_m.push_back(log_m[start + k] - log_m[start]);
    return displacement_m;
}

// The far end over time: what it adds to where it rests [m].
std::vector<double> far_end_of(const WorldQuestion& question, std::uint32_t index) {
    if (question.uncertainty.far_end == FarEndKind::recorded) return recorded_far_end(question, index);
    std::vector<double> displacement_m;
    if (question.uncertainty.far_end == FarEndKind::prescribed) {
        const Cable cable(question.cable.nominal());
        TrueMotion alone = question.motion;
        alone.distal.kind = EndKind::position;
        for (int sample = 1; sample <= question.motion.samples; ++sample)
            displacement_m.push_back(ends_at(cable, alone, sample).distal.value);
        return displacement_m;
    }
    FarEndMotion motion = question.belief.far_end;
    motion.range_m *= question.uncertainty.worlds_ratio;
    const FarEndProcess process(motion, question.belief.interval_s);
    double y = 0.0;
    double v = 0.0;
    for (int sample = 1; sample <= question.motion.samples; ++sample) {
        const auto normals = standard_normals(
            {question.seed, RandomPurpose::world_far_end, static_cast<std::uint32_t>(sample), index, 0});
        process.advance(y, v, normals[0], normals[1]);
        displacement_m.push_back(y);
    }
    return displacement_m;
}

// The true transmission of a world over time: by the closed-form step, with effects by the bench. Both
// pulleys of a pair are moved, so that its cables do not act on each other and each has a bench of its own.
class TrueMover {
  public:
    TrueMover(const WorldQuestion& question, const World& world, std::uint32_t index)
        : stiffness_N_per_m_(question.belief.support.spring_stiffness_N_per_m) {
        const bool has_effects = question.truth.has_effects() && is_as_truth_says(question, index);
        for (int cable = 0; cable < cables_of(question.belief.arrangement) && has_effects; ++cable)
            effects_.push_back(std::make_unique<CableWithEffects>(
                specification_of(question, world.factors[static_cast<std::size_t>(cable)], index),
                effects_of_cable(draw_effects(question, index), cable), question.motion.sample_rate_Hz));
        const Cable first(specification_of(question, world.factors[0], index));
        if (question.belief.arrangement == CableArrangement::pull_pull) {
            const Cable second(specification_of(question, world.factors[1], index));
            pair_.emplace(first, second, Pulleys{1.0, 1.0});  // angles are metres
            pair_state_ = pair_->at_rest();
            return;
        }
        step_.emplace(first, ModelRules::consistent());
        pair_state_.cable_a = pretensioned(first);
        begun_m_ = pair_state_.cable_a.displacement_m.front();
    }

    bool has_effects() const { return !effects_.empty(); }
    int unsolved_steps() const { return unsolved_steps_; }
    int cables() const { return pair_ ? 2 : 1; }
    const CableState& state(int cable) const {
        if (has_effects()) return effects_[static_cast<std::size_t>(cable)]->state();
        return cable == 0 ? pair_state_.cable_a : pair_state_.cable_b;
    }

    // Both ends (of a pair those of cable A) as they moved since the start; of a spring its wall.
    void advance(int sample, double proximal_m, double far_end_m) {
        bool is_solved = true;
        if (has_effects()) {
            for (std::size_t cable = 0; cable < effects_.size(); ++cable) {
                const double way = cable == 0 ? 1.0 : -1.0;  // E15
                is_solved = effects_[cable]->advance(sample, way * proximal_m, way * far_end_m) && is_solved;
            }
        } else {
            is_solved = pair_ ? advance_pair(proximal_m, far_end_m) : advance_cable(proximal_m, far_end_m);
        }
        unsolved_steps_ += is_solved ? 0 : 1;
    }

  private:
    bool advance_pair(double proximal_m, double far_end_m) {
        return pair_->advance(pair_state_, {MotorAngle{-proximal_m}, LoadAngle{-far_end_m}}).solved();  // E15
    }
    bool advance_cable(double proximal_m, double far_end_m) {
        const EndCondition distal =
            stiffness_N_per_m_ > 0.0
                ? EndCondition{stiffness_N_per_m_, 1.0,
                               step_->cable().pretension_N() + stiffness_N_per_m_ * far_end_m}
                : EndCondition::position_m(far_end_m);
        return step_->advance(pair_state_.cable_a, {EndCondition::position_m(begun_m_ + proximal_m), distal})
            .verified;
    }
    static CableSpecification specification_of(const WorldQuestion& question, const CableFactors& factors,
                                               std::uint32_t index) {
        const CableSpecification cable = question.cable.with(factors);
        return is_as_truth_says(question, index) ? true_specification(cable, question.truth) : cable;
    }

    double stiffness_N_per_m_;
    std::optional<QuasiStaticStep> step_;
    std::optional<PullPull> pair_;
    PullPullState pair_state_;  // of a single cable its cable A
    double begun_m_ = 0.0;
    std::vector<std::unique_ptr<CableWithEffects>> effects_;  // cables; empty without effects
    int unsolved_steps_ = 0;
};

// What a sensor without errors would read.
double sensed_by(const SensorOffer& offer, const Cable& nominal, const TrueMover& mover) {
    const SensorSpot spot = spot_at(nominal, offer.place_m);
    switch (offer.kind) {
        case SensorKind::tension:
            return tension_at_N(mover.state(offer.cable), spot);
        case SensorKind::motor_torque:
        case SensorKind::load_torque: {
            const double of_a_N = tension_at_N(mover.state(0), spot);
            return mover.cables() == 1 ? of_a_N : of_a_N - tension_at_N(mover.state(1), spot);  // E16
        }
        case SensorKind::load_displacement:
            return mover.state(0).displacement_m.back();
    }
    return 0.0;
}

}  // namespace

WorldQuestion world_question(const StudyPlan& plan, int pieces) {
    WorldQuestion question{.cable = UncertainCable(refined(plan.transmission.cable, pieces)),
                           .rules = plan.transmission.rules,
                           .motion = plan.motion,
                           .uncertainty = plan.uncertainty,
                           .belief = {},
                           .offers = sensor_offers(plan),
                           .truth = plan.truth,
                           .seed = plan.seed};
    const Uncertainty& unknown = plan.uncertainty;
    CableBelief& belief = question.belief;
    belief.arrangement = plan.transmission.arrangement;
    belief.uncertainty = {.friction = deviation_of(unknown, unknown.friction_fraction),
                          .stiffness = deviation_of(unknown, unknown.stiffness_fraction),
                          .pretension = deviation_of(unknown, unknown.pretension_fraction),
                          .wrap = deviation_of(unknown, unknown.wrap_fraction)};
    const EndMotion& distal = plan.motion.distal;
    const double range_m =
        unknown.far_end_range_m > 0.0 ? unknown.far_end_range_m : std::abs(distal.amplitude);
    belief.far_end = {range_m, unknown.far_end_bandwidth_Hz};
    belief.support = {distal.kind == EndKind::spring ? distal.spring_stiffness_N_per_m : 0.0};
    const auto knows = [&](std::string_view effect) {
        return std::find(unknown.known_effects.begin(), unknown.known_effects.end(), effect) !=
               unknown.known_effects.end();
    };
    const BenchEffects effects = effects_with(plan.truth.effects);
    if (knows("viscous_friction")) belief.rate_friction.viscous = effects.of<ViscousFriction>();
    if (knows("stribeck")) belief.rate_friction.stribeck = effects.of<Stribeck>();
    belief.interval_s = 1.0 / plan.motion.sample_rate_Hz;
    return question;
}

World draw_world(const WorldQuestion& question, std::uint32_t index) {
    World world;
    const int cables = cables_of(question.belief.arrangement);
    for (int cable = 0; cable < cables; ++cable)
        world.factors[static_cast<std::size_t>(cable)] = draw_factors(question, index, cable);
    if (is_as_truth_says(question, index)) {
        world.log_friction_ratio = std::log(question.truth.friction_ratio);
        world.log_stiffness_ratio = std::log(question.truth.stiffness_ratio);
        world.log_pretension_ratio = std::log(question.truth.pretension_ratio);
    }
    const Cable nominal(question.cable.nominal());
    TrueMover mover(question, world, index);
    const std::vector<double> far_end_m = far_end_of(question, index);
    const auto draw = [&](RandomPurpose purpose, int sample, std::size_t rank, std::vector<double>& to) {
        const auto normals = standard_normals({question.seed, purpose, static_cast<std::uint32_t>(sample),
                                               index, static_cast<std::uint32_t>(rank)});
        to.insert(to.end(), {normals[0], normals[1]});
    };
    for (std::size_t rank = 0; rank < question.offers.size(); ++rank)
        draw(RandomPurpose::world_sensor, 0, rank, world.fault);
    world.nodes = cables * nominal.nodes();
    const double started_m = ends_at(nominal, question.motion, 0).proximal.value;
    double before_m = started_m;
    for (int sample = 1; sample <= question.motion.samples; ++sample) {
        const double now_m = ends_at(nominal, question.motion, sample).proximal.value;
        world.proximal_increment_m.push_back(now_m - before_m);
        before_m = now_m;
        mover.advance(sample, now_m - started_m, far_end_m[static_cast<std::size_t>(sample - 1)]);
        for (int cable = 0; cable < cables; ++cable) {
            const std::vector<double>& tension_N = mover.state(cable).tension_N;
            world.tension_N.insert(world.tension_N.end(), tension_N.begin(), tension_N.end());
        }
        for (std::size_t s = 0; s < question.offers.size(); ++s) {
            world.sensed.push_back(sensed_by(question.offers[s], nominal, mover));
            draw(RandomPurpose::world_reading, sample, s, world.noise);
        }
    }
    world.has_effects = mover.has_effects();
    world.unsolved_steps = mover.unsolved_steps();
    return world;
}

void World::read(int sample, std::span<const SensorOffer> offers, std::span<const int> sensors,
                 std::vector<double>& readings) const {
    readings.clear();
    const std::size_t first = static_cast<std::size_t>(sample) * offers.size();
    for (std::size_t rank = 0; rank < sensors.size(); ++rank) {
        const auto offer = static_cast<std::size_t>(sensors[rank]);
        const SensorErrors& errors = offers[offer].errors;
        const double* const drawn = &noise[2 * (first + rank)];
        const double gain = errors.gain_ratio * fault[2 * rank + 1] + errors.multiplicative_ratio * drawn[0];
        readings.push_back(sensed[first + offer] * (1.0 + gain) + errors.zero * fault[2 * rank] +
                           errors.additive * drawn[1]);
    }
}

}  // namespace capstan
