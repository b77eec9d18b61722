#include "capstan/rig/bench_cables.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "capstan/cable/invalid_input.h"

namespace capstan {

namespace {

// Bristles so stiff that the closed-form step's fronts come out, and so soft that Newton's method sees where
// a front goes. What friction of half a segment stretches a segment by is a front's own displacement;
// segments count by their wrap, because only those that are bent stop a front.
double numerical_presliding_m(const Cable& cable, double end_error_m) {
    constexpr double min_m = 2e-7;  // below, Newton's method fails with 200 segments
    const std::span<const double> wrap_rad = cable.wrap_angle_rad();
    const double sum_rad = std::accumulate(wrap_rad.begin(), wrap_rad.end(), 0.0);
    const double squares = std::inner_product(wrap_rad.begin(), wrap_rad.end(), wrap_rad.begin(), 0.0);
    const double half_segment_rad = sum_rad > 0.0 ? 0.5 * squares / sum_rad : 0.0;
    const double front_m = cable.dynamic_friction() * half_segment_rad * cable.pretension_N() *
                           cable.mean_segment_length_m() / cable.axial_stiffness_N();
    return std::clamp(front_m, std::clamp(end_error_m, min_m, usual_end_error_m), usual_end_error_m);
}

// The middle of the last half segment is a quarter of a segment from the end.
constexpr double middle_of_half_segment = 0.25;

BenchEffects with_bristles(BenchEffects effects, double numerical_m) {
    if (!(effects.of<Presliding>().length_m > numerical_m)) effects.of<Presliding>() = {numerical_m, 0.0};
    return effects;
}

// Whether a law changes the friction coefficient from step to step.
bool changes_friction(const auto& law) {
    if constexpr (
        requires { laws::added_friction(law, 0.0); } || requires { laws::friction_factor(law, 0.0); } ||
        requires { laws::direction_factor(law, 0.0); } || requires { laws::session_factor(law, 0.0); })
        return law.is_active();
    return false;
}

template <class... Effects>
bool friction_varies(const EffectSet<Effects...>& effects) {
    return (changes_friction(effects.template of<Effects>()) || ...) ||
           effects.template of<MovingBend>().extra_angle_per_load_angle != 0.0;
}

// Wrap angle of the cable that each node stands for: half of each segment beside it.
std::vector<double> node_wrap_rad(const Cable& cable) {
    std::vector<double> wrap(static_cast<std::size_t>(cable.nodes()), 0.0);
    for (std::size_t segment = 0; segment < cable.wrap_angle_rad().size(); ++segment) {
        wrap[segment] += 0.5 * cable.wrap_angle_rad()[segment];
        wrap[segment + 1] += 0.5 * cable.wrap_angle_rad()[segment];
    }
    return wrap;
}

// Spreads an angle over the nodes whose cable lies in a stretch.
void add_bend(const Cable& cable, const Stretch& stretch, double angle_rad, std::vector<double>& nodes) {
    const double half_m = 0.5 * cable.mean_segment_length_m();
    for (int node = 0; node < cable.nodes(); ++node) {
        const double middle_m = cable.node_position_m(node);
        nodes[static_cast<std::size_t>(node)] +=
            angle_rad * stretch.fraction_within(middle_m - half_m, middle_m + half_m);
    }
}

}  // namespace

BenchCables::BenchCables(std::span<const Cable> cables, std::span<const double> losses_s,
                         std::span<const BenchEffects> effects, std::span<const CableEnds> ends,
                         CableArrangement arrangement) {
    if (!std::all_of(cables.begin(), cables.end(), [](const Cable& cable) { return cable.is_evenly_cut(); }))
        throw InvalidInput(
            {"a bench with effects takes cables cut into equal segments; leave out node_places_m"});
    group_.benches = static_cast<int>(cables.size());
    group_.nodes = cables.front().nodes();
    group_.cables = arrangement == CableArrangement::pull_pull ? 2 : 1;
    group_.segment_m = cables.front().mean_segment_length_m();
    const auto nodes = static_cast<std::size_t>(group_.nodes);
    for (int c = 0; c < group_.cables; ++c) {
        Arrays& arrays = arrays_[c];
        for (PerNode* each :
             {&arrays.before_m, &arrays.before_bend, &arrays.before_speed_m_per_s,
              &arrays.lagging_speed_m_per_s, &arrays.crept_m, &arrays.before_tension_N, &arrays.wrap_rad,
              &arrays.wrap_per_load_angle, &arrays.friction, &arrays.displacement_m, &arrays.bend,
              &arrays.tension_N, &arrays.upper, &arrays.value, &arrays.by_motor, &arrays.by_load})
            each->resize(nodes);
        group_.cable[c] = {arrays.before_m.data(),
                           arrays.before_bend.data(),
                           arrays.before_speed_m_per_s.data(),
                           arrays.lagging_speed_m_per_s.data(),
                           arrays.crept_m.data(),
                           arrays.before_tension_N.data(),
                           arrays.wrap_rad.data(),
                           arrays.wrap_per_load_angle.data(),
                           arrays.friction.data(),
                           arrays.displacement_m.data(),
                           arrays.bend.data(),
                           arrays.tension_N.data(),
                           arrays.upper.data(),
                           arrays.value.data(),
                           arrays.by_motor.data(),
                           arrays.by_load.data()};
    }
    // Lanes without a bench of their own carry the first one's along.
    for (int lane = 0; lane < bench_lanes; ++lane) {
        const std::size_t bench =
            static_cast<std::size_t>(lane) < cables.size() ? static_cast<std::size_t>(lane) : 0;
        group_.loss_s.of[lane] = losses_s[bench];
        set_laws(lane, cables[bench], effects[bench], ends[bench]);
        set_rest(lane, cables[bench], effects[bench]);
    }
}

void BenchCables::set_laws(int lane, const Cable& cable, const BenchEffects& effects, const CableEnds& ends) {
    group_.laws.set(lane, with_bristles(effects, numerical_presliding_m(cable, ends.error_m)));
    group_.of_neighbour.of[lane] = ends.load_is_held ? middle_of_half_segment : 0.0;
    group_.stretch_m_per_N.of[lane] = group_.segment_m / cable.axial_stiffness_N();
    group_.dynamic_friction.of[lane] = cable.dynamic_friction();
    const bool varies = friction_varies(effects);
    group_.varying_friction.of[lane] = varies ? 1.0 : 0.0;
    group_.any_varying_friction |= varies;

    const LocalBend& bend = effects.of<LocalBend>();
    const MovingBend& moving_bend = effects.of<MovingBend>();
    for (int c = 0; c < group_.cables; ++c) {
        std::vector<double> wrap_rad = node_wrap_rad(cable);
        if (bend.cables != (c == 0 ? BentCables::only_b : BentCables::only_a))
            add_bend(cable, bend.stretch(), bend.extra_angle_rad, wrap_rad);
        std::vector<double> moving(wrap_rad.size(), 0.0);
        if (moving_bend.extra_angle_per_load_angle != 0.0)
            add_bend(cable, moving_bend.stretch(), moving_bend.extra_angle_per_load_angle, moving);
        for (std::size_t node = 0; node < wrap_rad.size(); ++node) {
            arrays_[c].wrap_rad[node].of[lane] = wrap_rad[node];
            arrays_[c].wrap_per_load_angle[node].of[lane] = moving[node];
            arrays_[c].friction[node].of[lane] =
                std::tanh(0.5 * cable.dynamic_friction() * std::max(0.0, wrap_rad[node]));
        }
    }
}

void BenchCables::set_rest(int lane, const Cable& cable, const BenchEffects& effects) {
    const double pretension_N = cable.pretension_N();
    const ConduitCompliance& conduit = effects.of<ConduitCompliance>();
    rest_[lane] = {cable.axial_stiffness_N(), effects.of<Creep>(),   effects.of<NonlinearStiffness>(),
                   conduit.load_m_per_N,      conduit.motor_m_per_N, pretension_N};
    const double motor_end_m = rest_displacement_m(lane);
    for (int c = 0; c < group_.cables; ++c) {
        for (int node = 0; node < group_.nodes; ++node) {
            const auto at = static_cast<std::size_t>(node);
            arrays_[c].before_m[at].of[lane] = motor_end_m + node * stretched_m(rest_[lane], pretension_N);
            arrays_[c].crept_m[at].of[lane] = crept_m(rest_[lane], pretension_N);
            arrays_[c].before_tension_N[at].of[lane] = pretension_N;
        }
        motor_tension_N_[c].of[lane] = load_tension_N_[c].of[lane] = pretension_N;
    }
}

// The creep of one segment at rest under a tension.
double BenchCables::crept_m(const Rest& rest, double tension_N) const {
    return laws::creep_at_rest(rest.creep, group_.segment_m) * tension_N / rest.axial_stiffness_N;
}

double BenchCables::elastic_m(const Rest& rest, double tension_N) const {
    return group_.segment_m * (tension_N / rest.axial_stiffness_N +
                               laws::toe_strain(rest.toe, tension_N / rest.toe.toe_tension_N).strain);
}

double BenchCables::stretched_m(const Rest& rest, double tension_N) const {
    return crept_m(rest, tension_N) + elastic_m(rest, tension_N);
}

// The conduit's ends give way by less, too.
double BenchCables::settled_m(int bench, double kept) const {
    const Rest& rest = rest_[bench];
    const double tension_N = rest.pretension_N * kept;
    const double of_ends_m =
        (rest.motor_compliance_m_per_N + rest.load_compliance_m_per_N) * (rest.pretension_N - tension_N);
    return elastic_m(rest, rest.pretension_N) - elastic_m(rest, tension_N) + of_ends_m / (group_.nodes - 1);
}

double BenchCables::rest_displacement_m(int bench) const {
    const Rest& rest = rest_[bench];
    return -rest.load_compliance_m_per_N * rest.pretension_N -
           (group_.nodes - 1) * stretched_m(rest, rest.pretension_N);
}

void BenchCables::begin(const LaneFlags& active, const CablesMoment& moment, const LaneValues& time_step_s) {
    group_.time_step_s = time_step_s;
    group_.settled_m = moment.settled_m;
    begin_cables(group_, active, moment);
}

BenchCables::Ends BenchCables::linearise(const LaneFlags& active, const EndPlaces (&motor)[max_cables],
                                         const EndPlaces (&load)[max_cables]) {
    Ends ends;
    linearise_cables(group_, active, motor, load, ends.motor, ends.load);
    return ends;
}

LaneValues BenchCables::move(const LaneFlags& active, const LaneValues& motor_rad, const LaneValues& load_rad,
                             const LaneValues& fraction) {
    return move_cables(group_, active, motor_rad, load_rad, fraction);
}

void BenchCables::store() {
    store_cables(group_, motor_tension_N_, load_tension_N_);
}

double BenchCables::sliding_fraction(int bench) const {
    constexpr double built_up = 0.95;
    int sliding = 0;
    for (int c = 0; c < group_.cables; ++c) {
        for (const LaneValues& bend : arrays_[c].before_bend)
            sliding += std::abs(bend.of[bench]) > built_up ? 1 : 0;
    }
    return static_cast<double>(sliding) / (group_.nodes * group_.cables);
}

double BenchCables::tension_at_N(int cable, int bench, double position_m) const {
    const int segments = group_.nodes - 1;
    const double place = std::clamp(position_m / group_.segment_m - 0.5, 0.0, segments - 1.0);
    const int segment = std::clamp(static_cast<int>(place), 0, std::max(0, segments - 2));
    const double fraction = place - segment;
    const PerNode& tension_N = arrays_[cable].before_tension_N;
    return (1.0 - fraction) * tension_N[static_cast<std::size_t>(segment)].of[bench] +
           fraction * tension_N[static_cast<std::size_t>(std::min(segment + 1, segments - 1))].of[bench];
}

}  // namespace capstan
