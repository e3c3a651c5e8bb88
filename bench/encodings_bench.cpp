// The error of every encoding over the normals of the hemisphere: under made-up lights, sky maps in ten orientations,
// and random lights; what occlusion costs probes; what the hemispherical Gram matrix and the search are worth; blending
// of light sets; texels per second.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include "bench.h"
#include "encode/encodings.h"
#include "encoding_models.h"
#include "environment.h"
#include "expected_errors.h"
#include "io/image_io.h"
#include "load.h"
#include "math/constants.h"

namespace lumel::bench {
namespace {

struct Options {
    std::string maps, only;
    std::uint32_t random = 150, speed_texels = 1u << 18;
};

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
    const std::vector<EncodingRow> rows = texel_rows();
    std::size_t column = 0;
    for (Environment& environment : made_up_lights()) {
        const EncodingCase c(std::move(environment));
        for (const EncodingRow& row : rows)
            table.print(row.name, c.environment.name, column, std::sqrt(squared_error(c, row.model(c))) / c.mean);
        ++column;
    }
}

void print_random(std::uint32_t count) {
    const std::vector<EncodingRow> rows = texel_rows();
    std::vector<double> sum(rows.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        const EncodingCase c(random_light(k));
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

MapErrors errors_on_map(const Environment& map, const std::vector<EncodingRow>& rows, bool above_only,
                        bool truth_above_only) {
    MapErrors out{std::vector<double>(rows.size()), std::vector<double>(rows.size()), 0.0};
    constexpr double kCount = 10;
    for (const Vec3d& up : kUps) {
        EncodingCase c(turned(map, up, truth_above_only));
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

void print_maps(const char* name, const std::vector<LoadedMap>& maps, const std::vector<EncodingRow>& rows,
                bool above_only, bool truth_above_only) {
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
            for (std::size_t k = 0; k < hemisphere_normals().normal.size(); ++k) {
                const Vec3 normal = hemisphere_normals().normal[k];
                const Vec3 truth = (encoding->decode(n[0], normal) + encoding->decode(n[1], normal)) * 0.5f;
                const auto add = [&](const Numbers& numbers, double& sum) {
                    const Vec3 d = encoding->decode(numbers, normal) - truth;
                    sum += hemisphere_normals().weight[k] * static_cast<double>(dot(d, d)) / 3;
                };
                add(by_blend, error[0]);
                add(by_mix, error[1]);
                add(anew, error[2]);
                mean += hemisphere_normals().weight[k] * static_cast<double>(truth.x + truth.y + truth.z) / 3;
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
