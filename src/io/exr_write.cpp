// OpenEXR scan-line files, ZIP, written a few rows at a time. The only file that includes OpenEXR for writing.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>

#include <half.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "base/check.h"
#include "base/parallel.h"
#include "encode/output_sizes.h"
#include "io/atomic_file.h"
#include "io/image_io.h"

namespace lumel {
namespace {

namespace exr = OPENEXR_IMF_NAMESPACE;

// Hands OpenEXR's bytes to an AtomicFile, whose first failure sticks: OpenEXR's own destructor swallows errors.
class AtomicStream : public exr::OStream {
public:
    AtomicStream(AtomicFile& file, const std::string& name) : exr::OStream(name.c_str()), file_(&file) {}
    void write(const char bytes[], int size) override {
        file_->write(std::as_bytes(std::span(bytes, static_cast<std::size_t>(size))));
        if (!file_->ok()) throw std::runtime_error("write failed");  // caught in write_exr
    }
    std::uint64_t tellp() override { return file_->position(); }
    void seekp(std::uint64_t position) override { file_->seek(position); }

private:
    AtomicFile* file_;
};

// Of 1..9. On noisy masters 1 is a quarter faster than the library's 4 and three percent larger.
constexpr int kZipLevel = 1;

exr::Header make_header(std::uint32_t width, std::uint32_t height, std::span<const ExrChannelSource> channels) {
    exr::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = exr::ZIP_COMPRESSION;
    header.zipCompressionLevel() = kZipLevel;
    for (const ExrChannelSource& channel : channels) {
        LUMEL_CHECK(header.channels().findChannel(channel.name.c_str()) == nullptr, channel.name);
        header.channels().insert(channel.name.c_str(),
                                 exr::Channel(channel.type == ExrType::half ? exr::HALF : exr::FLOAT));
    }
    return header;
}

// Half has no room above 65504: such values become the largest half, never infinity.
half to_half(float v) {
    constexpr float kLargestHalf = 65504.0f;
    return half(v > kLargestHalf ? kLargestHalf : (v < -kLargestHalf ? -kLargestHalf : v));
}

std::size_t size_of(ExrType type) { return type == ExrType::half ? sizeof(half) : sizeof(float); }

// Some rows of all channels in the file's types: one chunk for each thread.
class RowBlock {
public:
    RowBlock(std::uint32_t width, std::uint32_t rows, unsigned threads, std::span<const ExrChannelSource> channels)
        : width_(width), rows_(rows), channels_(channels), scratch_(threads) {
        for (const ExrChannelSource& channel : channels)
            planes_.emplace_back(std::size_t{rows} * width * size_of(channel.type));
        for (std::vector<float>& scratch : scratch_) scratch.resize(channels.size() * width);
    }

    [[nodiscard]] std::uint32_t rows() const { return rows_; }

    // Row `y` as row `row` of the block. By any thread.
    void fill(std::uint32_t row, std::uint32_t y, unsigned worker, const ExrRow& source) {
        std::vector<float>& scratch = scratch_[worker];
        const bool any = source(y, scratch);
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            const std::size_t bytes = width_ * size_of(channels_[c].type);
            char* const out = planes_[c].data() + row * bytes;
            const float* const in = scratch.data() + c * width_;
            if (!any)
                std::memset(out, 0, bytes);
            else if (channels_[c].type == ExrType::half)
                std::transform(in, in + width_, reinterpret_cast<half*>(out), to_half);
            else
                std::memcpy(out, in, bytes);
        }
    }

    // With `y` as the block's first row.
    [[nodiscard]] exr::FrameBuffer frame(std::uint32_t y) {
        exr::FrameBuffer frame;
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            const std::size_t size = size_of(channels_[c].type), stride = width_ * size;
            const exr::PixelType type = channels_[c].type == ExrType::half ? exr::HALF : exr::FLOAT;
            // The library wants the place where row 0 would be.
            const auto at = reinterpret_cast<std::uintptr_t>(planes_[c].data()) - y * stride;
            frame.insert(channels_[c].name.c_str(), exr::Slice(type, reinterpret_cast<char*>(at), size, stride));
        }
        return frame;
    }

private:
    std::uint32_t width_, rows_;
    std::span<const ExrChannelSource> channels_;
    std::vector<std::vector<char>> planes_;    // one per channel
    std::vector<std::vector<float>> scratch_;  // one per worker: a row of all channels
};

// Rows first .. first + count of the file. False: cancelled.
bool fill_block(RowBlock& block, std::uint32_t first, std::uint32_t count, const ExrRow& source, Context* context) {
    if (context)
        return parallel_for(*context, count, 1, [&](const ChunkRange& range) {
            for (std::size_t row = range.begin; row < range.end; ++row)
                block.fill(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(first + row), range.worker,
                           source);
        });
    for (std::uint32_t row = 0; row < count; ++row) block.fill(row, first + row, 0, source);
    return true;
}

// The library has one pool of threads for all files of the process. It exists while any file is written by more than
// one thread: not longer, because a child that is forked from this process would inherit the pool without its threads
// and wait for them for ever.
class CompressionThreads {
public:
    explicit CompressionThreads(unsigned threads) : threads_(threads < 2 ? 0 : static_cast<int>(threads)) {
        if (threads_ == 0) return;
        const std::lock_guard lock(mutex());
        ++users();
        if (exr::globalThreadCount() < threads_) exr::setGlobalThreadCount(threads_);
    }
    ~CompressionThreads() {
        if (threads_ == 0) return;
        const std::lock_guard lock(mutex());
        if (--users() == 0) exr::setGlobalThreadCount(0);
    }
    CompressionThreads(const CompressionThreads&) = delete;
    CompressionThreads& operator=(const CompressionThreads&) = delete;

    [[nodiscard]] int count() const { return threads_; }  // 0: the calling thread compresses

private:
    static std::mutex& mutex() {
        static std::mutex mutex;
        return mutex;
    }
    static int& users() {
        static int users = 0;
        return users;
    }
    int threads_;
};

}  // namespace

Status write_exr(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                 std::span<const ExrChannelSource> channels, const ExrRow& row, Context* context,
                 const std::function<void(double)>& progress) {
    LUMEL_CHECK(width > 0 && height > 0 && !channels.empty(), width, height, channels.size());
    AtomicFile file(path);
    if (!file.ok()) return file.commit();
    try {
        const unsigned threads = context ? context->threads() : 1;
        RowBlock block(width, std::min(height, kExrRowsPerChunk * threads), threads, channels);
        AtomicStream stream(file, path.string());
        const CompressionThreads compression(threads);
        exr::OutputFile output(stream, make_header(width, height, channels), compression.count());
        for (std::uint32_t y = 0; y < height; y += block.rows()) {
            const std::uint32_t count = std::min(block.rows(), height - y);
            if (!fill_block(block, y, count, row, context))
                return Error{ErrorCode::cancelled, "cancelled while writing", path.string(), {}};
            output.setFrameBuffer(block.frame(y));
            output.writePixels(static_cast<int>(count));
            if (progress) progress(static_cast<double>(y + count) / height);
        }
    } catch (const std::exception& e) {
        if (file.ok())
            return Error{ErrorCode::io, std::string("writing OpenEXR failed: ") + e.what(), path.string(),
                         "check the disk, or choose another folder with -o"};
    }
    return file.commit();
}

Status write_exr(const std::filesystem::path& path, const Image& rgb, ExrType type) {
    LUMEL_CHECK(rgb.channels == 1 || rgb.channels == 3 || rgb.channels == 4, rgb.channels);
    static constexpr const char* kGrey[] = {"Y"};
    static constexpr const char* kColor[] = {"R", "G", "B", "A"};
    const char* const* names = rgb.channels == 1 ? kGrey : kColor;
    std::vector<ExrChannelSource> channels;
    for (std::uint32_t c = 0; c < rgb.channels; ++c) channels.push_back({names[c], type});
    return write_exr(path, rgb.width, rgb.height, channels, [&](std::uint32_t y, std::span<float> out) {
        for (std::uint32_t c = 0; c < rgb.channels; ++c)
            for (std::uint32_t x = 0; x < rgb.width; ++x) out[c * std::size_t{rgb.width} + x] = rgb.at(x, y)[c];
        return true;
    });
}

}  // namespace lumel
