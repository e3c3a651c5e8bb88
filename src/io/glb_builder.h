// Puts a .glb together: one buffer, bufferViews and accessors that keep their numbers where an unknown extension might
// know them, new ones in the gaps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/gltf_document_internal.h"
#include "lumel/result.h"

namespace lumel {

// glTF's bufferView.target; none for data that is neither.
enum class ViewTarget : std::uint16_t { none = 0, vertices = 34962, indices = 34963 };

class GlbBuilder {
public:
    // `root` is the document to write; its accessors, bufferViews and buffers are replaced.
    explicit GlbBuilder(Json root);

    [[nodiscard]] Json& root() { return root_; }

    // Declares what stays at its number; all other numbers are given to new objects. Before any add.
    void set_kept(const std::vector<bool>& accessors, const std::vector<bool>& views);

    // A new bufferView over bytes appended to the buffer. `stride` 0: tightly packed.
    std::uint32_t add_view(std::span<const std::byte> bytes, ViewTarget target, std::size_t stride = 0);
    void put_view(std::uint32_t index, std::span<const std::byte> bytes, ViewTarget target, std::size_t stride = 0);
    // Packed elements as a view of their own, padded as glTF wants it for vertex attributes and matrix columns.
    // `accessor` says its type.
    std::uint32_t add_elements(std::span<const std::byte> packed, std::uint32_t components, std::size_t component_bytes,
                               const Json& accessor, ViewTarget target);
    // A number for a view whose bytes come later by put_view.
    std::uint32_t reserve_view();

    std::uint32_t add_accessor(Json accessor);
    void put_accessor(std::uint32_t index, Json accessor);

    // An accessor over a view of its own.
    template <class T>
    std::uint32_t add_array(std::span<const T> values, Component component, const char* type, std::size_t count,
                            ViewTarget target) {
        const std::uint32_t view = add_view(std::as_bytes(values), target);
        return add_accessor(accessor_json(view, 0, component, type, count));
    }
    // Unsigned integers, 16 bits where all fit below 65535 (the restart index), else 32.
    std::uint32_t add_unsigned(std::span<const std::uint32_t> values, ViewTarget target);

    static Json accessor_json(std::uint32_t view, std::size_t offset, Component component, const char* type,
                              std::size_t count);

    // Error: io, or unsupported where the file would pass 4 GB.
    Status write(const std::filesystem::path& path);

private:
    Json view_json(std::span<const std::byte> bytes, ViewTarget target, std::size_t stride);
    void finish();

    Json root_;
    std::vector<std::byte> buffer_;
    std::vector<Json> accessors_, views_;
    std::vector<std::uint32_t> free_accessors_, free_views_;  // descending: the lowest is given first
};

// Attributes want each element on a multiple of four bytes, and so the columns of matrices: rows of `count` elements of
// `element` bytes padded to `stride`.
std::vector<std::byte> pad_elements(std::span<const std::byte> packed, std::size_t element, std::size_t stride);

}  // namespace lumel
