#include "io/encoded_page.h"

#include <algorithm>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "base/try.h"
#include "encode/light_range.h"
#include "encode/units.h"
#include "io/image_io.h"
#include "lumel/scene.h"

namespace lumel {
namespace {

bool is_light(FieldKind kind) { return kind == FieldKind::light || kind == FieldKind::signed_light; }

// As the bake's own files: the largest of all light, and the mean of the first colour, which is the brightest.
bool halves_hold_page(const Encoding& encoding, const EncodedPage& page) {
    LightRange range = light_range(page.numbers, 0, std::min<std::size_t>(3, encoding.fields.size()));
    for (std::size_t i = 3; i < encoding.fields.size(); ++i)
        if (is_light(encoding.fields[i].kind))
            range.largest = std::max(range.largest, light_range(page.numbers, i, 1).largest);
    return halves_hold(range);
}

}  // namespace

TexelLight light_of_texel(const MasterPage& master, std::size_t texel) {
    return texel_light(master.radiance[texel], master.irradiance[texel], tangent_frame(master.normal[texel]));
}

Result<EncodedPage> encode_page(const Encoding& encoding, const MasterPage& master, Context& context) {
    EncodedPage out{master.width, master.height, master.texel_at, std::vector<Numbers>(master.size())};
    const bool done = parallel_for(context, master.size(), 1024, [&](const ChunkRange& range) {
        std::vector<TexelLight> light;
        for (std::size_t i = range.begin; i < range.end; ++i) light.push_back(light_of_texel(master, i));
        const std::span<Numbers> numbers = std::span(out.numbers).subspan(range.begin, light.size());
        encoding.solve(light, numbers);
        if (!encoding.rotate) return;
        for (std::size_t i = 0; i < light.size(); ++i)
            encoding.rotate(numbers[i], transposed(tangent_frame(master.normal[range.begin + i])));
    });
    if (!done) return cancelled_error();
    return out;
}

Result<std::string> write_encoded_page(const std::filesystem::path& file, const Encoding& encoding,
                                       const EncodedPage& page, Context& context) {
    const ExrType type = halves_hold_page(encoding, page) ? ExrType::half : ExrType::full;
    std::vector<ExrChannelSource> channels;
    for (const Field& field : encoding.fields)
        channels.push_back({field.name, is_light(field.kind) ? type : ExrType::half});
    const auto row = [&](std::uint32_t y, std::span<float> out) {
        const auto texels = std::span(page.texel_at).subspan(std::size_t{y} * page.width, page.width);
        if (std::ranges::all_of(texels, [](std::uint32_t t) { return t == kNone; })) return false;
        for (std::size_t i = 0; i < encoding.fields.size(); ++i)
            for (std::size_t x = 0; x < texels.size(); ++x) {
                const float value = texels[x] == kNone ? 0.0f : page.numbers[texels[x]][i];
                out[i * texels.size() + x] =
                    is_light(encoding.fields[i].kind) ? to_file_unit(value, LightUnit::e_over_pi) : value;
            }
        return true;
    };
    LUMEL_TRY_STATUS(write_exr(file, page.width, page.height, channels, row, &context));
    return std::string(type == ExrType::half ? "half" : "float");
}

}  // namespace lumel
