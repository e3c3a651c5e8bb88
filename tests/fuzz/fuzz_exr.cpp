// Any bytes as OpenEXR, read as a picture and channel by channel.
#include <unistd.h>

#include "base/check.h"
#include "fuzz/seed_corpus.h"
#include "io/image_codecs.h"
#include "io/master.h"

namespace {

std::vector<std::byte> seed(const std::vector<lumel::ExrChannelSource>& channels) {
    const auto path =
        std::filesystem::temp_directory_path() / ("lumel-fuzz-seed-" + std::to_string(::getpid()) + ".exr");
    (void)lumel::write_exr(path, 5, 3, channels, [](std::uint32_t y, std::span<float> out) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(i % 5 + 10 * y + 100 * (i / 5));
        return true;
    });
    auto bytes = lumel::read_file(path, 1 << 20);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    return bytes.ok() ? std::move(bytes).value() : std::vector<std::byte>{};
}

// The channels that encodings are solved from. What seed() writes into them is no texel; mutations may be.
std::vector<lumel::ExrChannelSource> master_channels() {
    std::vector<lumel::ExrChannelSource> out{{"coverage"}, {"normal.X"}, {"normal.Y"}, {"normal.Z"}};
    for (const std::string layer : {"direct.", "sky."}) {
        for (int i = 0; i < 9; ++i)
            for (const char* c : {".R", ".G", ".B"}) out.push_back({layer + "L" + std::to_string(i) + c});
        for (const char* c : {"I.R", "I.G", "I.B"}) out.push_back({layer + c});
    }
    return out;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    lumel::fuzz::seed_corpus(
        *argc, *argv,
        {seed({{"R"}, {"G"}, {"B"}}), seed({{"depth", lumel::ExrType::half}}), seed(master_channels()),
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
    }
    return 0;
}
