#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "capstan/gap/bench_knowledge.h"
#include "capstan/gap/effects_twin.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// A number of a candidate cause that is fitted, and the coordinate in which the search moves.
struct OpenNumber {
    enum class Kind {
        size,  ///< how much of it there is: the coordinate is in units of a typical case and not negative
        signed_size,  ///< the same with either sign
        shape,        ///< how it looks once it is there: the coordinate is a logarithm
        periods,      ///< how often in a turn: an integer, and the coordinate itself
        step,         ///< that of the lattice on which a coarse channel's values lie
        place,        ///< where along the cable: coordinate in parts of its length
    };
    std::string name;
    std::string unit;
    Kind kind = Kind::size;
    double typical = 1.0;
    double absent = 0.0;
    double low = 0.0;
    double high = 0.0;
    /// Of a size: it sets the frequency of an oscillation, and explains something only close to its value.
    bool resonates = false;
    bool is_detail = false;  ///< of a size: the screening leaves it out, and a search begins without it

    double value(double coordinate) const;
    /// Of a size; the inverse of value() within its range.
    double coordinate_of_size(double value) const { return (value - absent) / (typical - absent); }
    /// Whether the search ended at the end of its range: the true number may lie beyond it.
    bool is_at_bound(double value) const;
    bool is_size() const { return kind == Kind::size || kind == Kind::signed_size || kind == Kind::step; }
    double prior_mean() const;
    double prior_std() const;
    /// Standard deviation of a normal density as high as the prior's at this coordinate (E57). Of a size
    /// nothing is known but its order: it is log-uniform over two decades.
    double prior_width(double coordinate) const;
    /// Of a number that takes separate values: the logarithm of how many; else 0.
    double log_choices() const;
    /// The coordinates at which searches start.
    std::vector<double> starts() const;
};

/// A possible cause of a gap.
struct CandidateCause {
    std::string effect;   ///< canonical name
    std::string variant;  ///< place or channel; empty if there is only one
    std::string family;
    std::string component;
    std::string end;
    std::vector<OpenNumber> numbers;
    struct GivenNumber {
        std::string name;
        std::string unit;
        double value = 0.0;
    };
    std::vector<GivenNumber> given;  ///< parameters of the effect that the recording itself decides
    std::function<void(BenchNumbers&, std::span<const double> values)> apply;
    /// A wrong number, a zero or a gain: nothing of its law is an idealisation.
    bool is_exact = false;
    /// The values themselves show it, as those of a coarse channel lie on a lattice. It is not inferred.
    bool is_seen = false;
    /// An answer has no name for it but `unknown` (EffectDescription).
    bool is_outside_the_list = false;
    /// Parts are made to be without it (EffectDescription).
    bool is_rare = false;
    /// It resembles what others do and few recordings have it, so that it is sought once these have been.
    bool is_sought_last = false;
    std::string varies;  ///< the condition of the runs that the numbers follow; empty: none
    /// The numbers follow a condition of the runs or the time of a sensor's zero, or differ between the runs.
    bool is_of_runs = false;
    /// How far friction, stiffness and pretension may be from their nominal values (logarithms, standard
    /// deviation): one of them far, if that is the cause.
    double friction_std = 0.0;
    double stiffness_std = 0.0;
    double pretension_std = 0.0;

    /// As above for one of the first three floating numbers; 0 for the others.
    double nominal_std(Eigen::Index number) const {
        return number == 0 ? friction_std : number == 1 ? stiffness_std : number == 2 ? pretension_std : 0.0;
    }
};

/// The titles of causes that act together, for a message.
std::string in_words(const std::vector<const CandidateCause*>& causes);

/// Whether an effect at a place is the lag or the delay of a sensor that the cause makes slow as well. A
/// filter of several stages shows both.
bool is_slowness_of_one_sensor(const std::string& effect, const std::string& variant,
                               const CandidateCause& cause);

/// Every cause that this recording could show: none, wrong parameters, the effects of the catalogue, and the
/// sensor faults of each predicted channel. Those that are sought last come last.
std::vector<CandidateCause> candidate_causes(const Recording& recording);

}  // namespace capstan::gap
