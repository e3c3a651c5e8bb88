// IrradZ: I about the vertex normal, the share w of it that is ambient, the direction of the rest (`d`, two numbers);
// and plain AHD. n is of the tangent frame (lumel_to_tangent). I(+z) is `irradiance` whatever w and d are.
// Based on: Roughton 2024, "Hemispherical Lighting Insights". Needs: tangent_frame.

// The directional part for I_z = 1; d_z is kept off the horizon, where filtering may have taken it.
float lumel_irradz_lobe(vec2 d, vec3 n) {
    vec3 direction = lumel_from_hemi_octahedral(d);
    float z = max(direction.z, 0.05);
    return max(dot(n, vec3(direction.x, direction.y, z)), 0.0) / z;
}

// `irradz-ahd-rgb`: a weight for each channel.
vec3 lumel_irradz_ahd_rgb(vec3 irradiance, vec3 w, vec2 d, vec3 n) {
    float lobe = lumel_irradz_lobe(d, n);
    return irradiance * (w * (1.0 - lobe) + vec3(lobe, lobe, lobe));
}

// `irradz-hhd-rgb`.
vec3 lumel_irradz_hhd_rgb(vec3 irradiance, vec3 w, vec2 d, vec3 n) {
    float lobe = lumel_irradz_lobe(d, n);
    return irradiance * (w * (0.5 + 0.5 * n.z - lobe) + vec3(lobe, lobe, lobe));
}

// `irradz-ahd`.
vec3 lumel_irradz_ahd(vec3 irradiance, float w, vec2 d, vec3 n) {
    return lumel_irradz_ahd_rgb(irradiance, vec3(w, w, w), d, n);
}

// `irradz-hhd`, `irradz-hhd-closed`.
vec3 lumel_irradz_hhd(vec3 irradiance, float w, vec2 d, vec3 n) {
    return lumel_irradz_hhd_rgb(irradiance, vec3(w, w, w), d, n);
}

// `ahd`: ambient and directional colour.
vec3 lumel_ahd(vec3 ambient, vec3 directional, vec2 d, vec3 n) {
    return ambient + directional * max(dot(n, lumel_from_hemi_octahedral(d)), 0.0);
}
