// A small JSON Schema validator: the keywords that docs/schema/ uses. A keyword it does not know is an error, so that
// no schema passes by not being understood.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace lumel::test {

class JsonSchema {
public:
    using Json = nlohmann::ordered_json;

    explicit JsonSchema(Json schema) : root_(std::move(schema)) {}

    // What is wrong, one line each; empty if nothing.
    [[nodiscard]] std::vector<std::string> errors(const Json& value) const {
        std::vector<std::string> out;
        check(root_, value, "", out);
        return out;
    }

private:
    using Errors = std::vector<std::string>;

    static bool has_type(const Json& value, const std::string& type) {
        if (type == "integer")
            return value.is_number_integer() ||
                   (value.is_number() && std::floor(value.get<double>()) == value.get<double>());
        if (type == "number") return value.is_number();
        if (type == "string") return value.is_string();
        if (type == "boolean") return value.is_boolean();
        if (type == "array") return value.is_array();
        if (type == "object") return value.is_object();
        return type == "null" && value.is_null();
    }

    static bool has_any_type(const Json& value, const Json& types) {
        if (types.is_string()) return has_type(value, types.get<std::string>());
        for (const Json& type : types)
            if (has_type(value, type.get<std::string>())) return true;
        return false;
    }

    void check(const Json& schema, const Json& value, const std::string& at, Errors& out) const {
        const auto fail = [&](const std::string& what) { out.push_back((at.empty() ? "/" : at) + ": " + what); };
        if (schema.is_boolean()) {
            if (!schema.get<bool>()) fail("is not allowed");
            return;
        }
        for (const auto& [keyword, rule] : schema.items()) {
            if (keyword == "$schema" || keyword == "$id" || keyword == "title" || keyword == "description" ||
                keyword == "$defs" || keyword == "default" || keyword == "examples" || keyword == "$comment")
                continue;
            if (keyword == "$ref") {
                check(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, at, out);
            } else if (keyword == "type") {
                if (!has_any_type(value, rule)) return fail("is not of type " + rule.dump());
            } else if (keyword == "const") {
                if (value != rule) fail("is not " + rule.dump());
            } else if (keyword == "enum") {
                if (std::find(rule.begin(), rule.end(), value) == rule.end()) fail("is none of " + rule.dump());
            } else if (!check_number(keyword, rule, value, fail) && !check_array(keyword, rule, value, at, out) &&
                       !check_object(schema, keyword, rule, value, at, out) &&
                       !check_text(keyword, rule, value, fail)) {
                fail("schema keyword '" + keyword + "' is not known to this validator");
            }
        }
    }

    template <class Fail>
    static bool check_number(const std::string& keyword, const Json& rule, const Json& value, Fail&& fail) {
        static const std::set<std::string> kKeywords{"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"};
        if (!kKeywords.count(keyword)) return false;
        if (!value.is_number()) return true;
        const double v = value.get<double>(), limit = rule.get<double>();
        const bool ok = keyword == "minimum"            ? v >= limit
                        : keyword == "maximum"          ? v <= limit
                        : keyword == "exclusiveMinimum" ? v > limit
                                                        : v < limit;
        if (!ok) fail("breaks " + keyword + " " + rule.dump());
        return true;
    }

    template <class Fail>
    static bool check_text(const std::string& keyword, const Json& rule, const Json& value, Fail&& fail) {
        if (keyword != "pattern") return false;
        if (value.is_string() && !std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>())))
            fail("does not match " + rule.dump());
        return true;
    }

    bool check_array(const std::string& keyword, const Json& rule, const Json& value, const std::string& at,
                     Errors& out) const {
        if (keyword == "minItems" || keyword == "maxItems") {
            const bool ok = !value.is_array() || (keyword == "minItems" ? value.size() >= rule.get<std::size_t>()
                                                                        : value.size() <= rule.get<std::size_t>());
            if (!ok) out.push_back(at + ": breaks " + keyword);
            return true;
        }
        if (keyword != "items") return false;
        for (std::size_t i = 0; value.is_array() && i < value.size(); ++i)
            check(rule, value[i], at + "/" + std::to_string(i), out);
        return true;
    }

    bool check_object(const Json& schema, const std::string& keyword, const Json& rule, const Json& value,
                      const std::string& at, Errors& out) const {
        if (keyword == "required") {
            for (const Json& name : rule)
                if (value.is_object() && !value.contains(name.get<std::string>()))
                    out.push_back(at + ": lacks " + name.dump());
            return true;
        }
        if (keyword == "properties") {
            for (const auto& [name, member] : rule.items())
                if (value.is_object() && value.contains(name)) check(member, value[name], at + "/" + name, out);
            return true;
        }
        if (keyword != "additionalProperties") return false;
        const Json known = schema.value("properties", Json::object());
        for (const auto& [name, member] : value.items())
            if (value.is_object() && !known.contains(name)) check(rule, member, at + "/" + name, out);
        return true;
    }

    Json root_;
};

}  // namespace lumel::test
