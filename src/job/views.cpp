#include "job/views.h"

#include <algorithm>
#include <vector>

#include "base/progress_parts.h"
#include "base/try.h"
#include "image/tonemap.h"
#include "job/baked_light.h"
#include "plot/label.h"

namespace lumel {
namespace {

constexpr std::uint32_t kWidth = 384, kHeight = 216;
constexpr double kLitPictureWork = 0.1;  // of that of a path-traced one: camera rays, where all surfaces have texels
constexpr std::uint32_t kGutter = 4;     // pixels between truth and bake

// Truth on the left, the bake on the right, one exposure; each says what it is.
std::vector<std::uint8_t> side_by_side(const Image& truth, const Image& baked) {
    const float exposure = auto_exposure(truth);
    const auto left = tonemap(truth, exposure), right = tonemap(baked, exposure);
    const std::size_t row = std::size_t{truth.width} * 3;
    std::vector<std::uint8_t> out;
    for (std::size_t y = 0; y < truth.height; ++y) {
        out.insert(out.end(), left.begin() + static_cast<std::ptrdiff_t>(y * row),
                   left.begin() + static_cast<std::ptrdiff_t>((y + 1) * row));
        out.insert(out.end(), std::size_t{kGutter} * 3, std::uint8_t{255});
        out.insert(out.end(), right.begin() + static_cast<std::ptrdiff_t>(y * row),
                   right.begin() + static_cast<std::ptrdiff_t>((y + 1) * row));
    }
    const std::uint32_t width = truth.width + kGutter + baked.width;
    draw_label(out, width, 0, "path-traced");
    draw_label(out, width, truth.width + kGutter, "baked");
    return out;
}

}  // namespace

Status write_views(BakeWriter& writer, const Transport& transport, const BakeOptions& options, const ViewOptions& views,
                   Context& context) {
    if (views.count == 0) return success();
    LUMEL_TRY(BakedLighting baked, read_baked(writer.folder(), transport.scene, transport.geometry, views.page_memory));
    const BakedLight light = light_of(baked);
    const PathOptions path = transport_options(options);
    const PictureOptions picture{kWidth, kHeight, views.samples};
    LUMEL_TRY(const std::vector<Camera> cameras, choose_views(transport, views.count, context));
    ProgressParts progress(context, "views", static_cast<double>(cameras.size()) * (1.0 + kLitPictureWork));
    for (std::size_t k = 0; k < cameras.size(); ++k) {
        progress.begin(1.0);
        LUMEL_TRY(const Image truth, render_picture(transport, path, cameras[k], picture, nullptr, context));
        progress.begin(kLitPictureWork);
        LUMEL_TRY(const Image lit, render_picture(transport, path, cameras[k], picture, &light, context));
        LUMEL_TRY_STATUS(writer.write_view(k, 2 * kWidth + kGutter, kHeight, side_by_side(truth, lit)));
    }
    return success();
}

}  // namespace lumel
