#include "io/glb_builder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "base/check.h"
#include "io/atomic_file.h"

namespace lumel {
namespace {

constexpr std::size_t kAlignment = 4;

void align(std::vector<std::byte>& bytes, std::byte filler = std::byte{0}) {
    while (bytes.size() % kAlignment != 0) bytes.push_back(filler);
}

// Numbers below `kept.size()` that are not kept, descending.
std::vector<std::uint32_t> gaps(const std::vector<bool>& kept) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = kept.size(); i-- > 0;)
        if (!kept[i]) out.push_back(static_cast<std::uint32_t>(i));
    return out;
}

std::uint32_t take_number(std::vector<std::uint32_t>& free, std::vector<Json>& list) {
    if (!free.empty()) {
        const std::uint32_t index = free.back();
        free.pop_back();
        return index;
    }
    list.emplace_back();
    return static_cast<std::uint32_t>(list.size() - 1);
}

Json array_of(std::vector<Json>& list) {
    Json out = Json::array();
    for (Json& item : list) out.push_back(std::move(item));
    return out;
}

std::array<std::byte, 8> chunk_header(std::size_t size, std::uint32_t type) {
    std::array<std::byte, 8> out{};
    const auto size32 = static_cast<std::uint32_t>(size);
    std::memcpy(out.data(), &size32, 4);
    std::memcpy(out.data() + 4, &type, 4);
    return out;
}

}  // namespace

GlbBuilder::GlbBuilder(Json root) : root_(std::move(root)) {}

void GlbBuilder::set_kept(const std::vector<bool>& accessors, const std::vector<bool>& views) {
    accessors_.resize(accessors.size());
    views_.resize(views.size());
    free_accessors_ = gaps(accessors);
    free_views_ = gaps(views);
}

Json GlbBuilder::view_json(std::span<const std::byte> bytes, ViewTarget target, std::size_t stride) {
    align(buffer_);
    Json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    if (target != ViewTarget::none) view["target"] = static_cast<unsigned>(target);
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    return view;
}

std::uint32_t GlbBuilder::reserve_view() { return take_number(free_views_, views_); }

void GlbBuilder::put_view(std::uint32_t index, std::span<const std::byte> bytes, ViewTarget target,
                          std::size_t stride) {
    LUMEL_CHECK(index < views_.size() && !bytes.empty(), index, bytes.size());
    views_[index] = view_json(bytes, target, stride);
}

std::uint32_t GlbBuilder::add_view(std::span<const std::byte> bytes, ViewTarget target, std::size_t stride) {
    const std::uint32_t index = reserve_view();
    put_view(index, bytes, target, stride);
    return index;
}

std::uint32_t GlbBuilder::add_accessor(Json accessor) {
    const std::uint32_t index = take_number(free_accessors_, accessors_);
    accessors_[index] = std::move(accessor);
    return index;
}

void GlbBuilder::put_accessor(std::uint32_t index, Json accessor) {
    LUMEL_CHECK(index < accessors_.size(), index);
    accessors_[index] = std::move(accessor);
}

std::uint32_t GlbBuilder::add_unsigned(std::span<const std::uint32_t> values, ViewTarget target) {
    const bool fits = std::all_of(values.begin(), values.end(), [](std::uint32_t v) { return v < 65535; });
    if (!fits) return add_array(values, Component::uint32, "SCALAR", values.size(), target);
    const std::vector<std::uint16_t> narrow(values.begin(), values.end());
    return add_array(std::span<const std::uint16_t>(narrow), Component::uint16, "SCALAR", narrow.size(), target);
}

std::uint32_t GlbBuilder::add_elements(std::span<const std::byte> packed, std::uint32_t components,
                                       std::size_t component_bytes, const Json& accessor, ViewTarget target) {
    const auto aligned = [](std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; };
    const Json* type = find(accessor, "type");
    const std::size_t columns = !type ? 1 : *type == "MAT2" ? 2 : *type == "MAT3" ? 3 : *type == "MAT4" ? 4 : 1;
    const std::size_t column = components / columns * component_bytes;
    if (columns > 1 && column % kAlignment != 0) return add_view(pad_elements(packed, column, aligned(column)), target);
    const std::size_t element = components * component_bytes;
    if (target != ViewTarget::vertices) return add_view(packed, target);
    if (element % kAlignment == 0) return add_view(packed, target, element);
    return add_view(pad_elements(packed, element, aligned(element)), target, aligned(element));
}

Json GlbBuilder::accessor_json(std::uint32_t view, std::size_t offset, Component component, const char* type,
                               std::size_t count) {
    Json out = {{"bufferView", view}};
    if (offset != 0) out["byteOffset"] = offset;
    out["componentType"] = static_cast<unsigned>(component);
    out["count"] = count;
    out["type"] = type;
    return out;
}

// Numbers that nobody took: the last ones go, those between become the smallest valid thing.
void GlbBuilder::finish() {
    const auto trim = [](std::vector<Json>& list) {
        while (!list.empty() && list.back().is_null()) list.pop_back();
    };
    trim(accessors_);
    trim(views_);
    for (Json& accessor : accessors_)
        if (accessor.is_null())
            accessor = {{"componentType", static_cast<unsigned>(Component::float32)}, {"count", 1}, {"type", "SCALAR"}};
    for (Json& view : views_)
        if (view.is_null()) view = view_json(std::array<std::byte, 4>{}, ViewTarget::none, 0);
    align(buffer_);
    const auto set = [&](const char* key, Json list) {
        root_.erase(key);
        if (!list.empty()) root_[key] = std::move(list);
    };
    set("accessors", array_of(accessors_));
    set("bufferViews", array_of(views_));
    set("buffers", buffer_.empty() ? Json::array() : Json::array({{{"byteLength", buffer_.size()}}}));
}

Status GlbBuilder::write(const std::filesystem::path& path) {
    finish();
    std::string json = root_.dump(-1, ' ', false, Json::error_handler_t::replace);
    while (json.size() % kAlignment != 0) json += ' ';
    constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
    const std::size_t binary = buffer_.empty() ? 0 : 8 + buffer_.size();
    const std::size_t total = 12 + 8 + json.size() + binary;
    if (total > std::numeric_limits<std::uint32_t>::max())
        return Error{ErrorCode::unsupported, "the scene needs more than the 4 GB that a .glb can hold", path.string(),
                     "split the scene, or use smaller textures"};
    const std::array<std::uint32_t, 3> header{kMagic, 2, static_cast<std::uint32_t>(total)};
    AtomicFile file(path);
    file.write(std::as_bytes(std::span(header)));
    file.write(chunk_header(json.size(), kJson));
    file.write(std::as_bytes(std::span(json)));
    if (binary != 0) {
        file.write(chunk_header(buffer_.size(), kBinary));
        file.write(buffer_);
    }
    return file.commit();
}

std::vector<std::byte> pad_elements(std::span<const std::byte> packed, std::size_t element, std::size_t stride) {
    LUMEL_CHECK(stride >= element && element > 0 && packed.size() % element == 0, packed.size(), element, stride);
    const std::size_t count = packed.size() / element;
    std::vector<std::byte> out(count * stride);
    for (std::size_t i = 0; i < count; ++i) std::memcpy(&out[i * stride], &packed[i * element], element);
    return out;
}

}  // namespace lumel
