#include "camera.h"

#include <charconv>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/try.h"
#include "command.h"
#include "lumel/bake_folder.h"
#include "render/picture.h"

namespace lumel::cli {
namespace {

constexpr float kRadians = 0.01745329252f;

// "eye;target;vfov_degrees", each point as x,y,z.
Result<Camera> parse_camera(const std::string& text) {
    std::istringstream parts(text);
    std::string eye_text, target_text, fov_text;
    std::getline(parts, eye_text, ';');
    std::getline(parts, target_text, ';');
    std::getline(parts, fov_text);
    LUMEL_TRY(const Vec3 eye, parse_vec3(eye_text, "--camera"));
    LUMEL_TRY(const Vec3 target, parse_vec3(target_text, "--camera"));
    char* end = nullptr;
    const float fov = fov_text.empty() ? 60.0f : std::strtof(fov_text.c_str(), &end);
    if ((end && *end) || !(fov > 0.1f && fov < 179.0f))
        return Error{ErrorCode::usage,
                     "--camera: '" + fov_text + "' is not a vertical field of view between 0.1 and 179 degrees",
                     {},
                     "for example '0,1.7,4;0,1,0;60'"};
    if (!(length(target - eye) > 0.0f))
        return Error{ErrorCode::usage, "--camera: eye and target are the same point", {}, "move one of them"};
    return look_at(eye, target, fov * kRadians);
}

// K of "view K".
std::optional<std::size_t> number_of_view(std::string_view text) {
    constexpr std::string_view kPrefix = "view ";
    if (!text.starts_with(kPrefix)) return {};
    text.remove_prefix(kPrefix.size());
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return {};
    return number;
}

}  // namespace

Result<Camera> find_camera(const std::string& text, const Transport& transport, Context& context) {
    if (text.find(';') != std::string::npos) return parse_camera(text);
    for (const Camera& camera : transport.scene.cameras)
        if (camera.name == text) return camera;
    const std::optional<std::size_t> number = number_of_view(text);
    if (text.empty() || (number && *number < kMostViews)) {
        const std::size_t k = number.value_or(0);
        LUMEL_TRY(const std::vector<Camera> views, choose_views(transport, k + 1, context));
        return views[k];
    }
    std::string known = "'view 0' to 'view " + std::to_string(kMostViews - 1) + "'";
    for (const Camera& camera : transport.scene.cameras) known += ", '" + camera.name + "'";
    return Error{ErrorCode::usage, "--camera: there is no camera '" + text + "'", transport.scene.source,
                 "known: " + known + ", or eye;target;vfov_degrees such as '0,1.7,4;0,1,0;60'"};
}

}  // namespace lumel::cli
