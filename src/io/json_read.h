// Reading JSON that others wrote: a guarded parser and typed access that names the offending key. No exception passes.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "base/try.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

using Json = nlohmann::ordered_json;

inline Error invalid(std::string where, std::string message, std::string remedy = {}) {
    return {ErrorCode::invalid_input, std::move(message), std::move(where), std::move(remedy)};
}
inline Error unsupported(std::string where, std::string message, std::string remedy = {}) {
    return {ErrorCode::unsupported, std::move(message), std::move(where), std::move(remedy)};
}

// Bytes of a manifest, or of another JSON of ours. It is read whole, and its tree takes a few times as much beside it:
// those of the largest levels have some ten million bytes.
inline constexpr std::uint64_t kMaxManifest = std::uint64_t{512} << 20;

// Refuses documents nested or branched so that parsing them would take unbounded time or memory.
Result<Json> parse_json(std::string_view text, const std::string& where);

// The member, or nullptr where `object` is no object or has no such key.
const Json* find(const Json& object, const char* key);
// Nested: find(find(object, "extensions"), name).
const Json* find_extension(const Json& object, const char* name);

// Each returns the fallback where the key is absent and an error naming the key where the value has another type.
Result<double> number_or(const Json& object, const char* key, double fallback, const std::string& where);
Result<std::uint64_t> count_or(const Json& object, const char* key, std::uint64_t fallback, const std::string& where);
Result<bool> bool_or(const Json& object, const char* key, bool fallback, const std::string& where);
Result<std::string> string_or(const Json& object, const char* key, std::string fallback, const std::string& where);
Result<std::optional<std::uint64_t>> optional_count(const Json& object, const char* key, const std::string& where);

// The array, or nullptr where absent; an error where the value is no array.
Result<const Json*> optional_array(const Json& object, const char* key, const std::string& where);
// The object, or nullptr where absent.
Result<const Json*> optional_object(const Json& object, const char* key, const std::string& where);

// Element `index` of the array `key`, which must be an object: "meshes[7] does not exist".
Result<const Json*> element(const Json& object, const char* key, std::uint64_t index, const std::string& where);
// The same where only its presence matters: an error that names who refers to it.
Status element_exists(const Json& object, const char* key, std::uint64_t index, const std::string& where);
// Length of the array `key`, 0 where absent or of another type.
std::size_t array_size(const Json& object, const char* key);
// A reference by number in a document that was checked before: kNone where absent.
std::uint32_t index_of(const Json& value);
std::uint32_t index_at(const Json& object, const char* key);

// Required members.
Result<std::uint64_t> required_count(const Json& object, const char* key, const std::string& where);
Result<std::string> required_string(const Json& object, const char* key, const std::string& where);

// Exactly `size` finite numbers within the range of float.
Status read_numbers(const Json& array, const char* key, double* out, std::size_t size, const std::string& where);

template <std::size_t N>
Result<std::array<double, N>> numbers_or(const Json& object, const char* key, std::array<double, N> fallback,
                                         const std::string& where) {
    const Json* value = find(object, key);
    if (!value) return fallback;
    LUMEL_TRY_STATUS(read_numbers(*value, key, fallback.data(), N, where));
    return fallback;
}

// "mesh 3 'Wall'": how messages name the index-th element of a kind.
std::string label(const char* kind, std::uint64_t index, const Json& object);

}  // namespace lumel
