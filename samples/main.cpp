// lumel_samples FOLDER [gallery | town BUILDINGS]: writes sample scenes.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "samples.h"

int main(int argc, char** argv) {
    using namespace lumel;
    const std::string which = argc > 2 ? argv[2] : "gallery";
    if (argc < 2 || (which != "gallery" && which != "town") || (which == "town" && argc < 4)) {
        std::fprintf(stderr, "usage: lumel_samples FOLDER [gallery | town BUILDINGS]\n");
        return 2;
    }
    std::error_code ignored;
    std::filesystem::create_directories(argv[1], ignored);
    const Status status =
        which == "town" ? samples::write_town(argv[1], static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10)))
                        : samples::write_gallery(argv[1]);
    if (status.ok()) return 0;
    std::fprintf(stderr, "lumel_samples: %s\n", status.error().text().c_str());
    return 1;
}
