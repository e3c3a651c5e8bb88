// Made by scripts/shaders from irradz.glsl: edit that.
// IrradZ: I about the vertex normal, the share w of it that is ambient, the direction of the rest (`d`, two numbers);
// and plain AHD. n is of the tangent frame (lumel_to_tangent). I(+z) is `irradiance` whatever w and d are.
// Based on: Roughton 2024, "Hemispherical Lighting Insights". Needs: tangent_frame.

// The directional part for I_z = 1; d_z is kept off the horizon, where filtering may have taken it.
fn lumel_irradz_lobe(d: vec2f, n: vec3f) -> f32 {
    var direction: vec3f = lumel_from_hemi_octahedral(d);
    var z: f32 = max(direction.z, 0.05);
    return max(dot(n, vec3f(direction.x, direction.y, z)), 0.0) / z;
}

// `irradz-ahd-rgb`: a weight for each channel.
fn lumel_irradz_ahd_rgb(irradiance: vec3f, w: vec3f, d: vec2f, n: vec3f) -> vec3f {
    var lobe: f32 = lumel_irradz_lobe(d, n);
    return irradiance * (w * (1.0 - lobe) + vec3f(lobe, lobe, lobe));
}

// `irradz-hhd-rgb`.
fn lumel_irradz_hhd_rgb(irradiance: vec3f, w: vec3f, d: vec2f, n: vec3f) -> vec3f {
    var lobe: f32 = lumel_irradz_lobe(d, n);
    return irradiance * (w * (0.5 + 0.5 * n.z - lobe) + vec3f(lobe, lobe, lobe));
}

// `irradz-ahd`.
fn lumel_irradz_ahd(irradiance: vec3f, w: f32, d: vec2f, n: vec3f) -> vec3f {
    return lumel_irradz_ahd_rgb(irradiance, vec3f(w, w, w), d, n);
}

// `irradz-hhd`, `irradz-hhd-closed`.
fn lumel_irradz_hhd(irradiance: vec3f, w: f32, d: vec2f, n: vec3f) -> vec3f {
    return lumel_irradz_hhd_rgb(irradiance, vec3f(w, w, w), d, n);
}

// `ahd`: ambient and directional colour.
fn lumel_ahd(ambient: vec3f, directional: vec3f, d: vec2f, n: vec3f) -> vec3f {
    return ambient + directional * max(dot(n, lumel_from_hemi_octahedral(d)), 0.0);
}
