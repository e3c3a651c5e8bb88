// Loads what a GltfBuilder built and keeps all that came of it.
#pragma once

#include <string>
#include <utility>

#include "io/gltf_document.h"
#include "support/gltf_builder.h"

namespace lumel::test {

struct Loaded {
    Context context{1};
    Result<LoadedScene> result;

    explicit Loaded(const GltfBuilder& builder) : result(load_glb(builder.glb(), "test.glb", context)) {}

    [[nodiscard]] const Scene& scene() const { return result->scene; }
    [[nodiscard]] std::string error() const { return result.ok() ? "no error" : result.error().text(); }
    [[nodiscard]] bool error_says(const std::string& text) const { return error().find(text) != std::string::npos; }
    [[nodiscard]] std::uint64_t notes(const char* code) const { return context.diagnostics.count(code); }
};

}  // namespace lumel::test
