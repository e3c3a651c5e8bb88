// OpenEXR: the one file that reads it. The library throws; nothing of that leaves here.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "base/try.h"
#include "io/exr_fence.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

class MemoryStream : public Imf::IStream {
public:
    MemoryStream(std::span<const std::byte> bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}

    bool read(char out[], int count) override {
        const auto wanted = static_cast<std::size_t>(std::max(count, 0));
        // caught in with_exr, like all that OpenEXR throws
        if (at_ > bytes_.size() || bytes_.size() - at_ < wanted) throw std::runtime_error("the file ends early");
        std::memcpy(out, bytes_.data() + at_, wanted);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

private:
    std::span<const std::byte> bytes_;
    std::uint64_t at_ = 0;
};

struct Size {
    std::uint32_t width = 0, height = 0;
};

Result<Size> checked_size(const Imf::Header& header, std::size_t channels, std::size_t file_bytes,
                          const std::string& where) {
    const auto& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    LUMEL_TRY_STATUS(check_image_size(static_cast<std::uint64_t>(std::max<std::int64_t>(width, 0)),
                                      static_cast<std::uint64_t>(std::max<std::int64_t>(height, 0)), channels,
                                      kMaxImageEdge, file_bytes, where));
    return Size{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

std::vector<std::string> channel_names(const Imf::Header& header) {
    std::vector<std::string> names;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) names.emplace_back(i.name());
    return names;
}

Status check_channel(const Imf::Header& header, const std::string& name, const std::string& where) {
    const Imf::Channel* channel = header.channels().findChannel(name);
    if (!channel)
        return Error{ErrorCode::invalid_input, "has no channel '" + name + "'", where,
                     "give a master of lumel bake; bake again if an older one wrote it"};
    if (channel->xSampling != 1 || channel->ySampling != 1)
        return Error{ErrorCode::unsupported, "channel '" + name + "' is subsampled", where,
                     "save it at full resolution"};
    return success();
}

// Where a channel's first value goes and how far apart its values lie.
struct Target {
    std::string name;
    float* first;
    std::size_t step;
};

void read_pixels(Imf::InputFile& file, const std::vector<Target>& targets, Size size) {
    const auto& window = file.header().dataWindow();
    Imf::FrameBuffer buffer;
    for (const Target& target : targets) {
        const std::size_t x_stride = target.step * sizeof(float);
        buffer.insert(target.name, Imf::Slice::Make(Imf::FLOAT, target.first, window, x_stride, x_stride * size.width));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
}

// R, G, B (and A) of the first layer that has them, or the only channel.
std::vector<std::string> colour_channels(const Imf::Header& header) {
    const std::vector<std::string> all = channel_names(header);
    const auto has = [&](const std::string& name) { return std::find(all.begin(), all.end(), name) != all.end(); };
    std::vector<std::string> layers{""};
    for (const std::string& name : all)
        if (const std::size_t dot = name.rfind('.'); dot != std::string::npos)
            layers.push_back(name.substr(0, dot + 1));
    for (const std::string& layer : layers) {
        if (!has(layer + "R") || !has(layer + "G") || !has(layer + "B")) continue;
        std::vector<std::string> names{layer + "R", layer + "G", layer + "B"};
        if (has(layer + "A")) names.push_back(layer + "A");
        return names;
    }
    return all.size() == 1 ? all : std::vector<std::string>{};
}

// Runs `read` on the opened file; whatever the library throws becomes an Error.
template <class Read>
auto with_exr(std::span<const std::byte> bytes, const std::string& where, Read&& read)
    -> decltype(read(std::declval<Imf::InputFile&>())) {
    LUMEL_TRY_STATUS(check_exr_headers(bytes, where));
    try {
        // The library sizes its line buffers from the header before we see it.
        Imf::Header::setMaxImageSize(static_cast<int>(kMaxImageEdge), static_cast<int>(kMaxImageEdge));
        Imf::Header::setMaxTileSize(static_cast<int>(kMaxImageEdge), static_cast<int>(kMaxImageEdge));
        MemoryStream stream(bytes, where);
        Imf::InputFile file(stream, 0);
        // Before the pixels are allocated: every block that the header promises has its place in the file.
        if (!file.isComplete())
            return Error{ErrorCode::invalid_input, "ends within the pixels", where, "the file is damaged"};
        return read(file);
    } catch (const std::exception& error) {
        return Error{ErrorCode::invalid_input, std::string("cannot be read as OpenEXR: ") + error.what(), where,
                     "the file is damaged"};
    } catch (...) {
        return Error{ErrorCode::invalid_input, "cannot be read as OpenEXR", where, "the file is damaged"};
    }
}

}  // namespace

Result<Image> decode_exr(std::span<const std::byte> bytes, const std::string& where) {
    return with_exr(bytes, where, [&](Imf::InputFile& file) -> Result<Image> {
        const std::vector<std::string> names = colour_channels(file.header());
        if (names.empty())
            return Error{ErrorCode::unsupported, "has neither R, G and B nor a single channel", where,
                         "save it as RGB"};
        for (const std::string& name : names) LUMEL_TRY_STATUS(check_channel(file.header(), name, where));
        LUMEL_TRY(const Size size, checked_size(file.header(), names.size(), bytes.size(), where));
        Image image(size.width, size.height, static_cast<std::uint32_t>(names.size()));
        std::vector<Target> targets;
        for (std::size_t c = 0; c < names.size(); ++c)
            targets.push_back({names[c], image.data.data() + c, names.size()});
        read_pixels(file, targets, size);
        return image;
    });
}

Result<std::vector<std::string>> decode_exr_channel_names(std::span<const std::byte> bytes, const std::string& where) {
    return with_exr(bytes, where, [](Imf::InputFile& file) -> Result<std::vector<std::string>> {
        return channel_names(file.header());
    });
}

Result<NamedChannels> decode_exr_channels(std::span<const std::byte> bytes, std::span<const std::string> names,
                                          const std::string& where) {
    return with_exr(bytes, where, [&](Imf::InputFile& file) -> Result<NamedChannels> {
        NamedChannels out;
        out.names = names.empty() ? channel_names(file.header()) : std::vector<std::string>(names.begin(), names.end());
        for (const std::string& name : out.names) LUMEL_TRY_STATUS(check_channel(file.header(), name, where));
        LUMEL_TRY(const Size size, checked_size(file.header(), out.names.size(), bytes.size(), where));
        out.width = size.width;
        out.height = size.height;
        out.planes.assign(out.names.size(), std::vector<float>(std::size_t{size.width} * size.height));
        std::vector<Target> targets;
        for (std::size_t c = 0; c < out.names.size(); ++c) targets.push_back({out.names[c], out.planes[c].data(), 1});
        read_pixels(file, targets, size);
        return out;
    });
}

Status decode_exr_bands(std::span<const std::byte> bytes, std::span<const std::string> names, std::uint32_t rows,
                        const ExrBand& band, const std::string& where) {
    return with_exr(bytes, where, [&](Imf::InputFile& file) -> Status {
        for (const std::string& name : names) LUMEL_TRY_STATUS(check_channel(file.header(), name, where));
        LUMEL_TRY(const Size size, checked_size(file.header(), names.size(), bytes.size(), where));
        NamedChannels part;
        part.names.assign(names.begin(), names.end());
        part.width = size.width;
        part.planes.resize(names.size());
        auto window = file.header().dataWindow();
        const int top = window.min.y, bottom = window.max.y;
        for (std::uint32_t first = 0; first < size.height; first += part.height) {
            part.height = std::min(rows, size.height - first);
            window.min.y = top + static_cast<int>(first);
            window.max.y = std::min(bottom, window.min.y + static_cast<int>(part.height) - 1);
            Imf::FrameBuffer buffer;
            for (std::size_t c = 0; c < names.size(); ++c) {
                part.planes[c].resize(std::size_t{part.width} * part.height);
                buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, part.planes[c].data(), window));
            }
            file.setFrameBuffer(buffer);
            file.readPixels(window.min.y, window.max.y);
            LUMEL_TRY_STATUS(band(part, first));
        }
        return success();
    });
}

}  // namespace lumel
