#include "sign_vector_enumeration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

namespace capstan::test {

namespace {

constexpr double rounding_m = 1e-12;

// One step's problem, all directions open.
struct Problem {
    const Cable& cable;
    const CableState& before;
    const EndConditions& ends;

    int segments() const { return cable.segments(); }
    double exponent(int segment) const { return cable.dynamic_friction() * cable.wrap_angle_rad()[segment]; }
    double holding_exponent(int segment) const {
        const bool slid = segment_direction(before.last_motion, segment, segments()) != Direction::none;
        return (slid ? cable.dynamic_friction() : cable.static_friction()) * cable.wrap_angle_rad()[segment];
    }
};

// A node moved by its own end's input although its only segment does not slide.
int lone_end_direction(const Problem& p, bool proximal) {
    const EndCondition& end = proximal ? p.ends.proximal : p.ends.distal;
    const int node = proximal ? 0 : p.segments();
    const double u_m = p.before.displacement_m[node];
    const double tension_N = p.before.tension_N[node];
    const double change = end.value - end.displacement_factor * u_m - end.tension_factor * tension_N;
    if (std::abs(change) < 1e-13 * (1.0 + std::abs(end.value))) return 0;
    const double h = 0.5 * p.cable.segment_compliance_m_per_N(proximal ? 0 : p.segments() - 1);
    const double slope = end.displacement_factor * h - (proximal ? 1 : -1) * end.tension_factor;
    return change * slope > 0.0 ? 1 : -1;
}

// Linear equations in the unknowns (T_0 .. T_N, u_0 .. u_N).
class Equations {
  public:
    explicit Equations(int nodes) : nodes_(nodes) {}
    Eigen::VectorXd row() const { return Eigen::VectorXd::Zero(2 * nodes_); }
    int tension(int node) const { return node; }
    int displacement(int node) const { return nodes_ + node; }
    void add(const Eigen::VectorXd& row, double value) {
        rows_.push_back(row);
        values_.push_back(value);
    }
    std::optional<Eigen::VectorXd> solve() const {
        Eigen::MatrixXd matrix(rows_.size(), 2 * nodes_);
        Eigen::VectorXd value(rows_.size());
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const double scale = rows_[k].cwiseAbs().maxCoeff();
            matrix.row(k) = rows_[k].transpose() / scale;
            value[k] = values_[k] / scale;
        }
        // Displacements are thousands of times smaller than tensions: balance the columns.
        const double unit = 1e-4;
        matrix.rightCols(nodes_) *= unit;
        const Eigen::FullPivLU<Eigen::MatrixXd> lu(matrix);
        if (lu.rank() < 2 * nodes_) return std::nullopt;
        Eigen::VectorXd x = lu.solve(value);
        if ((matrix * x - value).cwiseAbs().maxCoeff() > 1e-9 * (1.0 + value.cwiseAbs().maxCoeff())) {
            return std::nullopt;
        }
        x.tail(nodes_) *= unit;
        return x;
    }

  private:
    int nodes_;
    std::vector<Eigen::VectorXd> rows_;
    std::vector<double> values_;
};

struct Pattern {
    std::vector<int> segment;  // -1, 0, 1
    std::vector<int> node;     // direction each moving node must have; 0: at rest
    std::vector<bool> moves;   // nodes
    int opposed_segment = -1;  // holds the zero-velocity point
    int held_segment = -1;     // both its nodes move one way, its middle rests
};

// Without inertia nothing slides but what an end pushes or pulls along: a run from the proximal end, one from
// the distal end, and one stretch between them that does not slide (paper Sec. II.B).
bool spreads_from_the_ends(const std::vector<int>& segment) {
    const auto first = std::find(segment.begin(), segment.end(), 0);
    const auto end = std::find_if(first, segment.end(), [](int direction) { return direction != 0; });
    return std::find(end, segment.end(), 0) == segment.end();
}

// Which nodes move under a sign vector; nothing if the vector contradicts itself. A segment that does not
// slide between two nodes that move: its middle rests (E8) if they move one way, it holds the zero-velocity
// point (E7) if they move against each other.
std::optional<Pattern> pattern_of(const Problem& p, const std::vector<int>& segment) {
    const int n = p.segments();
    Pattern pattern{segment, std::vector<int>(n + 1, 0), std::vector<bool>(n + 1, false), -1, -1};
    for (int node = 0; node <= n; ++node) {
        const int left = node > 0 ? segment[node - 1] : 0;
        const int right = node < n ? segment[node] : 0;
        if (left * right < 0) return std::nullopt;  // would have to rest and slide at once
        pattern.node[node] = left != 0 ? left : right;
        pattern.moves[node] = pattern.node[node] != 0;
    }
    for (const bool proximal : {true, false}) {
        const int node = proximal ? 0 : n;
        if (pattern.moves[node]) continue;
        pattern.node[node] = lone_end_direction(p, proximal);
        pattern.moves[node] = pattern.node[node] != 0;
    }
    if (!spreads_from_the_ends(segment)) return std::nullopt;
    for (int s = 0; s < n; ++s) {
        if (segment[s] != 0 || !pattern.moves[s] || !pattern.moves[s + 1]) continue;
        (pattern.node[s] == pattern.node[s + 1] ? pattern.held_segment : pattern.opposed_segment) = s;
    }
    return pattern;
}

std::optional<CableState> solve(const Problem& p, const Pattern& pattern, double fraction) {
    const int n = p.segments();
    Equations equations(n + 1);
    for (int s = 0; s < n; ++s) {
        const double h = 0.5 * p.cable.segment_compliance_m_per_N(s);
        if (pattern.moves[s] || pattern.moves[s + 1]) {  // E3 = E2 with one elongation rule
            auto row = equations.row();
            row[equations.displacement(s + 1)] = 1.0;
            row[equations.displacement(s)] = -1.0;
            row[equations.tension(s)] = -h;
            row[equations.tension(s + 1)] = -h;
            equations.add(row, 0.0);
        }
        if (s == pattern.held_segment) {  // E8
            auto row = equations.row();
            row[equations.displacement(s)] = 1.0;
            row[equations.tension(s)] = h;
            equations.add(row, p.before.displacement_m[s] + h * p.before.tension_N[s]);
        }
        const bool opposed = s == pattern.opposed_segment;
        if (pattern.segment[s] != 0 || opposed) {  // E1, E7
            const double slide = opposed ? pattern.node[s] * (2.0 * fraction - 1.0) : pattern.segment[s];
            auto row = equations.row();
            row[equations.tension(s + 1)] = 1.0;
            row[equations.tension(s)] = -std::exp(slide * p.exponent(s));
            equations.add(row, 0.0);
        }
    }
    for (int node = 0; node <= n; ++node) {
        if (pattern.moves[node]) continue;
        auto tension = equations.row();
        tension[equations.tension(node)] = 1.0;
        equations.add(tension, p.before.tension_N[node]);
        auto displacement = equations.row();
        displacement[equations.displacement(node)] = 1.0;
        equations.add(displacement, p.before.displacement_m[node]);
    }
    for (const bool proximal : {true, false}) {
        const int node = proximal ? 0 : n;
        if (!pattern.moves[node]) continue;
        const EndCondition& end = proximal ? p.ends.proximal : p.ends.distal;
        auto row = equations.row();
        row[equations.displacement(node)] = end.displacement_factor;
        row[equations.tension(node)] = end.tension_factor;
        equations.add(row, end.value);
    }
    const auto x = equations.solve();
    if (!x) return std::nullopt;
    CableState state = p.before;
    for (int node = 0; node <= n; ++node) {
        state.tension_N[node] = (*x)[equations.tension(node)];
        state.displacement_m[node] = (*x)[equations.displacement(node)];
    }
    return state;
}

bool verified(const Problem& p, const Pattern& pattern, const CableState& state) {
    for (const double tension_N : state.tension_N) {
        if (!(tension_N > 0.0)) return false;
    }
    for (int node = 0; node <= p.segments(); ++node) {
        const double increment_m = state.displacement_m[node] - p.before.displacement_m[node];
        if (pattern.moves[node] && pattern.node[node] * increment_m < -rounding_m) return false;
    }
    for (int s = 0; s < p.segments(); ++s) {
        if (pattern.segment[s] != 0 || s == pattern.opposed_segment) continue;
        const double exponent = std::abs(std::log(state.tension_N[s + 1] / state.tension_N[s]));
        // Of a segment whose middle alone rests both nodes slide: mu_d.
        const double held = s == pattern.held_segment ? p.exponent(s) : p.holding_exponent(s);
        if (exponent > held + 1e-9) return false;
    }
    return true;
}

// The interpolated velocity at the assumed zero-velocity point; zero when it is one.
double mismatch(const Problem& p, const Pattern& pattern, const CableState& state, double fraction) {
    const int s = pattern.opposed_segment;
    const double a = state.displacement_m[s] - p.before.displacement_m[s];
    const double b = state.displacement_m[s + 1] - p.before.displacement_m[s + 1];
    return (1.0 - fraction) * a + fraction * b;
}

std::optional<CableState> solve_opposed(const Problem& p, const Pattern& pattern) {
    double low = 0.0;
    double high = 1.0;
    const auto at_low = solve(p, pattern, low);
    const auto at_high = solve(p, pattern, high);
    if (!at_low || !at_high) return std::nullopt;
    const double low_mismatch = mismatch(p, pattern, *at_low, low);
    if (low_mismatch * mismatch(p, pattern, *at_high, high) > 0.0) return std::nullopt;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        const auto state = solve(p, pattern, middle);
        if (!state) return std::nullopt;
        (mismatch(p, pattern, *state, middle) * low_mismatch > 0.0 ? low : high) = middle;
    }
    return solve(p, pattern, 0.5 * (low + high));
}

bool same(const CableState& a, const CableState& b, double tolerance_N) {
    for (std::size_t node = 0; node < a.tension_N.size(); ++node) {
        if (std::abs(a.tension_N[node] - b.tension_N[node]) > tolerance_N) return false;
    }
    return true;
}

}  // namespace

std::vector<CableState> all_verified_states(const Cable& cable, const CableState& before,
                                            const EndConditions& ends, double tolerance_N) {
    const Problem problem{cable, before, ends};
    std::vector<CableState> found;
    long patterns = 1;
    for (int s = 0; s < problem.segments(); ++s) patterns *= 3;
    for (long code = 0; code < patterns; ++code) {
        std::vector<int> segment;
        for (long rest = code; static_cast<int>(segment.size()) < problem.segments(); rest /= 3) {
            segment.push_back(static_cast<int>(rest % 3) - 1);
        }
        const auto pattern = pattern_of(problem, segment);
        if (!pattern) continue;
        const auto state =
            pattern->opposed_segment >= 0 ? solve_opposed(problem, *pattern) : solve(problem, *pattern, 0.0);
        if (!state || !verified(problem, *pattern, *state)) continue;
        bool is_new = true;
        for (const CableState& other : found) is_new = is_new && !same(*state, other, tolerance_N);
        if (is_new) found.push_back(*state);
    }
    return found;
}

}  // namespace capstan::test
