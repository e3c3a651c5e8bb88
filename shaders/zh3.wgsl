// Made by scripts/shaders from zh3.glsl: edit that.
// ZH3: L1 and a zonal band 2 about the luminance's direction. World frame. Needs: l1.
// Based on: Roughton et al. 2024, "ZH3: Quadratic Zonal Harmonics".

// The direction of the luminance's linear band; +z where it has none.
fn lumel_zh3_axis(l0: vec3f, l1n_r: vec3f, l1n_g: vec3f, l1n_b: vec3f) -> vec3f {
    var v: vec3f = l1n_r * (0.2126 * l0.x) + l1n_g * (0.7152 * l0.y) + l1n_b * (0.0722 * l0.z);
    var size: f32 = length(v);
    if (size <= 0.0) {
        return vec3f(0.0, 0.0, 1.0);
    }
    return v / size;
}

// `zh3`: z2 is the texture `Z2` after lumel_decode_ratio.
fn lumel_zh3(l0: vec3f, l1n_r: vec3f, l1n_g: vec3f, l1n_b: vec3f, z2: vec3f, n: vec3f) -> vec3f {
    var c: f32 = dot(lumel_zh3_axis(l0, l1n_r, l1n_g, l1n_b), n);
    return lumel_l1_linear(l0, l1n_r, l1n_g, l1n_b, n) + l0 * z2 * (0.625 * (3.0 * c * c - 1.0));
}

// `zh3-hallucinated`: band 2 guessed from the linear one.
fn lumel_zh3_hallucinated(l0: vec3f, l1n_r: vec3f, l1n_g: vec3f, l1n_b: vec3f, n: vec3f) -> vec3f {
    var axis: vec3f = lumel_zh3_axis(l0, l1n_r, l1n_g, l1n_b);
    var c: f32 = dot(axis, n);
    var ratio: vec3f = vec3f(abs(dot(l1n_r, axis)), abs(dot(l1n_g, axis)), abs(dot(l1n_b, axis))) * 1.73205080757;
    var z2: vec3f = ratio * (ratio * 0.6 + vec3f(0.08, 0.08, 0.08));
    return lumel_l1_linear(l0, l1n_r, l1n_g, l1n_b, n) + l0 * z2 * (0.27950849719 * (3.0 * c * c - 1.0));
}
