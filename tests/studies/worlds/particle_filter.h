#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "capstan/solver/quasi_static_step.h"
#include "capstan/worlds/world_trial.h"

namespace capstan::testing {

/// The reference for EnsembleFilter: a bootstrap particle filter that shares no code with it but the step and
/// the far end's process. Every particle is a cable with its own numbers. Where the weights leave fewer than
/// half of the particles effective, they are resampled, and their numbers are drawn from a kernel that keeps
/// mean and variance (Liu and West 2001, shrinkage 0.98).
class ParticleFilter {
  public:
    ParticleFilter(const WorldQuestion& question, std::vector<int> sensors, int particles, unsigned seed)
        : question_(question), sensors_(std::move(sensors)), process_(far_end_process()), random_(seed) {
        const CableUncertainty& unknown = question.belief.uncertainty;
        spread_ = {unknown.friction, unknown.stiffness, unknown.pretension};
        spread_.insert(spread_.end(), static_cast<std::size_t>(question.cable.bends()), unknown.wrap);
        for (const int sensor : sensors_) {
            const SensorErrors& errors = question.offers[static_cast<std::size_t>(sensor)].errors;
            spread_.push_back(errors.zero);
            spread_.push_back(errors.gain_ratio);
        }
        const Cable nominal(question.cable.nominal());
        for (const int sensor : sensors_)
            spots_.push_back(spot_at(nominal, question.offers[static_cast<std::size_t>(sensor)].place_m));
        for (int k = 0; k < particles; ++k) {
            Particle particle;
            for (const double deviation : spread_) particle.numbers.push_back(deviation * normal_(random_));
            build(particle);
            particle.state = pretensioned(Cable(cable_of(particle)));
            particle.begun_m = particle.state.displacement_m.front();
            particles_.push_back(std::move(particle));
        }
    }

    void step(double proximal_increment_m, const std::vector<double>& readings) {
        proximal_m_ += proximal_increment_m;
        double highest = -1e300;
        for (Particle& particle : particles_) {
            if (process_.moves())
                process_.advance(particle.far_end_m, particle.far_end_m_per_s, normal_(random_),
                                 normal_(random_));
            particle.step.front().advance(
                particle.state,
                {EndCondition::position_m(particle.begun_m + proximal_m_), distal_of(particle)});
            for (std::size_t s = 0; s < sensors_.size(); ++s)
                particle.log_weight += log_likelihood(particle, s, readings[s]);
            highest = std::max(highest, particle.log_weight);
        }
        double sum = 0.0;
        double squares = 0.0;
        for (Particle& particle : particles_) {
            particle.log_weight -= highest;
            const double weight = std::exp(particle.log_weight);
            sum += weight;
            squares += weight * weight;
        }
        mean_N_.assign(particles_.front().state.tension_N.size(), 0.0);
        for (const Particle& particle : particles_)
            for (std::size_t node = 0; node < mean_N_.size(); ++node)
                mean_N_[node] += std::exp(particle.log_weight) / sum * particle.state.tension_N[node];
        if (sum * sum / squares < 0.5 * static_cast<double>(particles_.size())) resample(sum);
    }

    const std::vector<double>& mean_N() const { return mean_N_; }

  private:
    struct Particle {
        std::vector<double> numbers;  // log friction, stiffness, pretension, wraps; zero and gain of sensors
        std::vector<QuasiStaticStep> step;  // one
        CableState state;
        double begun_m = 0.0;
        double far_end_m = 0.0;
        double far_end_m_per_s = 0.0;
        double log_weight = 0.0;
    };

    FarEndProcess far_end_process() const { return {question_.belief.far_end, question_.belief.interval_s}; }
    CableSpecification cable_of(const Particle& particle) const {
        const auto& n = particle.numbers;
        return question_.cable.with(
            {n[0], n[1], n[2], {n.begin() + 3, n.begin() + 3 + question_.cable.bends()}});
    }
    void build(Particle& particle) const {
        particle.step.clear();
        particle.step.emplace_back(Cable(cable_of(particle)), ModelRules::consistent());
    }
    double stiffness() const { return question_.belief.support.spring_stiffness_N_per_m; }
    EndCondition distal_of(const Particle& particle) const {
        if (stiffness() == 0.0) return EndCondition::position_m(particle.far_end_m);
        return {stiffness(), 1.0,
                particle.step.front().cable().pretension_N() + stiffness() * particle.far_end_m};
    }
    double log_likelihood(const Particle& particle, std::size_t s, double reading) const {
        const SensorOffer& offer = question_.offers[static_cast<std::size_t>(sensors_[s])];
        const double true_value = measures_tension(offer.kind) ? tension_at_N(particle.state, spots_[s])
                                                               : particle.state.displacement_m.back();
        const std::size_t own = 3 + static_cast<std::size_t>(question_.cable.bends()) + 2 * s;
        const double expected = true_value * (1.0 + particle.numbers[own + 1]) + particle.numbers[own];
        const double deviation =
            std::hypot(offer.errors.multiplicative_ratio * true_value, std::max(offer.errors.additive, 1e-9));
        const double off = (reading - expected) / deviation;
        return -0.5 * off * off - std::log(deviation);
    }

    void resample(double sum) {
        const std::size_t count = particles_.size();
        std::vector<double> mean(spread_.size(), 0.0);
        std::vector<double> variance(spread_.size(), 0.0);
        for (const Particle& particle : particles_)
            for (std::size_t k = 0; k < mean.size(); ++k)
                mean[k] += std::exp(particle.log_weight) / sum * particle.numbers[k];
        for (const Particle& particle : particles_)
            for (std::size_t k = 0; k < mean.size(); ++k)
                variance[k] +=
                    std::exp(particle.log_weight) / sum * std::pow(particle.numbers[k] - mean[k], 2);
        constexpr double shrinkage = 0.98;
        const double kernel = std::sqrt(1.0 - shrinkage * shrinkage);
        std::vector<Particle> chosen;
        double passed = 0.0;
        double at = std::uniform_real_distribution<double>(0.0, 1.0)(random_) / static_cast<double>(count);
        for (const Particle& particle : particles_) {
            passed += std::exp(particle.log_weight) / sum;
            for (; at < passed && chosen.size() < count; at += 1.0 / static_cast<double>(count)) {
                chosen.push_back(particle);
                Particle& copy = chosen.back();
                copy.log_weight = 0.0;
                for (std::size_t k = 0; k < mean.size(); ++k)
                    copy.numbers[k] = shrinkage * copy.numbers[k] + (1.0 - shrinkage) * mean[k] +
                                      kernel * std::sqrt(variance[k]) * normal_(random_);
                build(copy);
            }
        }
        while (chosen.size() < count) chosen.push_back(chosen.back());
        particles_ = std::move(chosen);
    }

    const WorldQuestion& question_;
    std::vector<int> sensors_;
    FarEndProcess process_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    std::vector<double> spread_;
    std::vector<SensorSpot> spots_;
    std::vector<Particle> particles_;
    std::vector<double> mean_N_;
    double proximal_m_ = 0.0;
};

/// Mean square error [N^2] over samples and the length of the cable of a world, as WorldError has it.
inline double particle_square_N2(const WorldQuestion& question, const World& world, std::vector<int> sensors,
                                 int particles = 10000) {
    ParticleFilter filter(question, sensors, particles, 17);
    std::vector<double> readings;
    const Cable cable(question.cable.nominal());
    double squares = 0.0;
    for (int sample = 0; sample < world.samples(); ++sample) {
        world.read(sample, question.offers, sensors, readings);
        filter.step(world.proximal_increment_m[static_cast<std::size_t>(sample)], readings);
        for (int node = 0; node < world.nodes; ++node) {
            const double near_m = node > 0 ? cable.segment_length_m(node - 1) : 0.0;
            const double far_m = node + 1 < world.nodes ? cable.segment_length_m(node) : 0.0;
            squares += 0.5 * (near_m + far_m) / cable.length_m() *
                       std::pow(filter.mean_N()[static_cast<std::size_t>(node)] -
                                    world.tensions_N(sample)[static_cast<std::size_t>(node)],
                                2);
        }
    }
    return squares / world.samples();
}

}  // namespace capstan::testing
