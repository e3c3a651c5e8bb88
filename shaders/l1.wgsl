// Made by scripts/shaders from l1.glsl: edit that.
// L1 textures: `L0` and, per channel, L1n = L1/L0 (after lumel_decode_ratio), and `l1-mono`. L1n, n and n_v are of the
// world frame. I = E/pi: multiply by albedo, not by 1/pi. Filter L0 and L1n, then evaluate. Needs: hhd.
// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (storage, linear); Hazel 2017, "Converting SH
// Radiance to Irradiance" (non-linear).

// `l1-linear`, `l1-linear-fit`. May be negative.
fn lumel_l1_linear(l0: vec3f, l1n_r: vec3f, l1n_g: vec3f, l1n_b: vec3f, n: vec3f) -> vec3f {
    return l0 * (vec3f(dot(l1n_r, n), dot(l1n_g, n), dot(l1n_b, n)) * 2.0 + vec3f(1.0, 1.0, 1.0));
}

// One channel of Hazel's evaluation.
fn lumel_hazel(l0: f32, l1n: vec3f, n: vec3f) -> f32 {
    var size: f32 = length(l1n);
    if (size <= 0.0) {
        return l0;
    }
    var r: f32 = min(size, 1.0);
    var q: f32 = clamp(0.5 + 0.5 * dot(l1n, n) / size, 0.0, 1.0);
    var p: f32 = 1.0 + 2.0 * r;
    var a: f32 = (1.0 - r) / (1.0 + r);
    return l0 * (a + (1.0 - a) * (p + 1.0) * pow(q, p));
}

// `l1-hazel`, `l1-hazel-fit`.
fn lumel_l1_hazel(l0: vec3f, l1n_r: vec3f, l1n_g: vec3f, l1n_b: vec3f, n: vec3f) -> vec3f {
    return vec3f(lumel_hazel(l0.x, l1n_r, n), lumel_hazel(l0.y, l1n_g, n), lumel_hazel(l0.z, l1n_b, n));
}

// One channel as hemisphere, directional light and ring.
fn lumel_l1_hhd_channel(l0: f32, l1n: vec3f, n_v: vec3f, n: vec3f) -> f32 {
    return lumel_evaluate_hhd(lumel_solve_hhd_ring(4.0 * l0, l1n * (4.0 * l0), n_v), n_v, n);
}

// `l1-hhd`: n_v is the vertex normal, n that of the normal map.
fn lumel_l1_hhd(l0: vec3f, l1n_r: vec3f, l1n_g: vec3f, l1n_b: vec3f, n_v: vec3f, n: vec3f) -> vec3f {
    return vec3f(lumel_l1_hhd_channel(l0.x, l1n_r, n_v, n), lumel_l1_hhd_channel(l0.y, l1n_g, n_v, n),
                lumel_l1_hhd_channel(l0.z, l1n_b, n_v, n));
}

// `l1-mono`: colour from I, direction from the luminance.
fn lumel_l1_mono(irradiance: vec3f, l1n: vec3f, n_v: vec3f, n: vec3f) -> vec3f {
    var along: f32 = dot(l1n, n_v);
    var z: f32 = max(along, 0.05);
    var b: vec3f = (l1n + n_v * (z - along)) / z;
    return irradiance * lumel_evaluate_hhd(lumel_solve_hhd_ring(1.0 / z, b, n_v), n_v, n);
}
