// Writes what cases.glsl is given and gives as C++, for scripts/oracle/shaders_gpu.py: per case 36 floats (which, kind:
// 0 test_decode, 1 test_other; 27 numbers; n_v; n; one unused) and three of the result.
#include <cstdio>

#include "shaders/case_inputs.h"
#include "shaders/library.h"

namespace lumel {
namespace {

namespace glsl = test::glsl;

void write_case(std::FILE* file, unsigned kind, unsigned which, const Numbers& numbers, Vec3 n_v, Vec3 n) {
    const auto at = [&](std::size_t i) { return glsl::vec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]); };
    const glsl::LumelSh a{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)};
    const glsl::vec3 to(n.x, n.y, n.z), from(n_v.x, n_v.y, n_v.z);
    const glsl::vec3 out = kind == 0 ? glsl::test_decode(which, a, to) : glsl::test_other(which, a, from, to);
    std::array<float, 39> row{static_cast<float>(which), static_cast<float>(kind)};
    std::ranges::copy(numbers, row.begin() + 2);
    const std::array<float, 10> tail{n_v.x, n_v.y, n_v.z, n.x, n.y, n.z, 0, out.x, out.y, out.z};
    std::ranges::copy(tail, row.begin() + 29);
    std::fwrite(row.data(), sizeof(float), row.size(), file);
}

int dump(const char* path) {
    std::FILE* file = std::fopen(path, "wb");
    if (file == nullptr) return 1;
    test::Random uniform;
    const Vec3 up{0, 0, 1};
    for (int repeat = 0; repeat < 200; ++repeat) {
        const TexelLight light = test::random_light(uniform);
        for (const auto& [name, which] : test::kDecodes)
            write_case(file, 0, which, test::solved(*find_encoding(name), light), up, uniform.up());
        for (unsigned which = 0; which < test::kOthers; ++which) {
            const bool probes = which >= 10 && which <= 13;
            write_case(file, 1, which, test::solved(probes ? kL2 : kL1Hhd, light), uniform.up(), uniform.up());
        }
    }
    return std::fclose(file);
}

}  // namespace
}  // namespace lumel

int main(int count, char** arguments) { return count == 2 ? lumel::dump(arguments[1]) : 2; }
