// L1 textures: `L0` and, per channel, L1n = L1/L0 (after lumel_decode_ratio), and `l1-mono`. L1n, n and n_v are of the
// world frame. I = E/pi: multiply by albedo, not by 1/pi. Filter L0 and L1n, then evaluate. Needs: hhd.
// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (storage, linear); Hazel 2017, "Converting SH
// Radiance to Irradiance" (non-linear).

// `l1-linear`, `l1-linear-fit`. May be negative.
vec3 lumel_l1_linear(vec3 l0, vec3 l1n_r, vec3 l1n_g, vec3 l1n_b, vec3 n) {
    return l0 * (vec3(dot(l1n_r, n), dot(l1n_g, n), dot(l1n_b, n)) * 2.0 + vec3(1.0, 1.0, 1.0));
}

// One channel of Hazel's evaluation.
float lumel_hazel(float l0, vec3 l1n, vec3 n) {
    float size = length(l1n);
    if (size <= 0.0) {
        return l0;
    }
    float r = min(size, 1.0);
    float q = clamp(0.5 + 0.5 * dot(l1n, n) / size, 0.0, 1.0);
    float p = 1.0 + 2.0 * r;
    float a = (1.0 - r) / (1.0 + r);
    return l0 * (a + (1.0 - a) * (p + 1.0) * pow(q, p));
}

// `l1-hazel`, `l1-hazel-fit`.
vec3 lumel_l1_hazel(vec3 l0, vec3 l1n_r, vec3 l1n_g, vec3 l1n_b, vec3 n) {
    return vec3(lumel_hazel(l0.x, l1n_r, n), lumel_hazel(l0.y, l1n_g, n), lumel_hazel(l0.z, l1n_b, n));
}

// One channel as hemisphere, directional light and ring.
float lumel_l1_hhd_channel(float l0, vec3 l1n, vec3 n_v, vec3 n) {
    return lumel_evaluate_hhd(lumel_solve_hhd_ring(4.0 * l0, l1n * (4.0 * l0), n_v), n_v, n);
}

// `l1-hhd`: n_v is the vertex normal, n that of the normal map.
vec3 lumel_l1_hhd(vec3 l0, vec3 l1n_r, vec3 l1n_g, vec3 l1n_b, vec3 n_v, vec3 n) {
    return vec3(lumel_l1_hhd_channel(l0.x, l1n_r, n_v, n), lumel_l1_hhd_channel(l0.y, l1n_g, n_v, n),
                lumel_l1_hhd_channel(l0.z, l1n_b, n_v, n));
}

// `l1-mono`: colour from I, direction from the luminance.
vec3 lumel_l1_mono(vec3 irradiance, vec3 l1n, vec3 n_v, vec3 n) {
    float along = dot(l1n, n_v);
    float z = max(along, 0.05);
    vec3 b = (l1n + n_v * (z - along)) / z;
    return irradiance * lumel_evaluate_hhd(lumel_solve_hhd_ring(1.0 / z, b, n_v), n_v, n);
}
