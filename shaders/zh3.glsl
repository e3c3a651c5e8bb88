// ZH3: L1 and a zonal band 2 about the luminance's direction. World frame. Needs: l1.
// Based on: Roughton et al. 2024, "ZH3: Quadratic Zonal Harmonics".

// The direction of the luminance's linear band; +z where it has none.
vec3 lumel_zh3_axis(vec3 l0, vec3 l1n_r, vec3 l1n_g, vec3 l1n_b) {
    vec3 v = l1n_r * (0.2126 * l0.x) + l1n_g * (0.7152 * l0.y) + l1n_b * (0.0722 * l0.z);
    float size = length(v);
    if (size <= 0.0) {
        return vec3(0.0, 0.0, 1.0);
    }
    return v / size;
}

// `zh3`: z2 is the texture `Z2` after lumel_decode_ratio.
vec3 lumel_zh3(vec3 l0, vec3 l1n_r, vec3 l1n_g, vec3 l1n_b, vec3 z2, vec3 n) {
    float c = dot(lumel_zh3_axis(l0, l1n_r, l1n_g, l1n_b), n);
    return lumel_l1_linear(l0, l1n_r, l1n_g, l1n_b, n) + l0 * z2 * (0.625 * (3.0 * c * c - 1.0));
}

// `zh3-hallucinated`: band 2 guessed from the linear one.
vec3 lumel_zh3_hallucinated(vec3 l0, vec3 l1n_r, vec3 l1n_g, vec3 l1n_b, vec3 n) {
    vec3 axis = lumel_zh3_axis(l0, l1n_r, l1n_g, l1n_b);
    float c = dot(axis, n);
    vec3 ratio = vec3(abs(dot(l1n_r, axis)), abs(dot(l1n_g, axis)), abs(dot(l1n_b, axis))) * 1.73205080757;
    vec3 z2 = ratio * (ratio * 0.6 + vec3(0.08, 0.08, 0.08));
    return lumel_l1_linear(l0, l1n_r, l1n_g, l1n_b, n) + l0 * z2 * (0.27950849719 * (3.0 * c * c - 1.0));
}
