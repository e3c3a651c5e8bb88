#include "encoding_case.h"

#include <utility>

#include "math/constants.h"

namespace lumel::bench {

const HemisphereGrid& hemisphere_normals() {
    static const HemisphereGrid kGrid = hemisphere_grid(24, 48);
    return kGrid;
}

EncodingCase::EncodingCase(Environment e)
    : environment(std::move(e)), truth(irradiance(environment, hemisphere_normals().normal)) {
    const HemisphereGrid& grid = hemisphere_normals();
    light = exact_light(environment, grid, truth);
    for (std::size_t k = 0; k < truth.size(); ++k)
        mean += grid.weight[k] * (truth[k][0] + truth[k][1] + truth[k][2]) / (6 * static_cast<double>(kPi));
}

double squared_error(const EncodingCase& c, const Decoded& decoded) {
    double sum = 0;
    for (std::size_t k = 0; k < c.truth.size(); ++k) {
        const Vec3 v = decoded(hemisphere_normals().normal[k]);
        for (std::size_t i = 0; i < 3; ++i) {
            const double e = static_cast<double>(v[i]) - c.truth[k][i];
            sum += hemisphere_normals().weight[k] * e * e;
        }
    }
    return sum / (6 * static_cast<double>(kPi));
}

}  // namespace lumel::bench
