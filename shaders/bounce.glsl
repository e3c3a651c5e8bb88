// What encodings of light from above leave out.

// Self-bounce: where the normal map's n leans over, it sees the surface itself, which sends out albedo I(n_v).
// Add it to I = E/pi. Based on: Roughton 2024, "Hemispherical Lighting Insights".
vec3 lumel_self_bounce(vec3 irradiance_at_vertex_normal, vec3 albedo, vec3 n_v, vec3 n) {
    return albedo * irradiance_at_vertex_normal * (0.5 - 0.5 * dot(n_v, n));
}
