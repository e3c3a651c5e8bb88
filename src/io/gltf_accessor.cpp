// Accessors: shape, bounds, sparse values, numbers. glTF 2.0, sections 3.6.2 and 3.11.
#include "io/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/check.h"
#include "base/try.h"

namespace lumel {
namespace {

struct ElementShape {
    std::uint32_t columns = 1, rows = 1;
};

Result<ElementShape> element_shape(const std::string& type, const std::string& where) {
    static constexpr struct {
        std::string_view name;
        ElementShape shape;
    } kShapes[] = {{"SCALAR", {1, 1}}, {"VEC2", {1, 2}}, {"VEC3", {1, 3}}, {"VEC4", {1, 4}},
                   {"MAT2", {2, 2}},   {"MAT3", {3, 3}}, {"MAT4", {4, 4}}};
    for (const auto& entry : kShapes)
        if (entry.name == type) return entry.shape;
    return invalid(where, "'type' is '" + type + "', which glTF does not know");
}

Result<Component> component_type(const Json& object, const std::string& where) {
    LUMEL_TRY(const std::uint64_t code, required_count(object, "componentType", where));
    for (const Component known : {Component::int8, Component::uint8, Component::int16, Component::uint16,
                                  Component::uint32, Component::float32})
        if (code == static_cast<std::uint64_t>(known)) return known;
    return invalid(where, "'componentType' is " + std::to_string(code) + ", which glTF does not know");
}

// `count` elements of `size` bytes, `stride` apart, beginning `offset` into a view.
struct Range {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
};

Result<Range> range_in_view(const GltfDocument& document, const Json& holder, std::uint64_t count, std::size_t size,
                            const std::string& where) {
    LUMEL_TRY(const std::uint64_t view, required_count(holder, "bufferView", where));
    LUMEL_TRY(const std::uint64_t offset, count_or(holder, "byteOffset", 0, where));
    if (view >= document.views.size())
        return invalid(where, "refers to bufferViews[" + std::to_string(view) + "], which does not exist");
    const std::span<const std::byte> bytes = document.views[view];
    const std::size_t stride = document.view_strides[view] ? document.view_strides[view] : size;
    if (stride < size) return invalid(where, "its elements overlap: they are larger than the view's byteStride");
    const bool fits = offset <= bytes.size() && count >= 1 && bytes.size() - offset >= size &&
                      (count - 1) <= (bytes.size() - offset - size) / stride;
    if (!fits)
        return invalid(where, std::to_string(count) + " elements at byte " + std::to_string(offset) +
                                  " reach beyond bufferView " + std::to_string(view) + " (" +
                                  std::to_string(bytes.size()) + " bytes)");
    return Range{bytes.data() + offset, stride};
}

std::uint32_t read_index(const std::byte* at, Component component) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, component_size(component));  // little endian, as glTF and all machines we build for
    return value;
}

bool is_index_type(Component component) {
    return component == Component::uint8 || component == Component::uint16 || component == Component::uint32;
}

// Overwrites the elements that the sparse part lists.
Status apply_sparse(const GltfDocument& document, const Json& sparse, std::uint64_t count, std::size_t element_size,
                    std::vector<std::byte>& elements, const std::string& where) {
    LUMEL_TRY(const std::uint64_t changed, required_count(sparse, "count", where));
    LUMEL_TRY(const Json* indices, optional_object(sparse, "indices", where));
    LUMEL_TRY(const Json* values, optional_object(sparse, "values", where));
    if (!indices || !values) return invalid(where, "'sparse' needs 'indices' and 'values'");
    LUMEL_TRY(const Component component, component_type(*indices, where));
    if (!is_index_type(component)) return invalid(where, "sparse indices must be unsigned integers");
    LUMEL_TRY(const Range from, range_in_view(document, *indices, changed, component_size(component), where));
    LUMEL_TRY(const Range data, range_in_view(document, *values, changed, element_size, where));
    for (std::uint64_t i = 0; i < changed; ++i) {
        const std::uint32_t target = read_index(from.first + i * from.stride, component);
        if (target >= count)
            return invalid(where, "sparse index " + std::to_string(target) + " is out of range: there are " +
                                      std::to_string(count) + " elements");
        std::memcpy(elements.data() + target * element_size, data.first + i * data.stride, element_size);
    }
    return success();
}

}  // namespace

std::size_t component_size(Component component) {
    switch (component) {
        case Component::int8:
        case Component::uint8: return 1;
        case Component::int16:
        case Component::uint16: return 2;
        case Component::uint32:
        case Component::float32: return 4;
    }
    return 4;
}

float component_number(const std::byte* at, Component component, bool normalized) {
    const auto read = [at](auto value) {
        std::memcpy(&value, at, sizeof(value));
        return value;
    };
    switch (component) {
        case Component::float32: return read(float{});
        case Component::uint32: return static_cast<float>(read(std::uint32_t{}));
        case Component::uint8: return read(std::uint8_t{}) / (normalized ? 255.0f : 1.0f);
        case Component::uint16: return read(std::uint16_t{}) / (normalized ? 65535.0f : 1.0f);
        case Component::int8:
            return normalized ? std::max(read(std::int8_t{}) / 127.0f, -1.0f) : static_cast<float>(read(std::int8_t{}));
        case Component::int16:
            return normalized ? std::max(read(std::int16_t{}) / 32767.0f, -1.0f)
                              : static_cast<float>(read(std::int16_t{}));
    }
    return 0.0f;
}

const std::byte* AccessorView::at(std::uint64_t i, std::uint32_t c) const {
    return first_ + i * stride_ + (c / rows_) * column_stride_ + (c % rows_) * component_size(component);
}

float AccessorView::number(std::uint64_t i, std::uint32_t c) const {
    return component_number(at(i, c), component, normalized);
}

std::uint32_t AccessorView::index(std::uint64_t i) const {
    LUMEL_CHECK(is_index_type(component));
    return read_index(at(i, 0), component);
}

void AccessorView::copy_element(std::uint64_t i, std::byte* out) const {
    const std::size_t size = component_size(component);
    for (std::uint32_t c = 0; c < components; ++c) std::memcpy(out + c * size, at(i, c), size);
}

Result<AccessorView> open_accessor(const GltfDocument& document, std::uint64_t index) {
    const std::string where = document.where + ": accessor " + std::to_string(index);
    LUMEL_TRY(const Json* accessor, element(document.root, "accessors", index, document.where));
    AccessorView view;
    LUMEL_TRY(view.component, component_type(*accessor, where));
    LUMEL_TRY(view.normalized, bool_or(*accessor, "normalized", false, where));
    LUMEL_TRY(view.count, required_count(*accessor, "count", where));
    LUMEL_TRY(const std::string type, required_string(*accessor, "type", where));
    LUMEL_TRY(const ElementShape shape, element_shape(type, where));
    view.components = shape.columns * shape.rows;
    view.rows_ = shape.rows;
    // Columns of matrices begin at multiples of four bytes.
    const std::size_t column = shape.rows * component_size(view.component);
    view.column_stride_ = shape.columns > 1 ? (column + 3) / 4 * 4 : column;
    const std::size_t size = view.column_stride_ * shape.columns;
    if (view.count == 0) return invalid(where, "has no elements");

    LUMEL_TRY(const Json* sparse, optional_object(*accessor, "sparse", where));
    const bool has_view = find(*accessor, "bufferView") != nullptr;
    Range range;
    if (has_view) {
        LUMEL_TRY(range, range_in_view(document, *accessor, view.count, size, where));
    }
    view.first_ = range.first;
    view.stride_ = range.stride;
    if (has_view && !sparse) return view;

    // Without a view all elements are zero: nothing in the file backs their number, so it is bounded by the file's
    // size.
    if (!has_view && view.count > ((std::uint64_t{16} << 20) + 64 * document.file_bytes) / size)
        return invalid(where, "asks for " + std::to_string(view.count) + " elements without data");
    view.owned_.resize(view.count * size);
    for (std::uint64_t i = 0; has_view && i < view.count; ++i)
        std::memcpy(view.owned_.data() + i * size, range.first + i * range.stride, size);
    if (sparse) LUMEL_TRY_STATUS(apply_sparse(document, *sparse, view.count, size, view.owned_, where));
    view.first_ = view.owned_.data();
    view.stride_ = size;
    return view;
}

float AccessorBytes::number(std::uint64_t i, std::uint32_t c) const {
    return component_number(bytes.data() + (i * components + c) * component_size(component), component, normalized);
}

std::uint32_t AccessorBytes::index(std::uint64_t i) const {
    LUMEL_CHECK(is_index_type(component));
    return read_index(bytes.data() + i * components * component_size(component), component);
}

Result<AccessorBytes> GltfDocument::accessor_bytes(std::uint64_t accessor) const {
    LUMEL_TRY(const AccessorView view, open_accessor(*this, accessor));
    AccessorBytes out{view.component, view.normalized, view.components, view.count, {}};
    const std::size_t size = view.packed_size();
    out.bytes.resize(view.count * size);
    for (std::uint64_t i = 0; i < view.count; ++i) view.copy_element(i, out.bytes.data() + i * size);
    return out;
}

}  // namespace lumel
