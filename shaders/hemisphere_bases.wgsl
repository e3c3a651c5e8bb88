// Made by scripts/shaders from hemisphere_bases.glsl: edit that.
// Encodings that are linear in a basis over the hemisphere, decoded with the normal n of the tangent frame
// (lumel_to_tangent). Arguments are the textures of the encoding, in the order of its file's channels. May be negative.

// `hlsh`. Based on: Roughton 2024, "Hemispherical Lighting Insights".
fn lumel_hlsh(irradiance: vec3f, a: vec3f, c_x: vec3f, c_y: vec3f, n: vec3f) -> vec3f {
    return irradiance * n.z + a * (1.0 - n.z) + c_x * n.x + c_y * n.y;
}

// `h4` and `h6`. Based on: Habel and Wimmer 2010, "Efficient Irradiance Normal Mapping".
fn lumel_h4(h0: vec3f, h1: vec3f, h2: vec3f, h3: vec3f, n: vec3f) -> vec3f {
    return h0 * 0.39894228040 + (h2 * (2.0 * n.z - 1.0) - h1 * n.y - h3 * n.x) * 0.69098829894;
}

fn lumel_h6(h0: vec3f, h1: vec3f, h2: vec3f, h3: vec3f, h4: vec3f, h5: vec3f, n: vec3f) -> vec3f {
    return lumel_h4(h0, h1, h2, h3, n) +
           (h4 * (n.x * n.y) + h5 * (0.5 * (n.x * n.x - n.y * n.y))) * 1.54509680809;
}

// `rnm`. Based on: McTaggart 2004, "Half-Life 2 / Valve Source Shading"; Green 2007, "Efficient Self-Shadowed Radiosity
// Normal Mapping" (weights).
fn lumel_rnm(i0: vec3f, i1: vec3f, i2: vec3f, n: vec3f) -> vec3f {
    var up: f32 = 0.57735026919 * n.z;
    var w0: f32 = max(0.81649658093 * n.x + up, 0.0);
    var w1: f32 = max(-0.40824829046 * n.x + 0.70710678119 * n.y + up, 0.0);
    var w2: f32 = max(-0.40824829046 * n.x - 0.70710678119 * n.y + up, 0.0);
    var sum: f32 = w0 * w0 + w1 * w1 + w2 * w2;
    return (i0 * (w0 * w0) + i1 * (w1 * w1) + i2 * (w2 * w2)) / sum;
}

// `ambient-cube`, the upper five faces. Based on: Mitchell, McTaggart and Green 2006, "Shading in Valve's Source Engine".
fn lumel_ambient_cube(x_positive: vec3f, x_negative: vec3f, y_positive: vec3f, y_negative: vec3f, z_positive: vec3f, n: vec3f) -> vec3f {
    var x_side: vec3f = x_positive;
    var y_side: vec3f = y_positive;
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
fn lumel_gaussian_irradiance(cosine: f32) -> f32 {
    var x: f32 = 0.36 * cosine;
    var rim: f32 = 0.49932862 / 1.44;
    var bent: f32 = max(cosine, 0.0);
    if (abs(x) <= rim) {
        bent = (x + rim) * (x + rim) / 0.49932862;
    }
    return 0.75067092526 * bent + 0.00415958142;
}

// `sg5`. Based on: Neubelt and Pettineo 2015, "Advanced Lighting R&D at Ready At Dawn Studios".
fn lumel_sg5(g0: vec3f, g1: vec3f, g2: vec3f, g3: vec3f, g4: vec3f, n: vec3f) -> vec3f {
    var side: f32 = 0.86602540378;
    var up: f32 = 0.5 * n.z;
    return g0 * lumel_gaussian_irradiance(n.z) + g1 * lumel_gaussian_irradiance(side * n.x + up) +
           g2 * lumel_gaussian_irradiance(side * n.y + up) + g3 * lumel_gaussian_irradiance(up - side * n.x) +
           g4 * lumel_gaussian_irradiance(up - side * n.y);
}
