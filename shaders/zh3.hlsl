// Made by scripts/shaders from zh3.glsl: edit that.
// ZH3: L1 and a zonal band 2 about the luminance's direction. World frame. Needs: l1.
// Based on: Roughton et al. 2024, "ZH3: Quadratic Zonal Harmonics".

// The direction of the luminance's linear band; +z where it has none.
float3 lumel_zh3_axis(float3 l0, float3 l1n_r, float3 l1n_g, float3 l1n_b) {
    float3 v = l1n_r * (0.2126 * l0.x) + l1n_g * (0.7152 * l0.y) + l1n_b * (0.0722 * l0.z);
    float size = length(v);
    if (size <= 0.0) {
        return float3(0.0, 0.0, 1.0);
    }
    return v / size;
}

// `zh3`: z2 is the texture `Z2` after lumel_decode_ratio.
float3 lumel_zh3(float3 l0, float3 l1n_r, float3 l1n_g, float3 l1n_b, float3 z2, float3 n) {
    float c = dot(lumel_zh3_axis(l0, l1n_r, l1n_g, l1n_b), n);
    return lumel_l1_linear(l0, l1n_r, l1n_g, l1n_b, n) + l0 * z2 * (0.625 * (3.0 * c * c - 1.0));
}

// `zh3-hallucinated`: band 2 guessed from the linear one.
float3 lumel_zh3_hallucinated(float3 l0, float3 l1n_r, float3 l1n_g, float3 l1n_b, float3 n) {
    float3 axis = lumel_zh3_axis(l0, l1n_r, l1n_g, l1n_b);
    float c = dot(axis, n);
    float3 ratio = float3(abs(dot(l1n_r, axis)), abs(dot(l1n_g, axis)), abs(dot(l1n_b, axis))) * 1.73205080757;
    float3 z2 = ratio * (ratio * 0.6 + float3(0.08, 0.08, 0.08));
    return lumel_l1_linear(l0, l1n_r, l1n_g, l1n_b, n) + l0 * z2 * (0.27950849719 * (3.0 * c * c - 1.0));
}
