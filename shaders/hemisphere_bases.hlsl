// Made by scripts/shaders from hemisphere_bases.glsl: edit that.
// Encodings that are linear in a basis over the hemisphere, decoded with the normal n of the tangent frame
// (lumel_to_tangent). Arguments are the textures of the encoding, in the order of its file's channels. May be negative.

// `hlsh`. Based on: Roughton 2024, "Hemispherical Lighting Insights".
float3 lumel_hlsh(float3 irradiance, float3 a, float3 c_x, float3 c_y, float3 n) {
    return irradiance * n.z + a * (1.0 - n.z) + c_x * n.x + c_y * n.y;
}

// `h4` and `h6`. Based on: Habel and Wimmer 2010, "Efficient Irradiance Normal Mapping".
float3 lumel_h4(float3 h0, float3 h1, float3 h2, float3 h3, float3 n) {
    return h0 * 0.39894228040 + (h2 * (2.0 * n.z - 1.0) - h1 * n.y - h3 * n.x) * 0.69098829894;
}

float3 lumel_h6(float3 h0, float3 h1, float3 h2, float3 h3, float3 h4, float3 h5, float3 n) {
    return lumel_h4(h0, h1, h2, h3, n) +
           (h4 * (n.x * n.y) + h5 * (0.5 * (n.x * n.x - n.y * n.y))) * 1.54509680809;
}

// `rnm`. Based on: McTaggart 2004, "Half-Life 2 / Valve Source Shading"; Green 2007, "Efficient Self-Shadowed Radiosity
// Normal Mapping" (weights).
float3 lumel_rnm(float3 i0, float3 i1, float3 i2, float3 n) {
    float up = 0.57735026919 * n.z;
    float w0 = max(0.81649658093 * n.x + up, 0.0);
    float w1 = max(-0.40824829046 * n.x + 0.70710678119 * n.y + up, 0.0);
    float w2 = max(-0.40824829046 * n.x - 0.70710678119 * n.y + up, 0.0);
    float sum = w0 * w0 + w1 * w1 + w2 * w2;
    return (i0 * (w0 * w0) + i1 * (w1 * w1) + i2 * (w2 * w2)) / sum;
}

// `ambient-cube`, the upper five faces. Based on: Mitchell, McTaggart and Green 2006, "Shading in Valve's Source Engine".
float3 lumel_ambient_cube(float3 x_positive, float3 x_negative, float3 y_positive, float3 y_negative, float3 z_positive, float3 n) {
    float3 x_side = x_positive;
    float3 y_side = y_positive;
    if (n.x < 0.0) {
        x_side = x_negative;
    }
    if (n.y < 0.0) {
        y_side = y_negative;
    }
    return x_side * (n.x * n.x) + y_side * (n.y * n.y) + z_positive * (n.z * n.z);
}

// Irradiance of a Gaussian exp(4 (cos - 1)) over its value at the centre of a delta.
// Based on: Hill 2016, "SG irradiance" (a smoothed clamped cosine).
float lumel_gaussian_irradiance(float cosine) {
    float x = 0.36 * cosine;
    float rim = 0.49932862 / 1.44;
    float bent = max(cosine, 0.0);
    if (abs(x) <= rim) {
        bent = (x + rim) * (x + rim) / 0.49932862;
    }
    return 0.75067092526 * bent + 0.00415958142;
}

// `sg5`. Based on: Neubelt and Pettineo 2015, "Advanced Lighting R&D at Ready At Dawn Studios".
float3 lumel_sg5(float3 g0, float3 g1, float3 g2, float3 g3, float3 g4, float3 n) {
    float side = 0.86602540378;
    float up = 0.5 * n.z;
    return g0 * lumel_gaussian_irradiance(n.z) + g1 * lumel_gaussian_irradiance(side * n.x + up) +
           g2 * lumel_gaussian_irradiance(side * n.y + up) + g3 * lumel_gaussian_irradiance(up - side * n.x) +
           g4 * lumel_gaussian_irradiance(up - side * n.y);
}
