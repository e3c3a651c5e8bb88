// lumel_samples FOLDER [gallery | leaks | plain | town BUILDINGS | lamps COUNT | charts COUNT [SEED]]: writes sample
// scenes and chart masks.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "samples.h"

int main(int argc, char** argv) {
    using namespace lumel;
    const std::string which = argc > 2 ? argv[2] : "gallery";
    const bool counted = which == "town" || which == "lamps" || which == "charts";
    const bool known = counted || which == "gallery" || which == "leaks" || which == "plain";
    if (argc < 2 || !known || (counted && argc < 4)) {
        std::fprintf(stderr,
                     "usage: lumel_samples FOLDER [gallery | leaks | plain | town BUILDINGS | lamps COUNT | "
                     "charts COUNT [SEED]]\n");
        return 2;
    }
    const auto number = [&](int i) {
        return argc > i ? static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)) : 1u;
    };
    std::error_code ignored;
    std::filesystem::create_directories(argv[1], ignored);
    const Status status = which == "town"     ? samples::write_town(argv[1], number(3))
                          : which == "charts" ? samples::write_charts(argv[1], std::max(1u, number(3)), number(4))
                          : which == "lamps"  ? samples::write_lamps(argv[1], std::max(1u, number(3)))
                          : which == "plain"  ? samples::write_plain(argv[1])
                          : which == "leaks"  ? samples::write_leaks(argv[1])
                                              : samples::write_gallery(argv[1]);
    if (status.ok()) return 0;
    std::fprintf(stderr, "lumel_samples: %s\n", status.error().text().c_str());
    return 1;
}
