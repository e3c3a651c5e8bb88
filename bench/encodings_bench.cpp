// The error of every encoding over the normals of the hemisphere: under made-up lights, sky maps in ten orientations,
// and random lights; what occlusion costs probes; what the hemispherical Gram matrix and the search are worth; blending
// of light sets; texels per second.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>

#include "bench.h"
#include "encode/encodings.h"
#include "encode/hhd.h"
#include "encode/l1.h"
#include "encode/lobe_search.h"
#include "environment.h"
#include "expected_errors.h"
#include "io/image_io.h"
#include "load.h"

namespace lumel::bench {
namespace {

struct Options {
    std::string maps, only;
    std::uint32_t random = 150, speed_texels = 1u << 18;
};

// The normals that errors are measured over.
const HemisphereGrid& grid() {
    static const HemisphereGrid kGrid = hemisphere_grid(24, 48);
    return kGrid;
}

// A light, what is true of it, and what models make of it.
struct Case {
    Environment environment;
    std::vector<Vec3d> truth;  // on the grid
    TexelLight light;
    double mean = 0.0;

    explicit Case(Environment e) : environment(std::move(e)), truth(irradiance(environment, grid().normal)) {
        light = exact_light(environment, grid(), truth);
        for (std::size_t k = 0; k < truth.size(); ++k)
            mean += grid().weight[k] * (truth[k][0] + truth[k][1] + truth[k][2]) / (6 * static_cast<double>(kPi));
    }
};
using Decoded = std::function<Vec3(Vec3 normal)>;
using Model = std::function<Decoded(const Case&)>;
struct Row {
    const char* name;
    Model model;
};

double squared_error(const Case& c, const Decoded& decoded) {
    double sum = 0;
    for (std::size_t k = 0; k < c.truth.size(); ++k) {
        const Vec3 v = decoded(grid().normal[k]);
        for (std::size_t i = 0; i < 3; ++i) {
            const double e = static_cast<double>(v[i]) - c.truth[k][i];
            sum += grid().weight[k] * e * e;
        }
    }
    return sum / (6 * static_cast<double>(kPi));
}

// Models
// ---------------------------------------------------------------------------------------------------------------

Decoded decoded_by(const Encoding& encoding, const TexelLight& light) {
    Numbers numbers{};
    encoding.solve(std::span(&light, 1), std::span(&numbers, 1));
    return [&encoding, numbers](Vec3 n) { return encoding.decode(numbers, n); };
}
Model encoded(const Encoding& encoding) {
    return [&encoding](const Case& c) { return decoded_by(encoding, c.light); };
}
// As from a stored master: nine coefficients and the irradiance about n_v.
Model from_master(const Encoding& encoding) {
    return [&encoding](const Case& c) {
        TexelLight light = c.light;
        light.fit = fit_irradiance(light.radiance);
        return decoded_by(encoding, light);
    };
}

template <std::size_t J>
Model nearest(std::array<float, J> (*basis)(Vec3)) {
    return [basis, fit = std::make_shared<BasisFit<J>>(basis)](const Case& c) -> Decoded {
        return [basis, v = fit->nearest(c.light.fit)](Vec3 n) {
            const std::array<float, J> b = basis(n);
            Vec3 out;
            for (std::size_t j = 0; j < J; ++j) out += v[j] * b[j];
            return out;
        };
    };
}

std::array<float, 4> linear_basis(Vec3 n) { return {1, n.x, n.y, n.z}; }
std::array<float, 6> h6_basis(Vec3 n) { return {1, n.x, n.y, n.z, n.x * n.y, n.x * n.x - n.y * n.y}; }
std::array<float, 5> cube_basis(Vec3 n) {
    const auto square = [](float v) { return v > 0 ? v * v : 0; };
    return {square(n.x), square(-n.x), square(n.y), square(-n.y), square(n.z)};
}

Decoded linear_exact_at_normal(const Case& c) {
    return [l1 = encode_l1(linear_part(c.light.radiance))](Vec3 n) {
        Vec3 out;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 r1 = l1.l1n[i] * l1.l0[i];
            out[i] = l1.l0[i] * (1 - n.z) + 2 * (n.x * r1.x + n.y * r1.y) + 4 * n.z * r1.z;
        }
        return out;
    };
}

Decoded hhd_without_ring(const RadianceSh<Vec3, 4>& radiance) {
    std::array<Hhd, 3> hhd;
    for (std::size_t c = 0; c < 3; ++c) hhd[c] = solve_hhd(light_moments(radiance, c));
    return [hhd](Vec3 n) { return Vec3{evaluate(hhd[0], n), evaluate(hhd[1], n), evaluate(hhd[2], n)}; };
}

// Radiance fitted over the hemisphere, then convolved: not to be used.
Decoded radiance_fitted(const Case& c) {
    std::vector<double> gram(16), right(12);
    for (std::size_t i = 0; i < 4; ++i) {
        std::array<float, 9> unit{};
        unit[i] = 1;
        const std::array<float, 9> column = multiply(kHemisphereGram, unit);
        for (std::size_t j = 0; j < 4; ++j) gram[4 * j + i] = static_cast<double>(column[j]);
        for (std::size_t k = 0; k < 3; ++k) right[3 * i + k] = static_cast<double>(c.light.radiance.c[i][k]);
    }
    solve_positive_definite(std::move(gram), 4, right, 3);
    RadianceSh<Vec3, 4> radiance;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 3; ++k) radiance.c[i][k] = static_cast<float>(right[3 * i + k]);
    return [sh = convolve_cosine(radiance)](Vec3 n) { return evaluate(sh, n); };
}

Decoded cube_sampled(const Case& c) {
    const std::vector<Vec3> axes{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    return [faces = irradiance(c.environment, axes)](Vec3 n) {
        const std::array<float, 5> b = cube_basis(n);
        Vec3 out;
        for (std::size_t j = 0; j < 5; ++j)
            for (std::size_t i = 0; i < 3; ++i) out[i] += b[j] * static_cast<float>(faces[j][i]);
        return out;
    };
}

// AHD and HHD with one weight
struct Lobes {
    Vec3 iz, direction;
    float weight;
    AmbientLobe ambient;
    Vec3 operator()(Vec3 n) const {
        const float a = ambient == AmbientLobe::uniform ? 1.0f : 0.5f * (1 + n.z);
        return iz * (weight * a + (1 - weight) * std::max(dot(n, direction), 0.0f) / direction.z);
    }
};

std::array<float, 9> luminance_target(const TexelLight& light) {
    std::array<float, 9> out = convolve_cosine(luminance(light.radiance)).c;
    for (float& v : out) v /= luminance(light.irradiance);
    return out;
}

Vec3 linear_direction_of(const TexelLight& light) {
    return optimal_linear_direction(luminance(light.radiance), Vec3{0, 0, 1});
}

enum class Direction { linear, searched };
Decoded lobes_of(const TexelLight& light, AmbientLobe ambient, const ZonalMatrix& gram, Direction direction) {
    const std::array<float, 9> target = luminance_target(light);
    const Vec3 start = linear_direction_of(light);
    // As the expected figures have it: not as low as can be where it comes from below.
    const Vec3 raised = normalize(Vec3{start.x, start.y, std::max(start.z, kLowestLobe)});
    LobeFit fit = fit_ambient_weight(target, raised, ambient, gram);
    if (direction == Direction::searched)
        search_lobes(std::span(&target, 1), std::span(&start, 1), ambient, gram, std::span(&fit, 1));
    return Lobes{light.irradiance, fit.direction, fit.ambient_weight, ambient};
}
Model lobes(AmbientLobe ambient, const ZonalMatrix& gram, Direction direction) {
    return [=](const Case& c) { return lobes_of(c.light, ambient, gram, direction); };
}

template <class F>
double golden(double low, double high, int steps, F&& f) {
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low), fa = f(a), fb = f(b);
    for (int i = 0; i < steps; ++i) {
        if (fa < fb) {
            high = b;
            b = a;
            fb = fa;
            a = high - kGolden * (high - low);
            fa = f(a);
        } else {
            low = a;
            a = b;
            fa = fb;
            b = low + kGolden * (high - low);
            fb = f(b);
        }
    }
    return fa < fb ? a : b;
}

// The search that was published, and that the expected figures come from: golden section over the polar angle within
// golden section over the azimuth, 60 degrees to either side of the optimal linear direction.
template <class Error>
Vec3 nested_search(Vec3 start, Error&& error) {
    constexpr double kThird = 1.0471975511965976;
    const double widest = std::acos(static_cast<double>(kLowestLobe));
    const double azimuth = std::atan2(static_cast<double>(start.y), static_cast<double>(start.x));
    const auto direction = [](double theta, double phi) {
        return Vec3{static_cast<float>(std::sin(theta) * std::cos(phi)),
                    static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
    };
    const auto best_at = [&](double phi) {
        return golden(0, widest, 24, [&](double t) { return error(direction(t, phi)); });
    };
    const double phi =
        golden(azimuth - kThird, azimuth + kThird, 14, [&](double p) { return error(direction(best_at(p), p)); });
    return direction(best_at(phi), phi);
}

Model nested_lobes(AmbientLobe ambient, const ZonalMatrix& gram) {
    return [=](const Case& c) -> Decoded {
        const std::array<float, 9> target = luminance_target(c.light);
        const Vec3 d = nested_search(linear_direction_of(c.light), [&](Vec3 at) {
            return static_cast<double>(fit_ambient_weight(target, at, ambient, gram).error);
        });
        return Lobes{c.light.irradiance, d, fit_ambient_weight(target, d, ambient, gram).ambient_weight, ambient};
    };
}

// The same with true clamped cosines instead of three bands.
class ExactLobes {
public:
    // Of luminance, or of one channel.
    ExactLobes(const Case& c, AmbientLobe ambient, std::size_t channel = 3) : ambient_(ambient) {
        const auto value = [&](const Vec3& v) { return channel < 3 ? v[channel] : luminance(v); };
        const float iz = value(c.light.irradiance);
        for (const Vec3d& t : c.truth)
            target_.push_back(static_cast<double>(
                value(Vec3{static_cast<float>(t[0]), static_cast<float>(t[1]), static_cast<float>(t[2])}) / iz));
    }
    // Best weight and its error.
    [[nodiscard]] std::array<double, 2> fit(Vec3 d) const {
        double uu = 0, ur = 0;
        for (std::size_t k = 0; k < target_.size(); ++k) {
            const auto [ambient, lobe] = values(k, d);
            uu += grid().weight[k] * (ambient - lobe) * (ambient - lobe);
            ur += grid().weight[k] * (ambient - lobe) * (target_[k] - lobe);
        }
        const double w = uu > 1e-12 ? std::clamp(ur / uu, 0.0, 1.0) : 1.0;
        double error = 0;  // with weight 1 the same number for every direction
        for (std::size_t k = 0; k < target_.size(); ++k) {
            const auto [ambient, lobe] = values(k, d);
            const double e = w * ambient + (1 - w) * lobe - target_[k];
            error += grid().weight[k] * e * e;
        }
        return {w, error};
    }

private:
    [[nodiscard]] std::array<double, 2> values(std::size_t k, Vec3 d) const {
        const Vec3 n = grid().normal[k];
        const float ambient = ambient_ == AmbientLobe::uniform ? 1.0f : 0.5f * (1 + n.z);
        return {static_cast<double>(ambient), static_cast<double>(std::max(dot(n, d), 0.0f) / d.z)};
    }

    AmbientLobe ambient_;
    std::vector<double> target_;
};

enum class Weights { luminance, rgb };
Model exact_lobes(AmbientLobe ambient, Weights weights) {
    return [=](const Case& c) -> Decoded {
        const ExactLobes exact(c, ambient);
        const Vec3 d = nested_search(linear_direction_of(c.light), [&](Vec3 at) { return exact.fit(at)[1]; });
        Vec3 w = Vec3{1, 1, 1} * static_cast<float>(exact.fit(d)[0]);
        if (weights == Weights::rgb)
            for (std::size_t i = 0; i < 3; ++i) w[i] = static_cast<float>(ExactLobes(c, ambient, i).fit(d)[0]);
        return [=, iz = c.light.irradiance](Vec3 n) {
            const float a = ambient == AmbientLobe::uniform ? 1.0f : 0.5f * (1 + n.z);
            const float lobe = std::max(dot(n, d), 0.0f) / d.z;
            return iz * (w * (a - lobe) + Vec3{1, 1, 1} * lobe);
        };
    };
}

// HHD of the luminance's moments as it comes, not as texels store it.
Decoded hhd_closed(const Case& c) {
    const RadianceSh<float, 9> l = luminance(c.light.radiance);
    const Hhd hhd = solve_hhd(light_moments({l.c[0], l.c[1], l.c[2], l.c[3]}));
    return
        [hhd, color = c.light.irradiance / luminance(c.light.irradiance)](Vec3 n) { return color * evaluate(hhd, n); };
}

constexpr auto kAhdLobe = AmbientLobe::uniform, kHhdLobe = AmbientLobe::hemisphere;

std::vector<Row> texel_rows() {
    return {
        {"scalar I_z", encoded(kIrradianceEncoding)},
        {"L1 moments, linear", encoded(kL1Linear)},
        {"L1 moments, linear, I_z fixed", linear_exact_at_normal},
        {"L1 moments, Hazel", encoded(kL1Hazel)},
        {"L1 moments, HHD", [](const Case& c) { return hhd_without_ring(linear_part(c.light.radiance)); }},
        {"L1 moments, HHD+ring", encoded(kL1Hhd)},
        {"H4", nearest<4>(linear_basis)},
        {"HLSH", encoded(kHlsh)},
        {"L1 radiance over the hemisphere", radiance_fitted},
        {"ambient cube, sampled", cube_sampled},
        {"ambient cube, fitted", nearest<5>(cube_basis)},
        {"H6", nearest<6>(h6_basis)},
        {"ZH3 hallucinated", encoded(kZh3Hallucinated)},
        {"ZH3 stored", encoded(kZh3)},
        {"L2 moments", encoded(kL2)},
        {"L2 fitted", [](const Case& c) -> Decoded { return [f = c.light.fit](Vec3 n) { return evaluate(f, n); }; }},
        {"AHD sphere Gram, linear direction", lobes(kAhdLobe, kIdentityMatrix, Direction::linear)},
        {"AHD hemisphere Gram, linear direction", lobes(kAhdLobe, kHemisphereGram, Direction::linear)},
        {"AHD hemisphere Gram, search", nested_lobes(kAhdLobe, kHemisphereGram)},
        {"AHD exact lobes, search", exact_lobes(kAhdLobe, Weights::luminance)},
        {"AHD search, weight per channel", exact_lobes(kAhdLobe, Weights::rgb)},
        {"HHD sphere Gram, linear direction", lobes(kHhdLobe, kIdentityMatrix, Direction::linear)},
        {"HHD hemisphere Gram, linear direction", lobes(kHhdLobe, kHemisphereGram, Direction::linear)},
        {"HHD hemisphere Gram, search", nested_lobes(kHhdLobe, kHemisphereGram)},
        {"HHD exact lobes, search", exact_lobes(kHhdLobe, Weights::luminance)},
        {"HHD search, weight per channel", exact_lobes(kHhdLobe, Weights::rgb)},
        {"HHD closed form", hhd_closed},
        // Not in the other program.
        {"IrradZ-AHD", encoded(kIrradZAhd)},
        {"IrradZ-HHD", encoded(kIrradZHhd)},
        {"IrradZ-AHD, weight per channel", encoded(kIrradZAhdRgb)},
        {"IrradZ-HHD, weight per channel", encoded(kIrradZHhdRgb)},
        {"IrradZ-HHD in closed form", encoded(kIrradZHhdClosed)},
        {"L1 fitted, linear", encoded(kL1LinearFit)},
        {"L1 fitted, Hazel", encoded(kL1HazelFit)},
        {"L1 monochrome", encoded(kL1Mono)},
        {"H4, I_z fixed", encoded(kH4)},
        {"H6, I_z fixed", encoded(kH6)},
        {"AHD plain", encoded(kAhd)},
        {"ambient cube, I_z fixed", encoded(kAmbientCube)},
        {"RNM, I_z fixed", encoded(kRnm)},
        {"5 spherical Gaussians, I_z fixed", encoded(kSphericalGaussians)},
        {"HLSH from the master", from_master(kHlsh)},
        {"H6 from the master, I_z fixed", from_master(kH6)},
        {"L1 fitted, Hazel, from the master", from_master(kL1HazelFit)},
        {"L2 fitted, from the master",
         [](const Case& c) -> Decoded {
             return [f = fit_irradiance(c.light.radiance)](Vec3 n) { return evaluate(f, n); };
         }},
    };
}

// A probe sees the whole sphere; the texel's surface hides the lower half.
std::vector<Row> probe_rows() {
    const Vec3 up{0, 0, 1};
    return {
        {"L2, no occlusion",
         [](const Case& c) -> Decoded {
             return [f = convolve_cosine(c.light.radiance)](Vec3 n) { return evaluate(f, n); };
         }},
        {"L2 x Gram (9 coeff.)",
         [](const Case& c) -> Decoded {
             const RadianceSh<Vec3, 9> seen{multiply(kHemisphereGram, c.light.radiance.c)};
             return [f = convolve_cosine(seen)](Vec3 n) { return evaluate(f, n); };
         }},
        {"quadratic to linear",
         [up](const Case& c) -> Decoded {
             return [f = convolve_cosine(multiply_hemisphere_linear(c.light.radiance, up))](Vec3 n) {
                 return evaluate(f, n);
             };
         }},
        {"HLSH",
         [up](const Case& c) -> Decoded {
             return [h = multiply_cone(c.light.radiance, up, 0.0f)](Vec3 n) {
                 return h.ambient + detail::row_times(n, h.linear);
             };
         }},
        {"quadratic to linear to HHD",
         [up](const Case& c) { return hhd_without_ring(multiply_hemisphere_linear(c.light.radiance, up)); }},
    };
}

// The slides' own experiment: SH of the whole sphere, no occlusion, errors over the upper hemisphere.
std::vector<Row> sphere_rows() {
    return {
        {"AHD sphere Gram, linear direction", lobes(kAhdLobe, kIdentityMatrix, Direction::linear)},
        {"AHD sphere Gram, search", nested_lobes(kAhdLobe, kIdentityMatrix)},
        {"AHD hemisphere Gram, linear direction", lobes(kAhdLobe, kHemisphereGram, Direction::linear)},
        {"AHD hemisphere Gram, search", nested_lobes(kAhdLobe, kHemisphereGram)},
        {"HHD sphere Gram, linear direction", lobes(kHhdLobe, kIdentityMatrix, Direction::linear)},
        {"HHD sphere Gram, search", nested_lobes(kHhdLobe, kIdentityMatrix)},
        {"HHD hemisphere Gram, linear direction", lobes(kHhdLobe, kHemisphereGram, Direction::linear)},
        {"HHD hemisphere Gram, search", nested_lobes(kHhdLobe, kHemisphereGram)},
        {"AHD hemisphere Gram, Lumel's search", lobes(kAhdLobe, kHemisphereGram, Direction::searched)},
        {"HHD hemisphere Gram, Lumel's search", lobes(kHhdLobe, kHemisphereGram, Direction::searched)},
    };
}

// Tables
// ---------------------------------------------------------------------------------------------------------------

class Table {
public:
    explicit Table(const char* name) : name_(name) {}

    void print(const char* model, const std::string& light, std::size_t column, double value) {
        const double expected = look_up(model, column);
        if (std::isnan(expected)) {
            std::printf("%s,\"%s\",%s,%.4f,,,\n", name_, model, light.c_str(), value);
            return;
        }
        const double difference = std::fabs(value - expected);
        const bool near = difference <= 0.001 || difference <= 0.02 * expected;
        ++compared_;
        near_ += near ? 1 : 0;
        std::printf("%s,\"%s\",%s,%.4f,%.3f,%.3f,%s\n", name_, model, light.c_str(), value, expected,
                    expected > 0 ? value / expected : 1.0, near ? "yes" : "no");
    }
    ~Table() {
        if (compared_) std::fprintf(stderr, "%s: %d of %d entries within 2 %% or 0.001\n", name_, near_, compared_);
    }
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;

private:
    [[nodiscard]] double look_up(const char* model, std::size_t column) const {
        for (const ExpectedRow& row : expected_errors())
            if (std::string_view(row.table) == name_ && std::string_view(row.model) == model) return row.error[column];
        return std::numeric_limits<double>::quiet_NaN();
    }
    const char* name_;
    int compared_ = 0, near_ = 0;
};

constexpr std::size_t kAllMapsOfSynthetic = 7, kAllMaps = 14;

void print_made_up() {
    Table table("synthetic");
    const std::vector<Row> rows = texel_rows();
    std::size_t column = 0;
    for (Environment& environment : made_up_lights()) {
        const Case c(std::move(environment));
        for (const Row& row : rows)
            table.print(row.name, c.environment.name, column, std::sqrt(squared_error(c, row.model(c))) / c.mean);
        ++column;
    }
}

void print_random(std::uint32_t count) {
    const std::vector<Row> rows = texel_rows();
    std::vector<double> sum(rows.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        const Case c(random_light(k));
        for (std::size_t r = 0; r < rows.size(); ++r) sum[r] += squared_error(c, rows[r].model(c)) / (c.mean * c.mean);
    }
    for (std::size_t r = 0; r < rows.size(); ++r)
        std::printf("random,\"%s\",%u lights,%.4f,,,\n", rows[r].name, count, std::sqrt(sum[r] / count));
}

constexpr std::array<const char*, 14> kMaps{"drachenfels_cellar_512",
                                            "kloppenheim_05_512",
                                            "leadenhall_market_512",
                                            "noon_grass_512",
                                            "spiaggia_di_mondello_1k",
                                            "st_peters_square_night_512",
                                            "vestibule_512",
                                            "research_only/debevec_ennis_256",
                                            "research_only/debevec_grace_256",
                                            "research_only/debevec_grace_probe_512",
                                            "research_only/debevec_pisa_512",
                                            "research_only/debevec_uffizi_256",
                                            "research_only/vogl_construction_hall_512",
                                            "research_only/vogl_20060807_wells6_hd"};
constexpr Vec3d kUps[10] = {{0, 0, 1},  {1, 0, 0}, {-1, 0, 0}, {0, 1, 0},  {0, -1, 0},
                            {0, 0, -1}, {1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};

// Rows over the orientations of one map. Texels: each error over the texel's own mean, then root mean square. Probes
// and sphere: over the mean of all ten.
struct MapErrors {
    std::vector<double> relative, absolute;
    double mean = 0.0;  // of the ten means
};

MapErrors errors_on_map(const Environment& map, const std::vector<Row>& rows, bool above_only, bool truth_above_only) {
    MapErrors out{std::vector<double>(rows.size()), std::vector<double>(rows.size()), 0.0};
    constexpr double kCount = 10;
    for (const Vec3d& up : kUps) {
        Case c(turned(map, up, truth_above_only));
        // Probes: the truth is what the surface lets through, the model knows all of it.
        if (!above_only && truth_above_only) c.light.radiance = project(turned(map, up, false));
        out.mean += c.mean / kCount;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const double e = squared_error(c, rows[r].model(c));
            out.absolute[r] += e / kCount;
            out.relative[r] += e / (c.mean * c.mean) / kCount;
        }
    }
    return out;
}

// A sky map and its place in kMaps: not all of them need be there.
struct LoadedMap {
    std::size_t index;
    Environment environment;
};

void print_maps(const char* name, const std::vector<LoadedMap>& maps, const std::vector<Row>& rows, bool above_only,
                bool truth_above_only) {
    Table table(name);
    std::vector<double> all(rows.size());
    for (const LoadedMap& map : maps) {
        const MapErrors errors = errors_on_map(map.environment, rows, above_only, truth_above_only);
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const double squared = above_only ? errors.relative[r] : errors.absolute[r] / (errors.mean * errors.mean);
            all[r] += squared / static_cast<double>(maps.size());
            table.print(rows[r].name, map.environment.name, map.index, std::sqrt(squared));
        }
    }
    if (maps.size() != kMaps.size()) return;
    for (std::size_t r = 0; r < rows.size(); ++r) table.print(rows[r].name, "all", kAllMaps, std::sqrt(all[r]));
    if (!above_only) return;
    Table synthetic("synthetic");
    for (std::size_t r = 0; r < rows.size(); ++r)
        synthetic.print(rows[r].name, "all maps", kAllMapsOfSynthetic, std::sqrt(all[r]));
}

std::vector<LoadedMap> load_maps(const std::string& folder) {
    std::vector<LoadedMap> out;
    for (std::size_t i = 0; i < kMaps.size(); ++i) {
        const std::filesystem::path file = std::filesystem::path(folder) / (std::string(kMaps[i]) + ".hdr");
        if (!std::filesystem::exists(file)) {
            std::fprintf(stderr, "%s is not there: left out\n", file.c_str());
            continue;
        }
        out.push_back({i, environment_of(need(read_image(file)), file.stem().string())});
    }
    return out;
}

// Blending and speed
// ---------------------------------------------------------------------------------------------------

std::vector<TexelLight> random_texels(std::uint32_t count) {
    std::vector<TexelLight> out;
    for (std::uint32_t k = 0; k < count; ++k) {
        const Environment e = random_light(k);
        TexelLight light;
        light.radiance = project(e);
        light.fit = fit_irradiance(light.radiance);
        const Vec3d iz = irradiance(e, {Vec3{0, 0, 1}})[0];
        light.irradiance = {static_cast<float>(iz[0]), static_cast<float>(iz[1]), static_cast<float>(iz[2])};
        out.push_back(light);
    }
    return out;
}

TexelLight grey(TexelLight light) {
    const auto to_grey = [](Vec3& c) { c = Vec3{1, 1, 1} * luminance(c); };
    std::ranges::for_each(light.radiance.c, to_grey);
    std::ranges::for_each(light.fit.c, to_grey);
    to_grey(light.irradiance);
    return light;
}

// Pairs of random texels, stored, mixed half and half: by the encoding's blend() and by mixing what is stored. The
// truth is the mean of what both decode to; beside it the error of solving the mixed light anew against the same.
void print_blends(const char* kind, std::span<const TexelLight> lights) {
    const auto pairs = static_cast<std::uint32_t>(lights.size() / 2);
    for (const Encoding* encoding : list_encodings()) {
        double blended = 0, mixed = 0, solved = 0;
        for (std::uint32_t p = 0; p < pairs; ++p) {
            const std::span<const TexelLight> pair = lights.subspan(2 * std::size_t{p}, 2);
            std::array<Numbers, 2> n{};
            encoding->solve(pair, n);
            for (Numbers& numbers : n) quantise(*encoding, Storage::texture, numbers);
            const Numbers by_blend = encoding->blend(n[0], 0.5f, n[1], 0.5f);
            const Numbers by_mix = detail::blend_numbers(n[0], 0.5f, n[1], 0.5f);
            const TexelLight both = blend(pair[0], 0.5f, pair[1], 0.5f);
            Numbers anew{};
            encoding->solve(std::span(&both, 1), std::span(&anew, 1));
            double mean = 0;
            std::array<double, 3> error{};
            for (std::size_t k = 0; k < grid().normal.size(); ++k) {
                const Vec3 normal = grid().normal[k];
                const Vec3 truth = (encoding->decode(n[0], normal) + encoding->decode(n[1], normal)) * 0.5f;
                const auto add = [&](const Numbers& numbers, double& sum) {
                    const Vec3 d = encoding->decode(numbers, normal) - truth;
                    sum += grid().weight[k] * static_cast<double>(dot(d, d)) / 3;
                };
                add(by_blend, error[0]);
                add(by_mix, error[1]);
                add(anew, error[2]);
                mean += grid().weight[k] * static_cast<double>(truth.x + truth.y + truth.z) / 3;
            }
            const double scale = 2 * static_cast<double>(kPi) / (mean * mean * pairs);
            blended += error[0] * scale;
            mixed += error[1] * scale;
            solved += error[2] * scale;
        }
        std::printf("blend,\"%s\",%s: linear SH,%.4f,,,\n", encoding->name, kind, std::sqrt(blended));
        std::printf("blend,\"%s\",%s: stored numbers,%.4f,,,\n", encoding->name, kind, std::sqrt(mixed));
        std::printf("blend,\"%s\",%s: ratio,%.3f,,,\n", encoding->name, kind,
                    mixed > 0 ? std::sqrt(blended / mixed) : 1.0);
        std::printf("blend,\"%s\",%s: light solved anew,%.4f,,,\n", encoding->name, kind, std::sqrt(solved));
    }
}

void print_speed(std::uint32_t texels) {
    std::vector<TexelLight> lights = random_texels(1024);
    for (std::size_t i = 1024; i < texels; ++i) lights.push_back(lights[i % 1024]);
    std::vector<Numbers> numbers(lights.size());
    for (const Encoding* encoding : list_encodings()) {
        encoding->solve(std::span(lights).first(64), std::span(numbers).first(64));
        const CpuStopwatch clock;
        encoding->solve(lights, numbers);
        std::printf("speed,\"%s\",million texels per second,%.2f,,,\n", encoding->name,
                    1e-6 * static_cast<double>(lights.size()) / clock.seconds());
    }
}

void run_encodings(const Options& options) {
    const auto wanted = [&](const char* table) { return options.only.empty() || options.only == table; };
    std::printf("table,model,light,error,expected,ratio,near\n");
    if (wanted("synthetic")) print_made_up();
    if (wanted("random")) print_random(options.random);
    if (!options.maps.empty() && (wanted("maps") || wanted("probes") || wanted("sphere"))) {
        const std::vector<LoadedMap> maps = load_maps(options.maps);
        if (wanted("maps")) print_maps("maps", maps, texel_rows(), true, true);
        if (wanted("probes")) print_maps("probes", maps, probe_rows(), false, true);
        if (wanted("sphere")) print_maps("sphere", maps, sphere_rows(), false, false);
    } else if (options.maps.empty()) {
        std::fprintf(stderr, "no --maps: tables of sky maps left out\n");
    }
    if (wanted("blend")) {
        std::vector<TexelLight> lights = random_texels(2 * options.random);
        print_blends("coloured", lights);
        std::ranges::transform(lights, lights.begin(), grey);
        print_blends("grey", lights);
    }
    if (wanted("speed")) print_speed(options.speed_texels);
}

}  // namespace

void add_encodings(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("encodings", "Error of directional encodings over normals, blending, speed");
    command->add_option("--maps", options->maps, "Folder of equirectangular .hdr")->check(CLI::ExistingDirectory);
    command->add_option("--only", options->only, "One table")
        ->check(CLI::IsMember({"synthetic", "random", "maps", "probes", "sphere", "blend", "speed"}));
    command->add_option("--random", options->random, "Random lights")->check(CLI::Range(1u, 100000u));
    command->add_option("--speed-texels", options->speed_texels)->check(CLI::Range(1024u, 1u << 24));
    command->callback([options] { run_encodings(*options); });
}

}  // namespace lumel::bench
