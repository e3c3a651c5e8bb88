#include "level_masks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/hash.h"
#include "chart/chart_mask.h"
#include "io/mask_file.h"
#include "samples.h"

namespace lumel::samples {
namespace {

class Random {
public:
    explicit Random(std::uint64_t seed) : state_(mix64(seed + 1)) {}
    double unit() {  // [0, 1)
        state_ += 0x9e3779b97f4a7c15ull;
        return static_cast<double>(mix64(state_) >> 11) * 0x1p-53;
    }
    double between(double low, double high) { return low + (high - low) * unit(); }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(unit() * n); }

private:
    std::uint64_t state_;
};

struct Shape {
    std::vector<UvTriangle> triangles;

    void triangle(Vec2 a, Vec2 b, Vec2 c) { triangles.push_back({a, b, c}); }
    void quad(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
};

Vec2 on_ellipse(double angle, double rx, double ry) {
    return {static_cast<float>(rx * std::cos(angle)), static_cast<float>(ry * std::sin(angle))};
}

constexpr double kTurn = 6.283185307179586;

// Cells of a coarse grid, joined side by side: L, U, T and stairs.
void add_cells(Shape& shape, Random& random) {
    constexpr std::uint32_t n = 4;
    std::array<float, n + 1> xs{}, ys{};
    for (std::uint32_t i = 1; i <= n; ++i) {
        xs[i] = xs[i - 1] + static_cast<float>(random.between(0.3, 1.5));
        ys[i] = ys[i - 1] + static_cast<float>(random.between(0.3, 1.5));
    }
    std::array<bool, n * n> full{};
    std::uint32_t x = random.below(n), y = random.below(n);
    for (std::uint32_t step = 4 + random.below(16); step > 0; --step) {
        full[y * n + x] = true;
        std::uint32_t& moved = random.unit() < 0.5 ? x : y;
        moved = random.unit() < 0.5 ? std::min(n - 1, moved + 1) : moved - (moved > 0 ? 1 : 0);
    }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i)
            if (full[j * n + i])
                shape.quad({xs[i], ys[j]}, {xs[i + 1], ys[j]}, {xs[i + 1], ys[j + 1]}, {xs[i], ys[j + 1]});
}

Shape make_shape(Random& random, double width, double height) {
    Shape shape;
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const bool tiny = std::max(width, height) < 2.5;
    if (random.unit() < (tiny ? 0.8 : 0.42)) {
        shape.quad({0, 0}, {w, 0}, {w, h}, {0, h});
        return shape;
    }
    const double kind = random.unit();
    if (tiny || kind < 0.2) {  // half of a rectangle
        const std::array<Vec2, 4> corners{{{0, 0}, {w, 0}, {w, h}, {0, h}}};
        const std::uint32_t first = random.below(4);
        shape.triangle(corners[first], corners[(first + 1) % 4], corners[(first + 2) % 4]);
    } else if (kind < 0.35) {  // a rectangle turned
        const double angle = random.between(0.05, 1.5);
        const Vec2 a = on_ellipse(angle, width, width), b = on_ellipse(angle + 0.25 * kTurn, height, height);
        shape.quad({0, 0}, a, a + b, b);
    } else if (kind < 0.6) {  // discs and polygons
        const std::uint32_t n = random.unit() < 0.35 ? 24 : 4 + random.below(5);
        const double phase = random.between(0.0, kTurn);
        for (std::uint32_t i = 0; i < n; ++i)
            shape.triangle({0, 0}, on_ellipse(phase + kTurn * i / n, width, height),
                           on_ellipse(phase + kTurn * (i + 1) / n, width, height));
    } else if (kind < 0.68) {  // rings and frames
        const std::uint32_t n = random.unit() < 0.5 ? 4 : 20;
        const double inner = random.between(0.35, 0.85), phase = n == 4 ? 0.125 * kTurn : 0.0;
        for (std::uint32_t i = 0; i < n; ++i) {
            const double from = phase + kTurn * i / n, to = phase + kTurn * (i + 1) / n;
            shape.quad(on_ellipse(from, width, height), on_ellipse(to, width, height),
                       on_ellipse(to, inner * width, inner * height), on_ellipse(from, inner * width, inner * height));
        }
    } else {
        add_cells(shape, random);
    }
    return shape;
}

ChartMask draw(const Shape& shape, std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint32_t> all(shape.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    Vec2 low = shape.triangles[0][0], high = low;
    for (const UvTriangle& t : shape.triangles)
        for (const Vec2 p : t) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    return make_mask(all, shape.triangles, low, high, width, height);
}

class Level {
public:
    explicit Level(const LevelMasks& level) : level_(level), random_(level.seed), scale_(solve_scale()) {}

    std::vector<ChartMask> run() {
        std::vector<ChartMask> out;
        while (out.size() < level_.charts) {
            const auto power = [&](double factor, double exponent, double most) {
                return static_cast<std::uint32_t>(std::min(most, factor * std::pow(1.0 - random_.unit(), -exponent)));
            };
            const std::uint32_t charts = 1 + power(2.0, 0.6, 60.0);
            const std::uint32_t instances = level_.instanced ? std::max(1u, power(1.5, 0.87, 400.0)) : 1;
            std::vector<ChartMask> masks;
            for (std::uint32_t c = 0; c < charts; ++c) masks.push_back(one());
            // Very large pieces are rarely placed many times.
            for (std::uint32_t i = 0; i < instances && out.size() < level_.charts; ++i)
                for (const ChartMask& mask : masks) out.push_back(mask.used > 2000 && i > 2 ? one() : mask);
        }
        out.resize(level_.charts);
        return out;
    }

private:
    struct Size {
        std::uint32_t width, height;
    };
    Size size(Random& random, double scale) const {
        double extent = scale * std::pow(1.0 - random.unit(), -1.0 / level_.fall_off);
        if (extent > level_.largest) extent = level_.largest * random.between(0.3, 1.0);
        const double kind = random.unit();
        const double aspect = kind < 0.35 ? 1.0 : std::exp(random.between(-1.0, 1.0) * (kind < 0.85 ? 1.0 : 2.6));
        const auto steps = [&](double length) {
            return static_cast<std::uint32_t>(std::clamp(std::floor(length + 0.5), 1.0, 1499.0)) + 1;
        };
        return {steps(extent * std::sqrt(aspect)), steps(extent / std::sqrt(aspect))};
    }

    ChartMask one() {
        const Size s = size(random_, scale_);
        return draw(make_shape(random_, s.width - 1, s.height - 1), s.width, s.height);
    }

    // The scale at which a sample of charts has the wanted mean: four fifths of a box are used.
    [[nodiscard]] double solve_scale() const {
        const double mean = level_.texels / level_.charts;
        double low = 0.05, high = 50.0;
        for (int step = 0; step < 20; ++step) {
            const double scale = std::sqrt(low * high);
            Random random(level_.seed ^ 0x77);
            double sum = 0.0;
            constexpr int kSample = 20'000;
            for (int i = 0; i < kSample; ++i) {
                const Size s = size(random, scale);
                sum += 0.8 * s.width * s.height;
            }
            (sum / kSample < mean ? low : high) = scale;
        }
        return std::sqrt(low * high);
    }

    const LevelMasks& level_;
    Random random_;
    double scale_;
};

}  // namespace

std::vector<ChartMask> level_masks(const LevelMasks& level) { return Level(level).run(); }

Status write_charts(const std::filesystem::path& folder, std::uint32_t charts, std::uint64_t seed) {
    LevelMasks level;
    level.texels *= static_cast<double>(charts) / level.charts;
    level.charts = charts;
    level.seed = seed;
    return write_masks(folder / "level.msk", level_masks(level));
}

}  // namespace lumel::samples
