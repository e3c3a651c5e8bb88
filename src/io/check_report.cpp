#include "io/check_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "image/tonemap.h"
#include "io/image_io.h"
#include "io/json_write.h"

namespace lumel {
namespace {

Json contrast_json(const SeamContrast& c) {
    return {{"samples", c.samples}, {"metres", c.metres}, {"visible_metres", c.visible_metres},
            {"median", c.median},   {"p99", c.p99},       {"largest", c.largest}};
}

std::string encode_base64(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) { return k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k]) : 0u; };
        const std::uint32_t word = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
        out += kDigits[word >> 18];
        out += kDigits[word >> 12 & 63];
        out += i + 1 < bytes.size() ? kDigits[word >> 6 & 63] : '=';
        out += i + 2 < bytes.size() ? kDigits[word & 63] : '=';
    }
    return out;
}

std::string escape(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '&')
            out += "&amp;";
        else
            out += c;
    }
    return out;
}

std::string value_text(const Finding& f, double value) {
    std::array<char, 64> text{};
    if (f.is_share)
        std::snprintf(text.data(), text.size(), "%.3f %%", 100.0 * value);
    else
        std::snprintf(text.data(), text.size(), "%.0f", value);
    return text.data();
}

std::string limit_text(const Finding& f) { return f.has_limit() ? value_text(f, f.limit) : "any"; }

// Frames of 7 x 7 texels around places, so that a single one is seen.
void mark(std::span<const Finding> findings, std::uint32_t page, std::uint32_t width, std::uint32_t height,
          std::vector<std::uint8_t>& rgb) {
    constexpr std::int64_t kReach = 3;
    for (const Finding& f : findings)
        for (const TexelDefect& d : f.places) {
            if (d.page != page) continue;
            for (std::int64_t j = -kReach; j <= kReach; ++j)
                for (std::int64_t i = -kReach; i <= kReach; ++i) {
                    const std::int64_t x = std::int64_t{d.x} + i, y = std::int64_t{d.y} + j;
                    const bool is_frame = std::max(i * i, j * j) == kReach * kReach;
                    if (!is_frame || x < 0 || y < 0 || x >= width || y >= height) continue;
                    std::uint8_t* pixel = &rgb[3 * static_cast<std::size_t>(y * width + x)];
                    pixel[0] = 255, pixel[1] = 0, pixel[2] = 255;
                }
        }
}

std::string page_picture(const CheckReport& report, std::uint32_t page, float exposure) {
    Image light = report.bake.pages[page].light;
    for (float& v : light.data)
        if (!(v >= 0.0f && v < 1e30f)) v = 0.0f;  // marked, not shown
    std::vector<std::uint8_t> rgb = tonemap(light, exposure);
    mark(report.findings, page, light.width, light.height, rgb);
    return encode_base64(encode_png(light.width, light.height, 3, rgb));
}

float exposure_of(const CheckedBake& bake) {
    Image light = bake.pages[0].light;
    std::vector<std::uint8_t> mask;
    for (std::size_t i = 0; i < bake.pages[0].state.size(); ++i) {
        mask.push_back(bake.pages[0].state[i] == TexelState::baked ? 1 : 0);
        for (std::uint32_t c = 0; c < light.channels; ++c)
            if (float& v = light.data[i * light.channels + c]; !(v >= 0.0f && v < 1e30f)) v = 0.0f;
    }
    return auto_exposure(light, mask);
}

}  // namespace

std::string advice(const CheckReport& report) {
    constexpr double kPlain = 0.01;  // of the seams' length
    const SeamContrast& seams = report.seams.open;
    if (report.remarks.seams_solved || !(seams.visible_metres > kPlain * seams.metres)) return {};
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "%.1f %% of the seams' length show; lumel bake --seams on makes both sides of each agree",
                  100.0 * seams.visible_metres / seams.metres);
    return text.data();
}

std::string check_json(const CheckReport& report) {
    Json out;
    out["version"] = 1;
    out["passed"] = std::ranges::all_of(report.findings, &Finding::passed);
    for (const Finding& f : report.findings) {
        Json places = Json::array();
        for (const TexelDefect& d : f.places) places.push_back({d.page, d.x, d.y});
        out["findings"].push_back({{"name", f.name},
                                   {"value", f.value},
                                   {"limit", f.has_limit() ? Json(f.limit) : Json()},
                                   {"passed", f.passed()},
                                   {"places", std::move(places)}});
    }
    out["bake_warnings"] = Json::array();
    for (const Diagnostic& w : report.remarks.warnings)
        out["bake_warnings"].push_back({{"code", w.code}, {"message", w.message}, {"count", w.count}});
    out["advice"] = advice(report);
    out["seams"] = {{"open", contrast_json(report.seams.open)}, {"parted", contrast_json(report.seams.parted)}};
    out["worst_seams"] = Json::array();
    for (const SeamDefect& d : report.seams.worst)
        out["worst_seams"].push_back(
            {{"contrast", d.contrast},
             {"position", json_array(d.position)},
             {"nodes", {report.bake.instances[d.instance_a], report.bake.instances[d.instance_b]}},
             {"page", d.page},
             {"texel", json_array(d.texels)}});
    out["texels"] = {{"baked", report.texels.baked},
                     {"filled", report.texels.filled},
                     {"texels_per_metre", report.texels.median_density}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string check_html(const CheckReport& report, const std::string& title) {
    std::string out =
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>lumel check</title>\n<style>body{font:15px "
        "sans-serif;margin:2em;background:#222;color:#ddd}td,th{padding:.2em 1em;text-align:left}.bad{color:#f66}.good"
        "{color:#6d6}img{min-width:min(100%,1024px);max-width:100%;image-rendering:pixelated;border:1px solid "
        "#555}</style>\n<h1>lumel check: ";
    const bool passed = std::ranges::all_of(report.findings, &Finding::passed);
    out += escape(title) + "</h1>\n<p class=" + (passed ? "good" : "bad") + ">" + verdict(report.findings) + "</p>\n";
    if (const std::string text = advice(report); !text.empty()) out += "<p>Advice: " + escape(text) + "</p>\n";
    out += "<table><tr><th>what<th>value<th>allowed<th></tr>\n";
    for (const Finding& f : report.findings)
        out += "<tr><td>" + f.text + "<td>" + (f.is_measured ? value_text(f, f.value) : "no seams") + "<td>" +
               limit_text(f) + "<td" +
               (!f.has_limit() ? ">"
                : f.passed()   ? " class=good>passed"
                               : " class=bad>failed: " + f.option) +
               "</tr>\n";
    out += "</table>\n";
    if (!report.remarks.warnings.empty()) out += "<h2>The bake warned of</h2>\n";
    for (const Diagnostic& w : report.remarks.warnings) {
        out += "<p>" + escape(w.message) + " [" + escape(w.code) + ", " + std::to_string(w.count) + " times]";
        for (const std::string& example : w.examples) out += "<br>" + escape(example);
        out += "</p>\n";
    }
    out += "<h2>Worst seams</h2>\n<table><tr><th>contrast<th>position (m)<th>nodes<th>page<th>texel</tr>\n";
    constexpr std::size_t kShown = 20;
    for (std::size_t i = 0; i < std::min(kShown, report.seams.worst.size()); ++i) {
        const SeamDefect& d = report.seams.worst[i];
        std::array<char, 160> numbers{};
        std::snprintf(numbers.data(), numbers.size(), "<tr><td>%.2f %%<td>%.3f, %.3f, %.3f<td>", 100.0 * d.contrast,
                      double{d.position.x}, double{d.position.y}, double{d.position.z});
        out += numbers.data() + escape(report.bake.instances[d.instance_a]) + " | " +
               escape(report.bake.instances[d.instance_b]);
        std::snprintf(numbers.data(), numbers.size(), "<td>%u<td>%.1f, %.1f</tr>\n", d.page, double{d.texels.x},
                      double{d.texels.y});
        out += numbers.data();
    }
    out += "</table>\n";
    const float exposure = exposure_of(report.bake);
    for (std::uint32_t p = 0; p < report.bake.pages.size(); ++p)
        out += "<h2>Page " + std::to_string(p) + "</h2>\n<img alt=\"page\" src=\"data:image/png;base64," +
               page_picture(report, p, exposure) + "\">\n";
    return out + "</html>\n";
}

}  // namespace lumel
