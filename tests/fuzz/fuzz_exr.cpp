// Any bytes as OpenEXR, read as a picture and channel by channel.
#include <unistd.h>

#include <algorithm>
#include <functional>

#include "base/check.h"
#include "encode/reconstruction_error.h"
#include "fuzz/seed_corpus.h"
#include "io/encoded_page.h"
#include "io/image_codecs.h"
#include "io/master.h"

namespace {

// Of 5 x 3 texels; `value` of a channel's name and what it would hold otherwise.
std::vector<std::byte> seed(
    const std::vector<lumel::ExrChannelSource>& channels,
    const std::function<float(const std::string&, float)>& value = [](const std::string&, float v) { return v; }) {
    const auto path =
        std::filesystem::temp_directory_path() / ("lumel-fuzz-seed-" + std::to_string(::getpid()) + ".exr");
    (void)lumel::write_exr(path, 5, 3, channels, [&](std::uint32_t y, std::span<float> out) {
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = value(channels[i / 5].name, static_cast<float>(i % 5 + 10 * y + 100 * (i / 5)));
        return true;
    });
    auto bytes = lumel::read_file(path, 1 << 20);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    return bytes.ok() ? std::move(bytes).value() : std::vector<std::byte>{};
}

// The channels that encodings are solved from.
std::vector<lumel::ExrChannelSource> master_channels() {
    std::vector<lumel::ExrChannelSource> out{{"coverage"}, {"normal.X"}, {"normal.Y"}, {"normal.Z"}};
    for (const std::string layer : {"direct.", "sky."}) {
        for (int i = 0; i < 9; ++i)
            for (const char* c : {".R", ".G", ".B"}) out.push_back({layer + "L" + std::to_string(i) + c});
        for (const char* c : {"I.R", "I.G", "I.B"}) out.push_back({layer + c});
    }
    return out;
}

// As a page of baked texels that face +Z, most of which have more light about them than from above.
float texel_value(const std::string& channel, float otherwise) {
    if (channel == "coverage") return 3.0f;
    if (channel.starts_with("normal.")) return channel == "normal.Z" ? 1.0f : 0.0f;
    return otherwise;
}

// No light that is read makes an encoding or its measure fail.
void encode_and_measure(const lumel::MasterPage& master) {
    lumel::MeasuredTexels texels;
    for (std::size_t i = 0; i < std::min<std::size_t>(master.size(), 16); ++i) {
        texels.light.push_back(lumel::light_of_texel(master, i));
        texels.frame.push_back(lumel::tangent_frame(master.normal[i]));
        if (i > 0) texels.neighbours.push_back({static_cast<std::uint32_t>(i - 1), static_cast<std::uint32_t>(i)});
    }
    for (const char* name : {"irradiance", "irradz-hhd", "l1-hazel-fit", "l1-linear-fit", "l2", "sg5"}) {
        const lumel::Encoding* encoding = lumel::find_encoding(name);
        LUMEL_CHECK(encoding != nullptr);
        for (const lumel::Storage storage : {lumel::Storage::half, lumel::Storage::texture}) {
            const lumel::ReconstructionError error = lumel::measure(*encoding, storage, texels);
            for (const double e : {error.nrmse, error.p99, error.worst, error.at_normal, error.between, error.outside})
                LUMEL_CHECK(e >= 0.0, name, e);
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    lumel::fuzz::seed_corpus(
        *argc, *argv,
        {seed({{"R"}, {"G"}, {"B"}}), seed({{"depth", lumel::ExrType::half}}), seed(master_channels(), texel_value),
         seed({{"sky.L0.R"}, {"sky.L0.G"}, {"sky.L0.B"}, {"count", lumel::ExrType::half}})});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = lumel::fuzz::as_span(data, size);
    const auto image = lumel::decode_exr(bytes, "fuzz");
    if (image.ok()) LUMEL_CHECK(image->data.size() == std::size_t{image->width} * image->height * image->channels);
    const auto channels = lumel::decode_exr_channels(bytes, {}, "fuzz");
    if (channels.ok()) LUMEL_CHECK(channels->planes.size() == channels->names.size());
    const auto master = lumel::decode_master(bytes, {1, 1, 0}, "fuzz");
    if (master.ok()) {
        LUMEL_CHECK(master->texel_at.size() == std::size_t{master->width} * master->height);
        LUMEL_CHECK(master->radiance.size() == master->size() && master->irradiance.size() == master->size());
        encode_and_measure(*master);
    }
    return 0;
}
