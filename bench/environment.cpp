#include "environment.h"

#include <algorithm>
#include <cmath>

namespace lumel::bench {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

Vec3d unit(Vec3d v) {
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {v[0] / length, v[1] / length, v[2] / length};
}
double dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A von Mises-Fisher lobe of height 1.
double lobe(const Vec3d& d, const Vec3d& axis, double sharpness) {
    return std::exp(sharpness * (dot(d, unit(axis)) - 1));
}

struct Directions {
    std::vector<Vec3d> d;
    std::vector<double> w;
};
Directions upper_directions(std::size_t rings, std::size_t steps) {
    const HemisphereGrid grid = hemisphere_grid(rings, steps);
    Directions out{{}, grid.weight};
    for (const Vec3& n : grid.normal)
        out.d.push_back(unit({static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)}));
    return out;
}

template <class RadianceOf>
Environment made_up(std::string name, const Directions& directions, RadianceOf&& radiance) {
    Environment out;
    out.name = std::move(name);
    for (std::size_t i = 0; i < directions.d.size(); ++i)
        out.add(directions.d[i], directions.w[i], radiance(directions.d[i]));
    return out;
}

Vec3d mix(const Vec3d& horizon, const Vec3d& zenith, double z) {
    Vec3d out;
    for (std::size_t c = 0; c < 3; ++c) out[c] = horizon[c] * (1 - z) + zenith[c] * z;
    return out;
}
Vec3d plus(const Vec3d& a, const Vec3d& b, double scale) {
    return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

// How much of source interval [i, i + 1) lies in the k-th of n equal parts of `size`.
double overlap(std::uint32_t i, std::uint32_t k, std::uint32_t n, std::uint32_t size) {
    const double low = static_cast<double>(k) * size / n, high = static_cast<double>(k + 1) * size / n;
    return std::max(0.0, std::min(high, i + 1.0) - std::max(low, static_cast<double>(i)));
}

}  // namespace

Environment environment_of(const Image& map, std::string name) {
    constexpr std::uint32_t kHeight = 64, kWidth = 128;
    Environment out;
    out.name = std::move(name);
    for (std::uint32_t row = 0; row < kHeight; ++row) {
        const double top = std::cos(kPiDouble * row / kHeight), low = std::cos(kPiDouble * (row + 1) / kHeight);
        const double v = kPiDouble * (row + 0.5) / kHeight;
        for (std::uint32_t column = 0; column < kWidth; ++column) {
            Vec3d sum{};
            double weight = 0;
            for (std::uint32_t y = row * map.height / kHeight; y * kHeight < (row + 1) * map.height; ++y)
                for (std::uint32_t x = column * map.width / kWidth; x * kWidth < (column + 1) * map.width; ++x) {
                    const double w = std::sin(kPiDouble * (y + 0.5) / map.height) *
                                     overlap(y, row, kHeight, map.height) * overlap(x, column, kWidth, map.width);
                    for (std::uint32_t c = 0; c < 3; ++c) sum[c] += w * static_cast<double>(map.at(x, y)[c]);
                    weight += w;
                }
            for (double& s : sum) s /= weight;
            const double u = 2 * kPiDouble * (column + 0.5) / kWidth - kPiDouble;
            out.add({std::sin(v) * std::sin(u), -std::sin(v) * std::cos(u), std::cos(v)},
                    (top - low) * 2 * kPiDouble / kWidth, sum);
        }
    }
    return out;
}

std::vector<Environment> made_up_lights() {
    const Directions all = upper_directions(128, 256);
    const auto grey = [](double v) { return Vec3d{v, v, v}; };
    std::vector<Environment> out;
    out.push_back(made_up("constant", all, [&](const Vec3d&) { return grey(1); }));
    out.push_back(made_up("gradient", all, [](const Vec3d& d) {
        return mix({0.9, 0.9, 0.95}, {0.15, 0.35, 0.9}, d[2]);
    }));
    out.push_back(made_up("sun", all, [](const Vec3d& d) {
        return plus(mix({0.6, 0.65, 0.7}, {0.25, 0.45, 0.9}, d[2]), {1, 0.85, 0.6},
                    25 * lobe(d, {std::cos(0.7), 0.3, std::sin(0.7)}, 60));
    }));
    out.push_back(made_up("two colours", all, [&](const Vec3d& d) {
        const Vec3d first = plus(grey(0.05), {1, 0.2, 0.1}, 6 * lobe(d, {std::sin(1.05), 0, std::cos(1.05)}, 25));
        return plus(first, {0.1, 0.5, 1}, 6 * lobe(d, {-std::sin(0.9), 0.5, std::cos(0.9)}, 25));
    }));
    out.push_back(made_up("window", all, [&](const Vec3d& d) {
        return plus(grey(0.05), {1, 0.95, 0.9}, 12 * lobe(d, {std::sin(1.3), 0.2, std::cos(1.3)}, 40));
    }));
    out.push_back(made_up("ring", all, [&](const Vec3d& d) {
        return plus(grey(0.05), {1, 0.9, 0.8}, std::exp(-(d[2] / 0.15) * (d[2] / 0.15)));
    }));
    out.push_back(made_up("hemisphere and direction", all, [&](const Vec3d&) { return grey(0.5); }));
    out.back().add({0.6, 0.2, std::sqrt(1 - 0.4)}, 1.0, {1.2 * kPiDouble, kPiDouble, 0.8 * kPiDouble});
    return out;
}

Environment random_light(std::uint64_t k) {
    static const Directions kDirections = upper_directions(24, 48);
    std::uint64_t state = k;
    const auto uniform = [&state] {  // splitmix64
        std::uint64_t z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    };
    Environment out = made_up("random", kDirections, [](const Vec3d&) { return Vec3d{0.1, 0.1, 0.1}; });
    state = k * 1000003 + 17;
    const int lobes = 1 + static_cast<int>(3 * uniform());
    for (int i = 0; i < lobes; ++i) {
        const double z = uniform(), turn = 2 * kPiDouble * uniform(), r = std::sqrt(1 - z * z);
        const double sharpness = std::exp(4 * uniform()), strength = -std::log(1 - uniform()) * sharpness;
        const Vec3d axis{r * std::cos(turn), r * std::sin(turn), z};
        const Vec3d color{0.1 + 0.9 * uniform(), 0.1 + 0.9 * uniform(), 0.1 + 0.9 * uniform()};
        for (std::size_t j = 0; j < out.direction.size(); ++j)
            out.radiance[j] = plus(out.radiance[j], color, strength * lobe(out.direction[j], axis, sharpness));
    }
    return out;
}

Environment turned(const Environment& environment, Vec3d up, bool above_only) {
    const Vec3d n = unit(up);
    const double sign = n[2] >= 0 ? 1.0 : -1.0, a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    const Vec3d t{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}, s{b, sign + n[1] * n[1] * a, -n[1]};
    Environment out;
    out.name = environment.name;
    for (std::size_t i = 0; i < environment.direction.size(); ++i) {
        const Vec3d& d = environment.direction[i];
        const Vec3d local{dot(d, t), dot(d, s), dot(d, n)};
        if (!above_only || local[2] > 0) out.add(local, environment.solid_angle[i], environment.radiance[i]);
    }
    return out;
}

std::vector<Vec3d> irradiance(const Environment& environment, const std::vector<Vec3>& normals) {
    std::vector<Vec3d> out(normals.size());
    for (std::size_t k = 0; k < normals.size(); ++k) {
        const Vec3& n = normals[k];
        const double x = static_cast<double>(n.x), y = static_cast<double>(n.y), z = static_cast<double>(n.z);
        double r = 0, g = 0, b = 0;
        for (std::size_t i = 0; i < environment.direction.size(); ++i) {
            const Vec3d& d = environment.direction[i];
            const double w = std::max(x * d[0] + y * d[1] + z * d[2], 0.0) * environment.solid_angle[i];
            r += w * environment.radiance[i][0];
            g += w * environment.radiance[i][1];
            b += w * environment.radiance[i][2];
        }
        out[k] = {r / kPiDouble, g / kPiDouble, b / kPiDouble};
    }
    return out;
}

RadianceSh<Vec3, 9> project(const Environment& environment) {
    std::array<Vec3d, 9> sum{};
    for (std::size_t i = 0; i < environment.direction.size(); ++i) {
        const Vec3d& d = environment.direction[i];
        const ShBasis y = sh_basis({static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])});
        for (std::size_t k = 0; k < 9; ++k)
            sum[k] = plus(sum[k], environment.radiance[i], static_cast<double>(y[k]) * environment.solid_angle[i]);
    }
    RadianceSh<Vec3, 9> out;
    for (std::size_t k = 0; k < 9; ++k)
        out.c[k] = {static_cast<float>(sum[k][0]), static_cast<float>(sum[k][1]), static_cast<float>(sum[k][2])};
    return out;
}

TexelLight exact_light(const Environment& environment, const HemisphereGrid& grid, const std::vector<Vec3d>& on_grid) {
    std::vector<double> gram(81), right(27);
    for (std::size_t k = 0; k < grid.normal.size(); ++k) {
        const ShBasis y = sh_basis(grid.normal[k]);
        for (std::size_t i = 0; i < 9; ++i) {
            const double w = grid.weight[k] * static_cast<double>(y[i]);
            for (std::size_t j = 0; j < 9; ++j) gram[9 * i + j] += w * static_cast<double>(y[j]);
            for (std::size_t c = 0; c < 3; ++c) right[3 * i + c] += w * on_grid[k][c];
        }
    }
    solve_positive_definite(std::move(gram), 9, right, 3);
    TexelLight out;
    out.radiance = project(environment);
    for (std::size_t i = 0; i < 9; ++i)
        for (std::size_t c = 0; c < 3; ++c) out.fit.c[i][c] = static_cast<float>(right[3 * i + c]);
    const Vec3d iz = irradiance(environment, {Vec3{0, 0, 1}})[0];
    out.irradiance = {static_cast<float>(iz[0]), static_cast<float>(iz[1]), static_cast<float>(iz[2])};
    return out;
}

}  // namespace lumel::bench
