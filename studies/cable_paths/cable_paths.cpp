#include "capstan/cable_paths/cable_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <string>

#include "capstan/platform/parallel_for.h"
#include "capstan/platform/stop_request.h"
#include "capstan/solver/cable_ensemble.h"

namespace capstan {

namespace {

// Draws that are stepped side by side. Few, so that the blocks of a small batch still fill all threads.
constexpr int block_members = 8;
constexpr int steps_between_stops = 64;

// Noting each of a million wrong numbers would help nobody.
void check_numbers(const std::string& key, std::span<const double> numbers,
                   const std::function<bool(double)>& is_right, const char* rule,
                   std::vector<KeyProblem>& problems) {
    const auto wrong = [&](double number) { return !std::isfinite(number) || !is_right(number); };
    const auto first = std::find_if(numbers.begin(), numbers.end(), wrong);
    if (first == numbers.end()) return;
    const auto others = std::count_if(first + 1, numbers.end(), wrong);
    problems.push_back({fmt::format("{}[{}]", key, first - numbers.begin()),
                        fmt::format("is {:g}, but must be {}{}", *first, rule,
                                    others == 0 ? "" : fmt::format("; so must {} others", others))});
}

bool is_anything(double) {
    return true;
}

void check_load(const CableMotion& motion, std::vector<KeyProblem>& problems) {
    if (const auto* spring = std::get_if<SpringLoad>(&motion.load)) {
        if (!(spring->stiffness_N_per_m > 0.0) || !std::isfinite(spring->stiffness_N_per_m))
            problems.push_back({"load.stiffness_N_per_m",
                                fmt::format("is {:g}, but must be above 0", spring->stiffness_N_per_m)});
    } else if (const auto* weight = std::get_if<WeightLoad>(&motion.load)) {
        if (!(weight->tension_N >= 0.0) || !std::isfinite(weight->tension_N))
            problems.push_back(
                {"load.tension_N",
                 fmt::format("is {:g}, but must be 0 or more; a cable cannot push", weight->tension_N)});
    } else if (const auto* moved = std::get_if<MovedLoad>(&motion.load)) {
        if (moved->displacement_m.size() != motion.motor_m.size())
            problems.push_back({"load.displacement_m",
                                fmt::format("has {} times, but motor_m has {}; give both at the same times",
                                            moved->displacement_m.size(), motion.motor_m.size())});
        check_numbers("load.displacement_m", moved->displacement_m, is_anything, "a finite number", problems);
    }
}

// What the load end obeys (E6) in a step, with one value for each member.
struct LoadCondition {
    double displacement_factor = 1.0;
    double tension_factor = 0.0;
};

LoadCondition condition_of(const CableLoad& load) {
    if (const auto* spring = std::get_if<SpringLoad>(&load)) return {spring->stiffness_N_per_m, 1.0};
    if (std::holds_alternative<WeightLoad>(load)) return {0.0, 1.0};
    return {};
}

double value_of(const CableLoad& load, double pretension_N, std::size_t time) {
    if (std::holds_alternative<SpringLoad>(load)) return pretension_N;
    if (const auto* weight = std::get_if<WeightLoad>(&load)) return weight->tension_N;
    if (const auto* moved = std::get_if<MovedLoad>(&load)) return moved->displacement_m[time];
    return 0.0;
}

double drawn(const std::vector<double>& numbers, int draw, double nominal) {
    return numbers.empty() ? nominal : numbers[static_cast<std::size_t>(draw)];
}

// Up to block_members draws over all times.
class Block {
  public:
    Block(const Cable& cable, const CableMotion& motion, const CableDraws& draws, int first_draw)
        : motion_(motion),
          first_draw_(first_draw),
          count_(std::min(block_members, count_of(draws) - first_draw)),
          members_(cable, block_members),
          pretension_N_(block_members),
          value_(block_members) {
        for (int member = 0; member < block_members; ++member) {
            const int draw = first_draw + std::min(member, count_ - 1);
            set_member(cable, draws, draw, static_cast<std::size_t>(member));
        }
        members_.retune();
    }

    int run(const PathArrays& paths) {
        const LoadCondition condition = condition_of(motion_.load);
        double motor_m = 0.0;
        int unverified = 0;
        for (std::size_t time = 0; time < motion_.motor_m.size(); ++time) {
            if (time % steps_between_stops == 0) throw_if_stopped();
            for (std::size_t member = 0; member < value_.size(); ++member)
                value_[member] = value_of(motion_.load, pretension_N_[member], time);
            const double reeled_in_m = motion_.motor_m[time] - motor_m;
            motor_m = motion_.motor_m[time];
            const EnsembleReport report = members_.advance(
                -reeled_in_m, {condition.displacement_factor, condition.tension_factor, value_});
            unverified += report.unverified;
            write(paths, time);
        }
        return unverified;
    }

  private:
    void set_member(const Cable& cable, const CableDraws& draws, int draw, std::size_t member) {
        const double friction = drawn(draws.friction, draw, cable.dynamic_friction());
        const double stiffness_N = drawn(draws.axial_stiffness_N, draw, cable.axial_stiffness_N());
        const double pretension_N = drawn(draws.pretension_N, draw, cable.pretension_N());
        pretension_N_[member] = pretension_N;
        members_.compliance_m_per_N()[member] = cable.mean_segment_length_m() / stiffness_N;
        for (int segment = 0; segment < cable.segments(); ++segment)
            members_.sliding_exponent(segment)[member] =
                friction * cable.wrap_angle_rad()[static_cast<std::size_t>(segment)];
        const double strain = pretension_N / stiffness_N;
        for (int node = 0; node < cable.nodes(); ++node) {
            const double from_load =
                cable.segments() - cable.relative_position()[static_cast<std::size_t>(node)];
            members_.tension_N(node)[member] = pretension_N;
            members_.displacement_m(node)[member] = -strain * cable.mean_segment_length_m() * from_load;
        }
    }

    void write(const PathArrays& paths, std::size_t time) const {
        const auto nodes = static_cast<std::size_t>(members_.nodes());
        const std::size_t times = motion_.motor_m.size();
        for (int node = 0; node < members_.nodes(); ++node) {
            const std::span<const double> tension_N = members_.tension_N(node);
            const std::span<const double> displacement_m = members_.displacement_m(node);
            std::size_t at = (static_cast<std::size_t>(first_draw_) * times + time) * nodes +
                             static_cast<std::size_t>(node);
            for (std::size_t member = 0; member < static_cast<std::size_t>(count_); ++member) {
                paths.tension_N[at] = tension_N[member];
                paths.displacement_m[at] = displacement_m[member];
                at += times * nodes;
            }
        }
    }

    const CableMotion& motion_;
    int first_draw_;
    int count_;
    CableEnsemble members_;
    std::vector<double> pretension_N_;  // members
    std::vector<double> value_;         // members
};

}  // namespace

int count_of(const CableDraws& draws) {
    for (const auto* numbers : {&draws.friction, &draws.axial_stiffness_N, &draws.pretension_N})
        if (!numbers->empty()) return static_cast<int>(numbers->size());
    return 1;
}

std::vector<KeyProblem> problems_of(const Cable& cable, const CableMotion& motion, const CableDraws& draws) {
    std::vector<KeyProblem> problems;
    if (motion.motor_m.empty()) problems.push_back({"motor_m", "has no times; give at least one"});
    check_numbers("motor_m", motion.motor_m, is_anything, "a finite number", problems);
    check_load(motion, problems);
    const double wrap_rad =
        std::accumulate(cable.wrap_angle_rad().begin(), cable.wrap_angle_rad().end(), 0.0);
    const double ratio =
        cable.dynamic_friction() > 0.0 ? cable.static_friction() / cable.dynamic_friction() : 1.0;
    check_numbers(
        "friction", draws.friction,
        [&](double mu) { return mu >= 0.0 && mu * ratio * wrap_rad <= largest_friction_exponent; },
        wrap_rad > 0.0 ? fmt::format("0 to {:.3g}", largest_friction_exponent / (ratio * wrap_rad)).c_str()
                       : "0 or more",
        problems);
    check_numbers(
        "axial_stiffness_N", draws.axial_stiffness_N, [](double EA) { return EA > 0.0; }, "above 0",
        problems);
    check_numbers(
        "pretension_N", draws.pretension_N, [](double T) { return T >= 0.0; }, "0 or more", problems);
    const auto count = static_cast<std::size_t>(count_of(draws));
    const std::pair<const char*, const std::vector<double>*> lists[] = {
        {"friction", &draws.friction},
        {"axial_stiffness_N", &draws.axial_stiffness_N},
        {"pretension_N", &draws.pretension_N}};
    for (const auto& [key, numbers] : lists) {
        if (!numbers->empty() && numbers->size() != count)
            problems.push_back(
                {key, fmt::format("has {} draws, but another number has {}; give as many of each",
                                  numbers->size(), count)});
    }
    return problems;
}

PathReport simulate_paths(const Cable& cable, const CableMotion& motion, const CableDraws& draws, int jobs,
                          const PathArrays& paths) {
    if (const auto problems = problems_of(cable, motion, draws); !problems.empty())
        throw InvalidInput(problems);
    const int count = count_of(draws);
    const std::size_t size =
        static_cast<std::size_t>(count) * motion.motor_m.size() * static_cast<std::size_t>(cable.nodes());
    assert(paths.tension_N.size() == size && paths.displacement_m.size() == size);
    static_cast<void>(size);
    const int blocks = (count + block_members - 1) / block_members;
    std::vector<int> unverified(static_cast<std::size_t>(blocks), 0);
    parallel_for_each_index(blocks, jobs, [&](int block) {
        unverified[static_cast<std::size_t>(block)] =
            Block(cable, motion, draws, block * block_members).run(paths);
    });
    PathReport report{static_cast<long long>(count) * static_cast<long long>(motion.motor_m.size()), 0};
    for (const int each : unverified) report.unverified += each;
    return report;
}

}  // namespace capstan
