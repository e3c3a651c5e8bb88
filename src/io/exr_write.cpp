// OpenEXR scan-line files, ZIP, written a few rows at a time. The only file that includes OpenEXR for writing.
//
// OpenEXR compresses rows in chunks of 16. Our own threads have it compress chunks, several at once, and this thread
// writes them in order: the library's own threads are not used. Much of a lightmap page may be empty: a chunk of zeros
// is compressed once and written wherever there is none but such rows.
#include <OpenEXR/openexr.h>

#include <half.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "base/try.h"
#include "encode/output_sizes.h"
#include "io/atomic_file.h"
#include "io/image_io.h"

namespace lumel {
namespace {

// Of 1..9. On noisy masters 1 is a quarter faster than the library's 4 and three percent larger.
constexpr int kZipLevel = 1;

// Half has no room above 65504: such values become the largest half, never infinity.
half to_half(float v) {
    constexpr float kLargestHalf = 65504.0f;
    return half(v > kLargestHalf ? kLargestHalf : (v < -kLargestHalf ? -kLargestHalf : v));
}

std::size_t size_of(ExrType type) { return type == ExrType::half ? sizeof(half) : sizeof(float); }

exr_pixel_type_t pixel_type(ExrType type) { return type == ExrType::half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT; }

// The library's side of a file: header, chunks, table of chunks. Its first failure sticks.
class ExrFile {
public:
    ExrFile(AtomicFile& file, const std::string& name, std::uint32_t width, std::uint32_t height,
            std::span<const ExrChannelSource> channels)
        : file_(file) {
        exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
        init.user_data = this;
        init.write_fn = write_bytes;
        init.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};  // it would print
        init.zip_level = kZipLevel;
        note(exr_start_write(&context_, name.c_str(), EXR_WRITE_FILE_DIRECTLY, &init));
        int part = 0;
        if (ok()) note(exr_add_part(context_, nullptr, EXR_STORAGE_SCANLINE, &part));
        if (ok())
            note(exr_initialize_required_attr_simple(context_, 0, static_cast<std::int32_t>(width),
                                                     static_cast<std::int32_t>(height), EXR_COMPRESSION_ZIP));
        for (const ExrChannelSource& channel : channels)
            if (ok())
                note(exr_add_channel(context_, 0, channel.name.c_str(), pixel_type(channel.type),
                                     EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
        if (ok()) note(exr_write_header(context_));
    }
    ~ExrFile() {
        if (context_) exr_finish(&context_);
    }
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    [[nodiscard]] bool ok() const { return result_ == EXR_ERR_SUCCESS; }
    [[nodiscard]] const char* error() const { return exr_get_default_error_message(result_); }
    [[nodiscard]] exr_const_context_t context() const { return context_; }

    [[nodiscard]] exr_chunk_info_t chunk_info(std::uint32_t y) {
        exr_chunk_info_t info{};
        if (ok()) note(exr_write_scanline_chunk_info(context_, 0, static_cast<int>(y), &info));
        return info;
    }
    // In ascending order of rows.
    void write_chunk(std::uint32_t y, std::span<const std::byte> bytes) {
        if (ok()) note(exr_write_scanline_chunk(context_, 0, static_cast<int>(y), bytes.data(), bytes.size()));
    }
    void fail(exr_result_t result) {
        if (ok()) result_ = result;
    }
    // Writes what only the end knows: where the chunks are.
    void finish() {
        if (ok()) note(exr_finish(&context_));
    }

private:
    static std::int64_t write_bytes(exr_const_context_t, void* user, const void* bytes, std::uint64_t size,
                                    std::uint64_t offset, exr_stream_error_func_ptr_t) {
        AtomicFile& file = static_cast<ExrFile*>(user)->file_;
        file.seek(offset);
        file.write({static_cast<const std::byte*>(bytes), size});
        return file.ok() ? static_cast<std::int64_t>(size) : -1;
    }
    // The result of a call that was made because all before it had succeeded.
    void note(exr_result_t result) { result_ = result; }

    AtomicFile& file_;
    exr_context_t context_ = nullptr;
    exr_result_t result_ = EXR_ERR_SUCCESS;
};

// One thread's work on chunks: rows of all channels in the file's types, and the library's pipeline.
class ChunkEncoder {
public:
    ChunkEncoder(std::uint32_t width, std::span<const ExrChannelSource> channels)
        : width_(width), channels_(channels), row_(channels.size() * width) {
        for (const ExrChannelSource& channel : channels)
            planes_.emplace_back(std::size_t{kExrRowsPerChunk} * width * size_of(channel.type));
    }
    ~ChunkEncoder() {
        if (pipeline_.context) exr_encoding_destroy(pipeline_.context, &pipeline_);
    }
    ChunkEncoder(const ChunkEncoder&) = delete;
    ChunkEncoder& operator=(const ChunkEncoder&) = delete;

    // The rows of the chunk. False: all of them are zero.
    bool fill(const exr_chunk_info_t& chunk, const ExrRow& source) {
        std::array<bool, kExrRowsPerChunk> filled{};
        for (std::uint32_t row = 0; row < rows_of(chunk); ++row) {
            filled[row] = source(static_cast<std::uint32_t>(chunk.start_y) + row, row_);
            if (filled[row]) store(row);
        }
        if (std::ranges::find(filled, true) == filled.end()) return false;
        for (std::uint32_t row = 0; row < rows_of(chunk); ++row)
            if (!filled[row]) clear(row);
        return true;
    }
    void fill_with_zeros(const exr_chunk_info_t& chunk) {
        for (std::uint32_t row = 0; row < rows_of(chunk); ++row) clear(row);
    }

    // What fill() left, compressed.
    exr_result_t encode(exr_const_context_t context, const exr_chunk_info_t& chunk, std::vector<std::byte>& out) {
        if (pipeline_.context) {
            if (const exr_result_t result = exr_encoding_update(context, 0, &chunk, &pipeline_)) return result;
        } else if (const exr_result_t result = exr_encoding_initialize(context, 0, &chunk, &pipeline_)) {
            return result;
        }
        connect_channels();
        if (const exr_result_t result = exr_encoding_choose_default_routines(context, 0, &pipeline_)) return result;
        pipeline_.encoding_user_data = &out;
        pipeline_.yield_until_ready_fn = nullptr;
        pipeline_.write_fn = keep;
        return exr_encoding_run(context, 0, &pipeline_);
    }

private:
    static std::uint32_t rows_of(const exr_chunk_info_t& chunk) { return static_cast<std::uint32_t>(chunk.height); }

    void store(std::uint32_t row) {
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            const std::size_t bytes = width_ * size_of(channels_[c].type);
            char* const out = planes_[c].data() + row * bytes;
            const float* const in = row_.data() + c * width_;
            if (channels_[c].type == ExrType::half)
                std::transform(in, in + width_, reinterpret_cast<half*>(out), to_half);
            else
                std::memcpy(out, in, bytes);
        }
    }
    void clear(std::uint32_t row) {
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            const std::size_t bytes = width_ * size_of(channels_[c].type);
            std::memset(planes_[c].data() + row * bytes, 0, bytes);
        }
    }

    // The library sorts channels by name.
    void connect_channels() {
        for (std::int16_t i = 0; i < pipeline_.channel_count; ++i) {
            exr_coding_channel_info_t& channel = pipeline_.channels[i];
            const auto at =
                std::ranges::find(channels_, std::string_view(channel.channel_name), &ExrChannelSource::name);
            LUMEL_CHECK(at != channels_.end(), channel.channel_name);
            const auto size = static_cast<std::int32_t>(size_of(at->type));
            channel.user_bytes_per_element = static_cast<std::int16_t>(size);
            channel.user_data_type = static_cast<std::uint16_t>(pixel_type(at->type));
            channel.user_pixel_stride = size;
            channel.user_line_stride = size * static_cast<std::int32_t>(width_);
            channel.encode_from_ptr =
                reinterpret_cast<const std::uint8_t*>(planes_[static_cast<std::size_t>(at - channels_.begin())].data());
        }
    }

    // A chunk of the size it had is read as not compressed, but OpenEXR before 3.4.8 leaves one that happens to come
    // out at that size compressed: its rows would be read as noise (its issue 2306).
    static exr_result_t keep(exr_encode_pipeline_t* pipeline) {
        const bool raw = pipeline->compressed_bytes == pipeline->packed_bytes;
        const auto* const bytes =
            static_cast<const std::byte*>(raw ? pipeline->packed_buffer : pipeline->compressed_buffer);
        static_cast<std::vector<std::byte>*>(pipeline->encoding_user_data)
            ->assign(bytes, bytes + pipeline->compressed_bytes);
        return EXR_ERR_SUCCESS;
    }

    std::uint32_t width_;
    std::span<const ExrChannelSource> channels_;
    std::vector<std::vector<char>> planes_;  // one per channel
    std::vector<float> row_;                 // of all channels
    exr_encode_pipeline_t pipeline_{};
};

// The chunks of a file, some at a time.
class ChunkWriter {
public:
    ChunkWriter(ExrFile& file, std::uint32_t width, std::uint32_t height, std::span<const ExrChannelSource> channels,
                const ExrRow& row, Context* context)
        : file_(file), height_(height), row_(row), context_(context) {
        const unsigned threads = context ? context->threads() : 1;
        for (unsigned i = 0; i < threads; ++i) encoders_.push_back(std::make_unique<ChunkEncoder>(width, channels));
        batch_.resize(threads);
    }

    // Chunks from row `y` on; returns the row after them, nothing where cancelled.
    std::optional<std::uint32_t> write_batch(std::uint32_t y) {
        std::size_t count = 0;
        for (std::uint32_t first = y; first < height_ && count < batch_.size(); first += kExrRowsPerChunk)
            batch_[count++].info = file_.chunk_info(first);
        const auto encode = [&](const ChunkRange& range) {
            for (std::size_t i = range.begin; i < range.end; ++i) encode_chunk(*encoders_[range.worker], batch_[i]);
        };
        if (!file_.ok()) return y;
        if (!context_)
            encode({0, 0, count, 0});
        else if (!parallel_for(*context_, count, 1, encode))
            return std::nullopt;
        for (const Chunk& chunk : std::span(batch_).first(count)) {
            write_chunk(chunk);
            y += static_cast<std::uint32_t>(chunk.info.height);
        }
        return y;
    }

private:
    struct Chunk {
        exr_chunk_info_t info{};
        bool empty = false;
        exr_result_t result = EXR_ERR_SUCCESS;
        std::vector<std::byte> bytes;
    };

    void encode_chunk(ChunkEncoder& encoder, Chunk& chunk) const {
        chunk.empty = !encoder.fill(chunk.info, row_);
        if (!chunk.empty) chunk.result = encoder.encode(file_.context(), chunk.info, chunk.bytes);
    }

    void write_chunk(const Chunk& chunk) {
        if (chunk.result != EXR_ERR_SUCCESS) return file_.fail(chunk.result);
        file_.write_chunk(static_cast<std::uint32_t>(chunk.info.start_y), chunk.empty ? zeros(chunk) : chunk.bytes);
    }

    // An empty chunk of so many rows: as many as the others, but for the last one.
    std::span<const std::byte> zeros(const Chunk& like) {
        if (zero_rows_ != like.info.height) {
            encoders_[0]->fill_with_zeros(like.info);
            if (const exr_result_t result = encoders_[0]->encode(file_.context(), like.info, zeros_))
                file_.fail(result);
            zero_rows_ = like.info.height;
        }
        return zeros_;
    }

    ExrFile& file_;
    std::uint32_t height_;
    const ExrRow& row_;
    Context* context_;
    std::vector<std::unique_ptr<ChunkEncoder>> encoders_;  // one per thread
    std::vector<Chunk> batch_;
    std::vector<std::byte> zeros_;
    std::int32_t zero_rows_ = 0;
};

}  // namespace

Status write_exr(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                 std::span<const ExrChannelSource> channels, const ExrRow& row, Context* context,
                 const std::function<void(double)>& progress) {
    LUMEL_CHECK(width > 0 && height > 0 && !channels.empty(), width, height, channels.size());
    AtomicFile file(path);
    if (!file.ok()) return file.commit();
    ExrFile output(file, path.string(), width, height, channels);
    {
        ChunkWriter chunks(output, width, height, channels, row, context);
        for (std::uint32_t y = 0; y < height && output.ok();) {
            const std::optional<std::uint32_t> next = chunks.write_batch(y);
            if (!next) return cancelled_error();
            y = *next;
            if (progress && output.ok()) progress(static_cast<double>(y) / height);
        }
    }
    output.finish();
    if (file.ok() && !output.ok())
        return Error{ErrorCode::io, std::string("writing OpenEXR failed: ") + output.error(), path.string(),
                     "check the disk, or choose another folder with -o"};
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
