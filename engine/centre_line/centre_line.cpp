#include "capstan/centre_line/centre_line.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "capstan/centre_line/smooth_line.h"
#include "capstan/sensing/random_stream.h"

namespace capstan {

namespace {

// Points are averaged in groups down to this number: smoothing gains nothing from more.
constexpr Eigen::Index max_points = 300;
// Smoothed lines with fresh noise; a standard deviation of 200 is known to 5%.
constexpr int replicates = 200;
// The turning angle of a piece of constant radius is off by this at most, or by what noise leaves open: it
// changes a tension by 0.5% at a friction of 0.15.
constexpr double turning_tolerance_rad = 0.03;

std::string metres(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g m", value);
    return text;
}

struct Grouped {
    LinePoints points_m;
    double noise_m = 0.0;
    double end_fraction = 0.0;  // of the length, beyond the first and the last of them
};

Grouped grouped(const CentreLine& line) {
    const auto count = static_cast<Eigen::Index>(line.points_m.size());
    const Eigen::Index size = (count + max_points - 1) / max_points;
    const Eigen::Index groups = count / size;
    LinePoints points = LinePoints::Zero(groups, 3);
    for (Eigen::Index group = 0; group < groups; ++group) {
        const Eigen::Index first = group * count / groups;
        const Eigen::Index end = (group + 1) * count / groups;
        for (Eigen::Index k = first; k < end; ++k) {
            const auto& point = line.points_m[static_cast<std::size_t>(k)];
            points.row(group) +=
                Eigen::RowVector3d(point[0], point[1], point[2]) / static_cast<double>(end - first);
        }
    }
    const double each = static_cast<double>(count) / static_cast<double>(groups);
    return {points, line.noise_m / std::sqrt(static_cast<double>(size)),
            0.5 * (each - 1.0) / (static_cast<double>(count) - each)};
}

LinePoints noise_of(Eigen::Index count, double noise_m, int replicate) {
    LinePoints noise(count, 3);
    for (Eigen::Index k = 0; k < count; ++k) {
        const auto address = [&](std::uint32_t which) {
            return RandomAddress{1, RandomPurpose::centre_line, static_cast<std::uint32_t>(k),
                                 static_cast<std::uint32_t>(replicate), which};
        };
        const auto first = standard_normals(address(0));
        noise.row(k) = noise_m * Eigen::RowVector3d(first[0], first[1], standard_normals(address(1))[0]);
    }
    return noise;
}

// Of the curvature at every point, and of replicates of it.
struct Curvatures {
    Eigen::VectorXd length_m;                // points
    LinePoints found;                        // points
    std::vector<LinePoints> replicated;      // replicates
    Eigen::VectorXd chance_variance_per_m2;  // points: mean square of the noise of its three components
};

Curvatures curvatures_of(const SmoothLine& line, const Grouped& points) {
    const LinePoints& smooth = line.points_m();
    Curvatures all{lengths_of(smooth), curvature_of(smooth), {}, Eigen::VectorXd::Zero(smooth.rows())};
    const double beyond_m = points.end_fraction * all.length_m.sum();
    all.length_m[0] += beyond_m;
    all.length_m[smooth.rows() - 1] += beyond_m;
    LinePoints mean = LinePoints::Zero(smooth.rows(), 3);
    for (int k = 0; k < replicates; ++k) {
        all.replicated.push_back(
            curvature_of(line.smoothed(smooth + noise_of(smooth.rows(), points.noise_m, k))));
        mean += all.replicated.back() / replicates;
    }
    for (const LinePoints& each : all.replicated)
        all.chance_variance_per_m2 += (each - mean).rowwise().squaredNorm() / (replicates - 1);
    return all;
}

// The angle by which each point's stretch of line turns, less what noise alone makes of it (E47).
Eigen::VectorXd turning_rad(const Curvatures& all, const LinePoints& curvature) {
    return (curvature.rowwise().squaredNorm() - all.chance_variance_per_m2)
        .cwiseMax(0.0)
        .cwiseSqrt()
        .cwiseProduct(all.length_m);
}

// The points at which pieces begin and end: between them the turning angle grows evenly within the tolerance
// (Ramer, Douglas and Peucker).
void split(const Eigen::VectorXd& at_m, const Eigen::VectorXd& turned_rad, double tolerance_rad,
           Eigen::Index first, Eigen::Index last, std::vector<Eigen::Index>& ends) {
    Eigen::Index worst = first;
    double max_rad = 0.0;
    for (Eigen::Index k = first + 1; k < last; ++k) {
        const double fraction = (at_m[k] - at_m[first]) / (at_m[last] - at_m[first]);
        const double off_rad =
            std::abs(turned_rad[k] - turned_rad[first] - fraction * (turned_rad[last] - turned_rad[first]));
        if (off_rad > max_rad) {
            max_rad = off_rad;
            worst = k;
        }
    }
    if (max_rad > tolerance_rad) {
        split(at_m, turned_rad, tolerance_rad, first, worst, ends);
        split(at_m, turned_rad, tolerance_rad, worst, last, ends);
    } else {
        ends.push_back(last);
    }
}

// 0, then the sum of the elements up to each.
Eigen::VectorXd summed(const Eigen::VectorXd& each) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(each.size() + 1);
    for (Eigen::Index k = 0; k < each.size(); ++k) sums[k + 1] = sums[k] + each[k];
    return sums;
}

// Root of the mean square about `centre`.
double deviation_about(const std::vector<double>& values, double centre) {
    double squares = 0.0;
    for (const double value : values) squares += (value - centre) * (value - centre);
    return std::sqrt(squares / static_cast<double>(values.size()));
}

// A stretch from one sum of `summed` to another.
struct Part {
    Eigen::Index first = 0;
    Eigen::Index end = 0;
    bool is_bend = false;
};

// Noise alone reaches a mean square of the curvature of this many times its variance once in 400 parts, where
// curvatures within the reach of smoothing are one.
bool is_bend(const Curvatures& all, double reach_m, const Part& part) {
    const Eigen::Index count = part.end - part.first;
    const auto length = all.length_m.segment(part.first, count);
    const double found = all.found.rowwise().squaredNorm().segment(part.first, count).dot(length);
    const double chance = all.chance_variance_per_m2.segment(part.first, count).dot(length);
    const double independent = std::max(1.0, length.sum() / reach_m);
    return found > (1.0 + 5.0 / std::sqrt(independent)) * chance;
}

std::vector<Part> parts_of(const Curvatures& all, double reach_m, double tolerance_rad) {
    const Eigen::VectorXd at_m = summed(all.length_m);
    // Smoothing leaves a little turning beside a bend, of about the tolerance.
    const double min_turn_rad = 2.0 * tolerance_rad;
    const Eigen::VectorXd turned_rad = summed(turning_rad(all, all.found));
    std::vector<Eigen::Index> ends;
    split(at_m, turned_rad, tolerance_rad, 0, at_m.size() - 1, ends);
    std::vector<Part> parts;
    // Smoothing shows no bend within its reach apart from the one beside it.
    const auto is_short = [&](const Part& part) { return at_m[part.end] - at_m[part.first] < reach_m; };
    Eigen::Index first = 0;
    for (const Eigen::Index end : ends) {
        Part part{first, end, false};
        part.is_bend = turned_rad[end] - turned_rad[first] > min_turn_rad && is_bend(all, reach_m, part);
        const bool joins_before = !parts.empty() && part.is_bend == parts.back().is_bend &&
                                  (!part.is_bend || is_short(part) || is_short(parts.back()));
        if (joins_before) {
            parts.back().end = end;
        } else {
            parts.push_back(part);
        }
        first = end;
    }
    return parts;
}

// Curvature times length of some points.
Eigen::RowVector3d turning_of(const Curvatures& all, const LinePoints& curvature, Eigen::Index first,
                              Eigen::Index end) {
    return all.length_m.segment(first, end - first).transpose() * curvature.middleRows(first, end - first);
}

// Which way a bend turns beside one of its ends: over its first or last half radian.
Eigen::RowVector3d way_at(const Curvatures& all, const Part& bend, bool at_end) {
    Eigen::Index first = at_end ? bend.end : bend.first;
    Eigen::Index end = first;
    double turned_rad = 0.0;
    while (turned_rad < 0.5 && end - first < bend.end - bend.first) {
        const Eigen::Index next = at_end ? --first : end++;
        turned_rad += all.found.row(next).norm() * all.length_m[next];
    }
    return turning_of(all, all.found, first, end).normalized();
}

// Smoothing moves turning from a bend into the straight parts beside it, and overshoots: the half of each
// that is beside the bend counts with its sign along the way of the bend (E48).
struct Beside {
    std::size_t bend = 0;
    Eigen::Index first = 0;
    Eigen::Index end = 0;
    Eigen::RowVector3d way;
};

std::vector<Beside> beside_bends(const Curvatures& all, const std::vector<Part>& parts) {
    std::vector<Beside> halves;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (parts[k].is_bend) continue;
        const bool has_before = k > 0;
        const bool has_behind = k + 1 < parts.size();
        const Eigen::Index middle = !has_before   ? parts[k].first
                                    : !has_behind ? parts[k].end
                                                  : (parts[k].first + parts[k].end) / 2;
        if (has_before) halves.push_back({k - 1, parts[k].first, middle, way_at(all, parts[k - 1], true)});
        if (has_behind) halves.push_back({k + 1, middle, parts[k].end, way_at(all, parts[k + 1], false)});
    }
    return halves;
}

// Wrap angle of every part; of straight ones 0.
std::vector<double> wrap_of_parts(const Curvatures& all, const LinePoints& curvature,
                                  const std::vector<Part>& parts, const std::vector<Beside>& beside) {
    const Eigen::VectorXd turned_rad = turning_rad(all, curvature);
    std::vector<double> wrap_rad(parts.size(), 0.0);
    for (std::size_t k = 0; k < parts.size(); ++k)
        if (parts[k].is_bend)
            wrap_rad[k] = turned_rad.segment(parts[k].first, parts[k].end - parts[k].first).sum();
    for (const Beside& half : beside)
        wrap_rad[half.bend] += turning_of(all, curvature, half.first, half.end).dot(half.way);
    return wrap_rad;
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

std::vector<KeyProblem> problems_of(const CentreLine& line) {
    std::vector<KeyProblem> problems;
    const std::size_t count = line.points_m.size();
    if (count < min_centre_line_points)
        problems.push_back({"points", "there are " + std::to_string(count) + " points, but at least " +
                                          std::to_string(min_centre_line_points) + " are needed"});
    if (!(line.noise_m > 0.0) || !std::isfinite(line.noise_m))
        problems.push_back({"noise_m", "is " + metres(line.noise_m) + ", but must be above 0"});
    for (std::size_t k = 0; k < count; ++k)
        for (const double coordinate : line.points_m[k])
            if (!std::isfinite(coordinate))
                problems.push_back({"points[" + std::to_string(k + 1) + "]", "is not finite"});
    if (!problems.empty()) return problems;
    double extent_m = 0.0;
    for (const auto& point : line.points_m)
        for (std::size_t axis = 0; axis < 3; ++axis)
            extent_m = std::max(extent_m, std::abs(point[axis] - line.points_m.front()[axis]));
    if (!(extent_m > 20.0 * line.noise_m))
        problems.push_back({"noise_m", "is " + metres(line.noise_m) +
                                           ", too much for points that lie within " + metres(extent_m) +
                                           "; check the units of both"});
    return problems;
}

MeasuredConduit measured_conduit(const CentreLine& line) {
    if (const auto problems = problems_of(line); !problems.empty()) throw InvalidInput(problems);
    const Grouped points = grouped(line);
    const SmoothLine smooth(points.points_m, points.noise_m);
    const Curvatures all = curvatures_of(smooth, points);
    const double found_rad = turning_rad(all, all.found).sum();
    std::vector<double> totals_rad;
    for (const LinePoints& each : all.replicated) totals_rad.push_back(turning_rad(all, each).sum());
    const double open_rad = deviation_about(totals_rad, found_rad);
    const std::vector<Part> parts =
        parts_of(all, smooth.reach_m(), std::max(turning_tolerance_rad, 2.0 * open_rad));
    const std::vector<Beside> beside = beside_bends(all, parts);
    const std::vector<double> wrap_rad = wrap_of_parts(all, all.found, parts, beside);
    std::vector<std::vector<double>> replicated_rad(parts.size());  // parts x replicates
    for (std::size_t r = 0; r < all.replicated.size(); ++r) {
        const std::vector<double> each = wrap_of_parts(all, all.replicated[r], parts, beside);
        for (std::size_t k = 0; k < parts.size(); ++k) replicated_rad[k].push_back(each[k]);
        totals_rad[r] = sum_of(each);
    }

    MeasuredConduit conduit;
    conduit.wrap_rad = sum_of(wrap_rad);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const double length_m = all.length_m.segment(parts[k].first, parts[k].end - parts[k].first).sum();
        conduit.pieces.push_back({length_m, parts[k].is_bend ? length_m / wrap_rad[k] : straight});
        conduit.wrap_deviation_rad.push_back(deviation_about(replicated_rad[k], wrap_rad[k]));
    }
    // What was taken for straight may be bent by as much as was found of it beyond what counts for the bends.
    const double left_out_rad = found_rad - conduit.wrap_rad;
    conduit.total_deviation_rad = std::hypot(deviation_about(totals_rad, conduit.wrap_rad), left_out_rad);
    conduit.residual_m = std::sqrt((points.points_m - smooth.points_m()).squaredNorm() /
                                   (3.0 * static_cast<double>(points.points_m.rows())));
    return conduit;
}

}  // namespace capstan
