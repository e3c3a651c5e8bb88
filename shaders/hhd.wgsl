// Made by scripts/shaders from hhd.glsl: edit that.
// HHD: hemisphere light about n_v, a directional light and a ring of light on the horizon, of one channel:
// I(n) = C_a (1 + n_v.n)/2 + C_d max(n.d, 0) + (e/pi) sqrt(1 - (n_v.n)^2). I = E/pi; any one frame for all vectors.
// Based on: Roughton 2024, "Hemispherical Lighting Insights"; docs/stages/encode.md, "HHD with the ring".

struct LumelHhd {
    iz: f32,          // I(n_v)
    ambient: f32,     // C_a
    directional: f32, // C_d
    direction: vec3f,    // d
    ring: f32,        // e
}

// From the moments b_c = (1/pi) integral of L and b = (1/pi) integral of L w: 4 L0 and 4 L0 L1n of an L1 texel,
// 2/sqrt(pi) l0 and 2/sqrt(3 pi) (-l3, -l1, l2) of spherical harmonics. Without the ring.
fn lumel_solve_hhd(b_c: f32, b: vec3f, n_v: vec3f) -> LumelHhd {
    var hhd: LumelHhd;
    var along: f32 = dot(b, n_v);
    var side: vec3f = b - n_v * along;
    hhd.iz = max(along, 0.0);
    var q: f32 = b_c - 2.0 * along;
    var root: f32 = sqrt(q * q + 3.0 * dot(side, side));
    hhd.ambient = clamp((2.0 * b_c - along - root) / 3.0, 0.0, hhd.iz);
    var rest: vec3f = side + n_v * (hhd.iz - hhd.ambient);
    hhd.directional = length(rest);
    hhd.direction = n_v;
    hhd.ring = 0.0;
    if (hhd.directional > 0.000001 * b_c && hhd.directional > 0.0) {
        hhd.direction = rest / hhd.directional;
    }
    return hhd;
}

// The same with the ring, which keeps b_c of any light from above.
fn lumel_solve_hhd_ring(b_c: f32, b: vec3f, n_v: vec3f) -> LumelHhd {
    var hhd: LumelHhd = lumel_solve_hhd(b_c, b, n_v);
    var along: f32 = dot(b, n_v);
    if (along >= 0.0) {
        hhd.ring = max(0.0, b_c - 2.0 * along - length(b - n_v * along));
    }
    return hhd;
}

fn lumel_evaluate_hhd(hhd: LumelHhd, n_v: vec3f, n: vec3f) -> f32 {
    var z: f32 = dot(n_v, n);
    return hhd.ambient * 0.5 * (1.0 + z) + hhd.directional * max(dot(n, hhd.direction), 0.0) +
           hhd.ring * 0.31830988618 * sqrt(max(0.0, 1.0 - z * z));
}

// The vertex/pixel split: a vertex shader solves (without the ring) and hands on iz and C_d d of each channel, both
// of which interpolate; this is what is left for the pixel.
fn lumel_evaluate_hhd_split(iz: f32, directional: vec3f, n_v: vec3f, n: vec3f) -> f32 {
    var ambient: f32 = iz - max(dot(directional, n_v), 0.0);
    return ambient * 0.5 * (1.0 + dot(n_v, n)) + max(dot(directional, n), 0.0);
}
