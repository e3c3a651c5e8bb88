#include "light/light_set.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/check.h"
#include "light/emissive.h"
#include "light/light_table.h"
#include "math/constants.h"
#include "math/discrete.h"
#include "math/trig.h"

namespace lumel {
namespace {

constexpr std::size_t kMostGroups = 64;  // of the local lights: as many as one learns of from a few hundred samples

bool emits(const Light& light) { return light.bake != LightBake::none && max_component(light.intensity) > 0.0f; }

bool is_bright(const SkyMap& map) {
    return std::any_of(map.radiance.begin(), map.radiance.end(), [](Vec3 c) { return max_component(c) > 0.0f; });
}

// As seen through the artist's controls; a light that they switch off gives no sample.
LightSample scaled(LightSample sample, Vec3 scale) {
    if (scale == Vec3{}) return {};
    sample.weight *= scale;
    return sample;
}
LightHit scaled(LightHit hit, Vec3 scale) {
    hit.radiance *= scale;
    return hit;
}

// As one of several lights, chosen with the given probability.
LightSample selected(LightSample sample, float probability, std::uint32_t group) {
    sample.weight = sample.weight / probability;
    sample.pdf *= probability;
    sample.group = group;
    return sample;
}

LightSample no_sample(std::uint32_t group) {
    LightSample none;
    none.group = group;
    return none;
}

}  // namespace

LightSet::LightSet(const Scene& scene, const WorldGeometry& geometry, SurfaceReader surfaces, Choice choice)
    : scene_(&scene), geometry_(&geometry), surfaces_(surfaces), choice_(choice) {
    add_sky();
    add_lights();
    add_emissive_triangles();
    if (!has_local()) return;
    if (choice_ == Choice::power)
        share_by_power();
    else
        build_trees();
}

void LightSet::add_sky() {
    const Sky& sky = scene_->sky;
    sky_rotation_ = sincos_turn(sky.rotation * kInvTwoPi);
    has_sky_ = sky.map ? is_bright(*sky.map) : max_component(sky.color) > 0.0f;
    if (sky.map && has_sky_) sky_sampler_.emplace(*sky.map);
}

void LightSet::add_lights() {
    for (std::uint32_t index = 0; index < scene_->lights.size(); ++index) {
        const Light& light = scene_->lights[index];
        if (!emits(light)) continue;
        switch (light.shape) {
            case LightShape::sun: add_sun(index); break;
            case LightShape::point:
            case LightShape::spot: add_shape(PunctualLight(light), index); break;
            case LightShape::rectangle: add_shape(RectangleLight(light), index); break;
            case LightShape::disc: add_shape(DiscLight(light), index); break;
            case LightShape::sphere: add_shape(SphereLight(light), index); break;
        }
    }
}

void LightSet::add_sun(std::uint32_t light) {
    const SunLight shape(scene_->lights[light]);
    const std::array<Vec3, 2> scale{artist_scale(light, false), artist_scale(light, true)};
    suns_.push_back({shape, scale, {scaled(shape.sample({}), scale[0]), scaled(shape.sample({}), scale[1])}});
}

void LightSet::add_shape(Shape shape, std::uint32_t light) {
    const auto power_of = [](const auto& s) { return s.power(); };
    const auto can_be_hit = [](const auto& s) { return s.can_be_hit(); };
    if (!(std::visit(power_of, shape) > 0.0)) return;  // no area
    if (std::visit(can_be_hit, shape)) hittable_.push_back(static_cast<std::uint32_t>(shapes_.size()));
    shapes_.push_back({shape, light});
}

void LightSet::add_emissive_triangles() {
    for (std::uint32_t triangle = 0; triangle < geometry_->triangle_count(); ++triangle) {
        if (!is_emitter(geometry_->triangles[triangle])) continue;
        // Areas that single precision cannot hold are left to the rays that hit them.
        const float area = geometry_->area(triangle);
        if (area > 0.0f && std::isfinite(area)) triangles_.emplace_back(*scene_, *geometry_, surfaces_, triangle);
    }
    if (triangles_.empty()) return;
    local_of_triangle_.assign(geometry_->triangle_count(), kNone);
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        local_of_triangle_[triangles_[i].triangle()] = static_cast<std::uint32_t>(shapes_.size() + i);
}

void LightSet::share_by_power() {
    std::vector<double> powers;
    powers.reserve(shapes_.size() + triangles_.size());
    for (const Local& local : shapes_)
        powers.push_back(std::visit([](const auto& shape) { return shape.power(); }, local.shape));
    for (const EmissiveTriangle& triangle : triangles_) powers.push_back(triangle.power());
    LUMEL_CHECK(shapes_.size() < kUnits / 2, shapes_.size());
    local_ends_.resize(powers.size());
    // Lights that no ray can hit must be sampled. A triangle too dim for a share is found by the rays that hit it.
    share_units(powers, shapes_.size(), local_ends_);
}

void LightSet::build_trees() {
    std::vector<LightBounds> bounds;
    bounds.reserve(shapes_.size() + triangles_.size());
    for (const Local& local : shapes_)
        bounds.push_back(std::visit([](const auto& shape) { return shape.bounds(); }, local.shape));
    for (const EmissiveTriangle& triangle : triangles_) bounds.push_back(triangle.bounds());
    // What the artist's controls switch off or dim is not worth its full share of samples.
    const bool one = std::ranges::all_of(shapes_, [&](const Local& local) {
        return artist_scale(local.light, false) == artist_scale(local.light, true);
    });
    for (const bool bounced : {false, true}) {
        if (bounced && one) break;
        std::vector<LightBounds> scaled_bounds = bounds;
        for (std::size_t i = 0; i < shapes_.size(); ++i)
            scaled_bounds[i].intensity *= double{strength(artist_scale(shapes_[i].light, bounced))};
        trees_.emplace_back(scaled_bounds, kMostGroups);
    }
}

LightSet::Chosen LightSet::choose_local(const Receiver& receiver, float u, bool bounced) const {
    if (choice_ == Choice::power) {
        const lumel::Choice chosen = choose(local_ends_, u);
        return {static_cast<std::uint32_t>(chosen.index), probability(chosen.units), kNone};
    }
    static_assert(LightTree::kNoLight == kNone);
    if (receiver.table && !bounced) {
        const lumel::Choice group = choose(receiver.table->ends, u);
        const std::uint32_t unit = unit_of(u) - receiver.table->begin(group.index);
        const LightTree::Chosen chosen = trees_[0].choose_in(groups()[group.index], unit, group.units, receiver);
        return {chosen.light, probability(chosen.units), static_cast<std::uint32_t>(group.index)};
    }
    const LightTree::Chosen chosen = tree(bounced).choose(receiver, u);
    return {chosen.light, probability(chosen.units), kNone};
}

float LightSet::probability_of(const Receiver& receiver, std::uint32_t local, bool bounced) const {
    if (choice_ == Choice::power) return probability(units_of(local_ends_, local));
    if (!receiver.table || bounced) return probability(tree(bounced).units_of(receiver, local));
    const std::uint32_t group = trees_[0].group_of_lights()[local];
    if (group == kNone) return 0.0f;
    return probability(trees_[0].units_in(groups()[group], receiver.table->units(group), receiver, local));
}

std::span<const LightTree::Subtree> LightSet::groups() const {
    const bool any = !trees_.empty() && trees_[0].groups().size() > 1;
    return any ? trees_[0].groups() : std::span<const LightTree::Subtree>();
}

bool LightSet::empty() const { return suns_.empty() && !has_sky_ && !has_local(); }

Vec3 LightSet::artist_scale(std::uint32_t light, bool bounced) const {
    const Light& l = scene_->lights[light];
    if (bounced) return l.indirect_color * l.indirect_scale;
    return l.bake == LightBake::all ? Vec3{1, 1, 1} : Vec3{};
}

LightSample LightSet::sample_sun(std::size_t sun, Vec2 u, bool bounced) const {
    const Sun& s = suns_[sun];
    return s.shape.has_size() ? scaled(s.shape.sample(u), s.scale[bounced]) : s.centre[bounced];
}

LightHit LightSet::sun(std::size_t sun, Vec3 direction, bool bounced) const {
    const Sun& s = suns_[sun];
    return s.shape.has_size() ? scaled(s.shape.intersect(direction), s.scale[bounced]) : LightHit{};
}

// A turn by the sky's rotation about +Y, and back.
Vec3 LightSet::to_world(Vec3 d) const {
    const auto [s, c] = sky_rotation_;
    return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}
Vec3 LightSet::to_map(Vec3 d) const {
    const auto [s, c] = sky_rotation_;
    return {c * d.x - s * d.z, d.y, c * d.z + s * d.x};
}

LightSample LightSet::sample_sky(Vec2 u) const {
    if (!sky_sampler_) return {};
    const SkySampler::Sample sample = sky_sampler_->sample(u);
    const Vec3 radiance = lookup(*scene_->sky.map, sample.direction);
    return {to_world(sample.direction), kInfiniteDistance, radiance / sample.pdf, sample.pdf, kNone};
}

LightHit LightSet::sky(Vec3 direction) const {
    if (!scene_->sky.map) return {scene_->sky.color, 0.0f, kInfiniteDistance};
    if (!sky_sampler_) return {};
    const Vec2 uv = sky_coordinates(to_map(direction));
    return {lookup(*scene_->sky.map, uv), sky_sampler_->pdf(uv), kInfiniteDistance};
}

LightSample LightSet::sample_local(const Receiver& receiver, float u_select, Vec2 u, bool bounced) const {
    if (!has_local()) return {};
    const auto [index, chance, group] = choose_local(receiver, u_select, bounced);
    if (index == kNone) return no_sample(group);
    const Vec3 point = receiver.position;
    if (index >= shapes_.size()) return selected(triangles_[index - shapes_.size()].sample(point, u), chance, group);
    const Local& local = shapes_[index];
    const Vec3 scale = artist_scale(local.light, bounced);
    if (scale == Vec3{}) return no_sample(group);
    const LightSample sample = std::visit([&](const auto& shape) { return shape.sample(point, u); }, local.shape);
    return scaled(selected(sample, chance, group), scale);
}

LightHit LightSet::intersect_shape(std::uint32_t index, const Receiver& receiver, Vec3 direction, bool bounced) const {
    const Local& local = shapes_[index];
    LightHit hit =
        std::visit([&](const auto& shape) { return shape.intersect(receiver.position, direction); }, local.shape);
    if (hit.pdf > 0.0f) hit.pdf *= probability_of(receiver, index, bounced);
    return scaled(hit, artist_scale(local.light, bounced));
}

LightHit LightSet::emissive(const Receiver& receiver, std::uint32_t triangle, float b1, float b2, Vec3 direction,
                            float distance, bool back_face, bool bounced) const {
    if (!is_emitter(geometry_->triangles[triangle])) return {};
    const std::uint32_t local = local_of_triangle_.empty() ? kNone : local_of_triangle_[triangle];
    if (local == kNone) {  // left to the rays that hit it
        LightHit hit =
            EmissiveTriangle(*scene_, *geometry_, surfaces_, triangle).hit(b1, b2, direction, distance, back_face);
        hit.pdf = 0.0f;
        return hit;
    }
    LightHit hit = triangles_[local - shapes_.size()].hit(b1, b2, direction, distance, back_face);
    if (hit.pdf > 0.0f) hit.pdf *= probability_of(receiver, local, bounced);
    return hit;
}

}  // namespace lumel
