// Accessors seen in place: no copy unless the accessor is sparse or has no data of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/gltf_document_internal.h"

namespace lumel {

class AccessorView {
public:
    AccessorView() = default;
    AccessorView(AccessorView&&) = default;
    AccessorView& operator=(AccessorView&&) = default;

    Component component = Component::float32;
    bool normalized = false;
    std::uint32_t components = 1;
    std::uint64_t count = 0;

    // Component c of element i as a float, normalised integers mapped as glTF says. Preconditions: i < count,
    // c < components.
    [[nodiscard]] float number(std::uint64_t i, std::uint32_t c) const;
    [[nodiscard]] std::uint32_t index(std::uint64_t i) const;
    // False for a default-constructed view: an attribute that the primitive does not have.
    [[nodiscard]] bool present() const { return count > 0; }
    // True where opening it took memory of its own: sparse, or without a view.
    [[nodiscard]] bool owns_storage() const { return !owned_.empty(); }
    // Copies element i, tightly packed.
    void copy_element(std::uint64_t i, std::byte* out) const;
    [[nodiscard]] std::size_t packed_size() const { return components * component_size(component); }

private:
    friend Result<AccessorView> open_accessor(const GltfDocument& document, std::uint64_t accessor);

    [[nodiscard]] const std::byte* at(std::uint64_t i, std::uint32_t c) const;

    std::uint32_t rows_ = 1;         // per column; all components but for matrices
    std::size_t column_stride_ = 0;  // bytes
    std::size_t stride_ = 0;         // bytes from element to element
    const std::byte* first_ = nullptr;
    std::vector<std::byte> owned_;  // storage of sparse accessors; first_ points into it
};

Result<AccessorView> open_accessor(const GltfDocument& document, std::uint64_t accessor);

// One stored component as a number.
float component_number(const std::byte* at, Component component, bool normalized);

}  // namespace lumel
