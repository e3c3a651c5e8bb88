// Made by scripts/shaders from bounce.glsl: edit that.
// What encodings of light from above leave out.

// Self-bounce: where the normal map's n leans over, it sees the surface itself, which sends out albedo I(n_v).
// Add it to I = E/pi. Based on: Roughton 2024, "Hemispherical Lighting Insights".
float3 lumel_self_bounce(float3 irradiance_at_vertex_normal, float3 albedo, float3 n_v, float3 n) {
    return albedo * irradiance_at_vertex_normal * (0.5 - 0.5 * dot(n_v, n));
}
