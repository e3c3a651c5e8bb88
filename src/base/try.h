// Early return of errors. `LUMEL_TRY(auto image, read_exr(path));` declares `image` or returns the error.
#pragma once

#include "lumel/result.h"

#define LUMEL_CONCAT_INNER(a, b) a##b
#define LUMEL_CONCAT(a, b) LUMEL_CONCAT_INNER(a, b)

#define LUMEL_TRY(declaration, ...) LUMEL_TRY_NAMED(LUMEL_CONCAT(lumel_result_, __LINE__), declaration, __VA_ARGS__)
#define LUMEL_TRY_NAMED(name, declaration, ...)     \
    auto name = (__VA_ARGS__);                      \
    if (!name.ok()) return std::move(name).error(); \
    declaration = std::move(name).value()

// For functions that return Status: nothing to declare.
#define LUMEL_TRY_STATUS(...) LUMEL_TRY_STATUS_NAMED(LUMEL_CONCAT(lumel_status_, __LINE__), __VA_ARGS__)
#define LUMEL_TRY_STATUS_NAMED(name, ...) \
    if (auto name = (__VA_ARGS__); !name.ok()) return std::move(name).error()
