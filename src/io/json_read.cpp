// The guarded JSON parser and typed access to members.
#include "io/json_read.h"

#include <cmath>
#include <vector>

namespace lumel {
namespace {

// The limits below leave room for any real glTF: the largest exporters stay under a million values and 16 levels.
constexpr std::size_t kMaxDepth = 256;
constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 24;
// ordered_json finds keys by comparing with all earlier keys of the object, so an object of n keys costs n^2 / 2.
constexpr std::uint64_t kMaxKeyComparisons = std::uint64_t{1} << 28;

// Walks the document without building it.
class Guard : public nlohmann::json_sax<Json> {
public:
    [[nodiscard]] const std::string& problem() const { return problem_; }

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool start_object(std::size_t) override { return open(); }
    bool start_array(std::size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t&) override {
        comparisons_ += keys_.back()++;
        return comparisons_ <= kMaxKeyComparisons || stop("an object has too many keys");
    }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
        // The library's text is "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ...;
        // last read: '...'": its own number and the file's raw bytes, which may be no text at all, are of no use.
        std::string text = error.what();
        if (const std::size_t bracket = text.find("] "); bracket != std::string::npos) text = text.substr(bracket + 2);
        text = text.substr(0, text.find("; last read"));
        return stop("is no valid JSON at byte " + std::to_string(position) + ": " + text);
    }

private:
    bool stop(std::string problem) {
        problem_ = std::move(problem);
        return false;
    }
    bool value() { return ++values_ <= kMaxValues || stop("holds too many values"); }
    bool open() {
        keys_.push_back(0);
        return keys_.size() <= kMaxDepth ? value() : stop("is nested too deeply");
    }
    bool close() {
        keys_.pop_back();
        return true;
    }

    std::vector<std::uint64_t> keys_;  // per open object or array
    std::uint64_t values_ = 0, comparisons_ = 0;
    std::string problem_;
};

std::string quoted(const char* key) { return std::string("'") + key + "'"; }

bool is_float_number(const Json& value) {
    return value.is_number() && std::fabs(value.get<double>()) <= double{std::numeric_limits<float>::max()};
}

// Some exporters write whole numbers as 3.0.
std::optional<std::uint64_t> as_count(const Json& value) {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    if (!value.is_number_float()) return std::nullopt;
    const double number = value.get<double>();
    if (!(number >= 0.0 && number < 9007199254740992.0) || number != std::floor(number)) return std::nullopt;
    return static_cast<std::uint64_t>(number);
}

}  // namespace

Result<Json> parse_json(std::string_view text, const std::string& where) {
    try {
        Guard guard;
        if (!Json::sax_parse(text, &guard)) return invalid(where, guard.problem());
        return Json::parse(text);
    } catch (const std::exception& error) {
        return invalid(where, std::string("is no valid JSON: ") + error.what());
    }
}

const Json* find(const Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto member = object.find(key);
    return member == object.end() ? nullptr : &*member;
}

const Json* find_extension(const Json& object, const char* name) {
    const Json* extensions = find(object, "extensions");
    return extensions ? find(*extensions, name) : nullptr;
}

Result<double> number_or(const Json& object, const char* key, double fallback, const std::string& where) {
    const Json* value = find(object, key);
    if (!value) return fallback;
    if (!is_float_number(*value)) return invalid(where, quoted(key) + " must be a number");
    return value->get<double>();
}

Result<std::optional<std::uint64_t>> optional_count(const Json& object, const char* key, const std::string& where) {
    const Json* value = find(object, key);
    if (!value) return std::optional<std::uint64_t>{};
    const std::optional<std::uint64_t> count = as_count(*value);
    if (!count) return invalid(where, quoted(key) + " must be a whole number, zero or more");
    return count;
}

Result<std::uint64_t> count_or(const Json& object, const char* key, std::uint64_t fallback, const std::string& where) {
    LUMEL_TRY(const std::optional<std::uint64_t> count, optional_count(object, key, where));
    return count.value_or(fallback);
}

Result<std::uint64_t> required_count(const Json& object, const char* key, const std::string& where) {
    LUMEL_TRY(const std::optional<std::uint64_t> count, optional_count(object, key, where));
    if (!count) return invalid(where, quoted(key) + " is missing");
    return *count;
}

Result<bool> bool_or(const Json& object, const char* key, bool fallback, const std::string& where) {
    const Json* value = find(object, key);
    if (!value) return fallback;
    if (!value->is_boolean()) return invalid(where, quoted(key) + " must be true or false");
    return value->get<bool>();
}

Result<std::string> string_or(const Json& object, const char* key, std::string fallback, const std::string& where) {
    const Json* value = find(object, key);
    if (!value) return fallback;
    if (!value->is_string()) return invalid(where, quoted(key) + " must be a string");
    return value->get_ref<const std::string&>();
}

Result<std::string> required_string(const Json& object, const char* key, const std::string& where) {
    if (!find(object, key)) return invalid(where, quoted(key) + " is missing");
    return string_or(object, key, {}, where);
}

Result<const Json*> optional_array(const Json& object, const char* key, const std::string& where) {
    const Json* value = find(object, key);
    if (value && !value->is_array()) return invalid(where, quoted(key) + " must be an array");
    return value;
}

Result<const Json*> optional_object(const Json& object, const char* key, const std::string& where) {
    const Json* value = find(object, key);
    if (value && !value->is_object()) return invalid(where, quoted(key) + " must be an object");
    return value;
}

Result<const Json*> element(const Json& object, const char* key, std::uint64_t index, const std::string& where) {
    const std::string name = std::string(key) + "[" + std::to_string(index) + "]";
    const Json* array = find(object, key);
    if (!array || !array->is_array() || index >= array->size())
        return invalid(where, "refers to " + name + ", which does not exist");
    const Json* value = &(*array)[index];
    if (!value->is_object()) return invalid(where, name + " must be an object");
    return value;
}

Status element_exists(const Json& object, const char* key, std::uint64_t index, const std::string& where) {
    LUMEL_TRY([[maybe_unused]] const Json* found, element(object, key, index, where));
    return success();
}

std::size_t array_size(const Json& object, const char* key) {
    const Json* array = find(object, key);
    return array && array->is_array() ? array->size() : 0;
}

std::uint32_t index_of(const Json& value) { return value.is_number_unsigned() ? value.get<std::uint32_t>() : kNone; }

std::uint32_t index_at(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value ? index_of(*value) : kNone;
}

Status read_numbers(const Json& array, const char* key, double* out, std::size_t size, const std::string& where) {
    const Error wrong = invalid(where, quoted(key) + " must be an array of " + std::to_string(size) + " numbers");
    if (!array.is_array() || array.size() != size) return wrong;
    for (std::size_t i = 0; i < size; ++i) {
        if (!is_float_number(array[i])) return wrong;
        out[i] = array[i].get<double>();
    }
    return success();
}

std::string label(const char* kind, std::uint64_t index, const Json& object) {
    const std::string text = std::string(kind) + " " + std::to_string(index);
    const Json* name = find(object, "name");
    return name && name->is_string() ? text + " '" + name->get_ref<const std::string&>() + "'" : text;
}

}  // namespace lumel
