// What of the options lit a bake, as its manifest records it: whoever shows the bake later can show it in the same
// light.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lumel/options.h"
#include "lumel/result.h"

namespace lumel {

struct LightRecord {
    SkyOptions sky;  // its file as it is found from here
    SunOptions sun;
    Include include;
    double direct_scale = 1.0, indirect_scale = 1.0;
    std::string sky_hash;    // of the sky map's file; empty where the options named none
    std::string input_hash;  // hash_scene() of the scene as it was lit
};

// From the manifest of an output folder. Errors: io; invalid_input where it is no manifest of ours.
Result<LightRecord> read_light_record(const std::filesystem::path& folder);
// The same from its text, which `where` names in messages.
Result<LightRecord> parse_light_record(std::string_view manifest, const std::filesystem::path& folder,
                                       const std::string& where);

// Names the bytes of a file. Errors: io.
Result<std::string> hash_file(const std::filesystem::path& path);

}  // namespace lumel
