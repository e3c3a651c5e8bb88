// HHD: hemisphere light about n_v, a directional light and a ring of light on the horizon, of one channel:
// I(n) = C_a (1 + n_v.n)/2 + C_d max(n.d, 0) + (e/pi) sqrt(1 - (n_v.n)^2). I = E/pi; any one frame for all vectors.
// Based on: Roughton 2024, "Hemispherical Lighting Insights"; docs/stages/encode.md, "HHD with the ring".

struct LumelHhd {
    float iz;          // I(n_v)
    float ambient;     // C_a
    float directional; // C_d
    vec3 direction;    // d
    float ring;        // e
};

// From the moments b_c = (1/pi) integral of L and b = (1/pi) integral of L w: 4 L0 and 4 L0 L1n of an L1 texel,
// 2/sqrt(pi) l0 and 2/sqrt(3 pi) (-l3, -l1, l2) of spherical harmonics. Without the ring.
LumelHhd lumel_solve_hhd(float b_c, vec3 b, vec3 n_v) {
    LumelHhd hhd;
    float along = dot(b, n_v);
    vec3 side = b - n_v * along;
    hhd.iz = max(along, 0.0);
    float q = b_c - 2.0 * along;
    float root = sqrt(q * q + 3.0 * dot(side, side));
    hhd.ambient = clamp((2.0 * b_c - along - root) / 3.0, 0.0, hhd.iz);
    vec3 rest = side + n_v * (hhd.iz - hhd.ambient);
    hhd.directional = length(rest);
    hhd.direction = n_v;
    hhd.ring = 0.0;
    if (hhd.directional > 0.000001 * b_c && hhd.directional > 0.0) {
        hhd.direction = rest / hhd.directional;
    }
    return hhd;
}

// The same with the ring, which keeps b_c of any light from above.
LumelHhd lumel_solve_hhd_ring(float b_c, vec3 b, vec3 n_v) {
    LumelHhd hhd = lumel_solve_hhd(b_c, b, n_v);
    float along = dot(b, n_v);
    if (along >= 0.0) {
        hhd.ring = max(0.0, b_c - 2.0 * along - length(b - n_v * along));
    }
    return hhd;
}

float lumel_evaluate_hhd(LumelHhd hhd, vec3 n_v, vec3 n) {
    float z = dot(n_v, n);
    return hhd.ambient * 0.5 * (1.0 + z) + hhd.directional * max(dot(n, hhd.direction), 0.0) +
           hhd.ring * 0.31830988618 * sqrt(max(0.0, 1.0 - z * z));
}

// The vertex/pixel split: a vertex shader solves (without the ring) and hands on iz and C_d d of each channel, both
// of which interpolate; this is what is left for the pixel.
float lumel_evaluate_hhd_split(float iz, vec3 directional, vec3 n_v, vec3 n) {
    float ambient = iz - max(dot(directional, n_v), 0.0);
    return ambient * 0.5 * (1.0 + dot(n_v, n)) + max(dot(directional, n), 0.0);
}
