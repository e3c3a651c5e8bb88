#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <utility>

#include "base/try.h"
#include "command.h"
#include "math/frame.h"

namespace lumel::cli {
namespace {

constexpr double kMaxScale = 1e6;  // of layers; that of a light in the sidecar
// Fewer without a unit are gigabytes or megabytes that were meant.
constexpr std::uint64_t kFewestPlainBytes = 100000;

Error usage(const std::string& option, const std::string& text, const std::string& expected) {
    return {ErrorCode::usage, option + ": '" + text + "' is not " + expected, {}, {}};
}

// A name that looks like one of a map was meant as one.
Status check_sky_file(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::status(path, ignored).type() != std::filesystem::file_type::not_found) return success();
    const std::filesystem::path extension = path.extension();
    if (extension == ".hdr" || extension == ".exr")
        return Error{ErrorCode::io, "--sky: there is no such file", path.string(), "check the path"};
    return Error{ErrorCode::usage,
                 "--sky: '" + path.string() + "' is neither three numbers such as 0.7,0.9,1.3 nor a file",
                 {},
                 {}};
}

// Options as they would be given.
struct Words {
    std::string text;

    void add(const char* option, const std::string& value) {
        text += (text.empty() ? "" : " ") + std::string(option) + (value.empty() ? "" : " " + value);
    }
    void add_unless(double usual, const char* option, double value) {
        if (value != usual) add(option, number(value));
    }
    void add(const char* option, Vec3 v) { add(option, number(v.x) + "," + number(v.y) + "," + number(v.z)); }

private:
    // The shortest that is read as the same number.
    template <class T>
    static std::string number(T value) {
        std::array<char, 32> digits{};
        return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
    }
};

void say(const SkyOptions& sky, Words& words) {
    if (sky.color)
        words.add("--sky", *sky.color);
    else if (!sky.file.empty())
        words.add("--sky", sky.file);
    words.add_unless(1.0, "--sky-intensity", sky.intensity);
    words.add_unless(0.0, "--sky-rotation", sky.rotation_degrees);
    words.add_unless(0.0, "--sky-blur", sky.blur_degrees);
    if (sky.extract_sun) words.add("--sky-extract-sun", std::string());
}

void say(const SunOptions& sun, Words& words) {
    if (!sun.direction) return;
    words.add("--sun-direction", *sun.direction);
    words.add_unless(SunOptions{}.illuminance, "--sun-illuminance", sun.illuminance);
    if (!(sun.color == Vec3{1, 1, 1})) words.add("--sun-colour", sun.color);
    words.add_unless(0.0, "--sun-angle", sun.angle_degrees);
}

std::string names_of(const Include& include) {
    std::string out;
    for (const auto& [included, name] :
         {std::pair{include.direct, "direct"}, {include.sky, "sky"}, {include.indirect, "indirect"}})
        if (included) out += (out.empty() ? "" : ",") + std::string(name);
    return out;
}

}  // namespace

CLI::Validator between(double low, double high) {
    std::ostringstream name;
    name.imbue(std::locale::classic());
    if (high < std::numeric_limits<double>::max())
        name << "in [" << low << " - " << high << "]";
    else
        name << "at least " << low;
    const std::string range = name.str();
    return {[low, high, range](std::string& text) {
                double value = 0.0;
                const bool number = CLI::detail::lexical_cast(text, value);
                return number && value >= low && value <= high ? std::string{} : "'" + text + "' is not " + range;
            },
            range};
}

CLI::Validator not_negative() { return between(0.0, std::numeric_limits<double>::max()); }

CLI::Validator not_empty() {
    return {[](std::string& text) { return text.empty() ? std::string("needs a value: '' is none") : std::string{}; },
            ""};
}

Result<Vec3> parse_vec3(const std::string& text, const std::string& option) {
    Vec3 out;
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    char comma1 = 0, comma2 = 0;
    stream >> out.x >> comma1 >> out.y >> comma2 >> out.z;
    if (!stream || comma1 != ',' || comma2 != ',' || !(stream >> std::ws).eof() || !is_finite(out))
        return usage(option, text, "three numbers such as 0.3,-1,0.2");
    return out;
}

Result<Size> parse_size(const std::string& text, const std::string& option) {
    constexpr std::uint32_t kLargest = 16384;
    Size out;
    const char* const end = text.data() + text.size();
    const auto [after_width, width_error] = std::from_chars(text.data(), end, out.width);
    if (width_error == std::errc{} && after_width != end && *after_width == 'x') {
        const auto [after_height, height_error] = std::from_chars(after_width + 1, end, out.height);
        if (height_error == std::errc{} && after_height == end && out.width >= 1 && out.height >= 1 &&
            out.width <= kLargest && out.height <= kLargest)
            return out;
    }
    return usage(option, text, "a size such as 640x360 (edges from 1 to 16384)");
}

Result<std::uint64_t> parse_bytes(const std::string& text, const std::string& option) {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data(), end, value);
    int shift = -1;
    if (error == std::errc{}) {
        const std::string suffix(after, end);
        if (suffix.empty()) shift = 0;
        if (suffix == "K" || suffix == "k") shift = 10;
        if (suffix == "M" || suffix == "m") shift = 20;
        if (suffix == "G" || suffix == "g") shift = 30;
    }
    if (shift < 0 || value == 0 || value > (~std::uint64_t{0} >> shift))
        return usage(option, text, "a size such as 4G or 512M");
    if (shift == 0 && value < kFewestPlainBytes) return usage(option, text, "a size with its unit, such as 4G or 512M");
    return value << shift;
}

void LightOptions::declare(CLI::App& app, const std::string& usual_samples) {
    const std::string group = "Light";
    const auto of_sky_and_sun = [&](CLI::Option* option) {
        sky_and_sun_.push_back(option->group(group));
        return option;
    };
    of_sky_and_sun(app.add_option("--sky", sky_, "Sky: radiance R,G,B, or an equirectangular .hdr or .exr file"))
        ->default_str("the sidecar's, or none")
        ->check(not_empty());
    of_sky_and_sun(app.add_option("--sky-intensity", values_.sky.intensity, "Times the sky: nits per unit"))
        ->check(not_negative());
    of_sky_and_sun(app.add_option("--sky-rotation", values_.sky.rotation_degrees,
                                  "Degrees about +Y of a sky map, on top of the sidecar's"))
        ->check(between(-360.0, 360.0));
    of_sky_and_sun(app.add_option("--sky-blur", values_.sky.blur_degrees,
                                  "Blur the sky map, keeping its energy: half width in degrees"))
        ->check(between(0.0, 90.0));
    of_sky_and_sun(app.add_flag("--sky-extract-sun", values_.sky.extract_sun,
                                "Find the sun's disc in the map and make it a light"));
    CLI::Option* const sun =
        of_sky_and_sun(app.add_option("--sun-direction", sun_direction_, "X,Y,Z: the way the sun's light travels")
                           ->default_str("no sun")
                           ->check(not_empty()));
    of_sky_and_sun(app.add_option("--sun-illuminance", values_.sun.illuminance, "Lux on a plane facing the sun"))
        ->check(not_negative())
        ->needs(sun);
    of_sky_and_sun(app.add_option("--sun-colour,--sun-color", sun_color_, "R,G,B, times the illuminance"))->needs(sun);
    of_sky_and_sun(app.add_option("--sun-angle", values_.sun.angle_degrees, "The sun's diameter in degrees"))
        ->check(between(0.0, 90.0))
        ->needs(sun);
    include_option_ =
        app.add_option("--include", include_, "Layers that the files sum: some of direct,sky,indirect")->group(group);
    direct_scale_ = app.add_option("--direct-scale", values_.direct_scale, "Times direct and sky light")
                        ->check(between(0.0, kMaxScale))
                        ->group(group);
    indirect_scale_ = app.add_option("--indirect-scale", values_.indirect_scale, "Times bounced light")
                          ->check(between(0.0, kMaxScale))
                          ->group(group);

    const std::string transport = "Transport";
    app.add_option("--samples", values_.samples, "Paths per texel or pixel")
        ->default_str(usual_samples)
        ->check(CLI::Range(1u, 1u << 24))
        ->group(transport);
    app.add_option("--bounces", values_.bounces, "Longest path; 0 = direct light only")
        ->check(CLI::Range(0u, 1024u))
        ->group(transport);
    app.add_option("--seed", values_.seed, "Of the random numbers")->group(transport);
    app.add_option("--threads", values_.threads, "0: one per core")->check(CLI::Range(0u, 1024u));
}

Status LightOptions::read(BakeOptions& out) const {
    out.sky = values_.sky;
    out.sun = values_.sun;
    out.direct_scale = values_.direct_scale;
    out.indirect_scale = values_.indirect_scale;
    out.samples = values_.samples;
    out.bounces = values_.bounces;
    out.seed = values_.seed;
    out.threads = values_.threads;

    if (!sky_.empty()) {
        if (const Result<Vec3> color = parse_vec3(sky_, "--sky"); color.ok()) {
            if (color->x < 0 || color->y < 0 || color->z < 0) return usage("--sky", sky_, "a radiance of zero or more");
            out.sky.color = *color;
        } else {
            LUMEL_TRY_STATUS(check_sky_file(sky_));
            out.sky.file = sky_;
        }
    }
    if (!sun_direction_.empty()) {
        LUMEL_TRY(const Vec3 direction, parse_vec3(sun_direction_, "--sun-direction"));
        const Vec3 unit = unit_or(direction, Vec3{});
        if (unit == Vec3{}) return usage("--sun-direction", sun_direction_, "a direction");
        out.sun.direction = unit;
    }
    LUMEL_TRY(out.sun.color, parse_vec3(sun_color_, "--sun-colour"));
    if (out.sun.color.x < 0 || out.sun.color.y < 0 || out.sun.color.z < 0)
        return usage("--sun-colour", sun_color_, "a colour of zero or more");

    out.include = {false, false, false};
    std::istringstream layers(include_);
    for (std::string layer; std::getline(layers, layer, ',');) {
        if (layer == "direct")
            out.include.direct = true;
        else if (layer == "sky")
            out.include.sky = true;
        else if (layer == "indirect")
            out.include.indirect = true;
        else
            return usage("--include", layer, "one of direct, sky, indirect");
    }
    if (!out.include.direct && !out.include.sky && !out.include.indirect)
        return usage("--include", include_, "some of direct, sky, indirect");
    return success();
}

std::string LightOptions::take_over(const LightRecord& bake, BakeOptions& out) const {
    Words words;
    if (std::ranges::none_of(sky_and_sun_, [](const CLI::Option* option) { return option->count() > 0; })) {
        out.sky = bake.sky;
        out.sun = bake.sun;
        say(bake.sky, words);
        say(bake.sun, words);
    }
    if (include_option_->count() == 0) {
        out.include = bake.include;
        if (!bake.include.direct || !bake.include.sky || !bake.include.indirect)
            words.add("--include", names_of(bake.include));
    }
    if (direct_scale_->count() == 0) {
        out.direct_scale = bake.direct_scale;
        words.add_unless(1.0, "--direct-scale", bake.direct_scale);
    }
    if (indirect_scale_->count() == 0) {
        out.indirect_scale = bake.indirect_scale;
        words.add_unless(1.0, "--indirect-scale", bake.indirect_scale);
    }
    return words.text;
}

}  // namespace lumel::cli
