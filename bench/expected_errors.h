// What an independent double-precision program (NumPy, quadrature 24 x 48, nested golden-section search) finds for the
// same rows, to three decimals: lumel_bench encodings prints it beside its own figures.
#pragma once

#include <array>
#include <span>

namespace lumel::bench {

// In the order of the columns of its table; NaN where there is none.
struct ExpectedRow {
    const char* table;
    const char* model;
    std::array<double, 15> error;
};

// synthetic: constant, gradient, sun, two colours, window, ring, hemisphere + direction, all maps. maps, probes and
// sphere: the fourteen maps, all.
std::span<const ExpectedRow> expected_errors();

}  // namespace lumel::bench
