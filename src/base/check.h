// LUMEL_CHECK(condition, values...): a bug of ours. Prints the condition, the place and the values, then aborts.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

namespace lumel::detail {

template <class... Values>
[[noreturn]] void check_failed(const char* condition, const char* file, int line, const Values&... values) {
    std::ostringstream out;
    ((out << " " << values), ...);
    std::fprintf(stderr, "%s:%d: LUMEL_CHECK(%s) failed:%s\n", file, line, condition, out.str().c_str());
    std::abort();
}

}  // namespace lumel::detail

#define LUMEL_CHECK(condition, ...)                                                                                 \
    do {                                                                                                            \
        if (!(condition)) ::lumel::detail::check_failed(#condition, __FILE__, __LINE__ __VA_OPT__(, ) __VA_ARGS__); \
    } while (false)
