// Made by scripts/shaders from irradz.glsl: edit that.
// IrradZ: I about the vertex normal, the share w of it that is ambient, the direction of the rest (`d`, two numbers);
// and plain AHD. n is of the tangent frame (lumel_to_tangent). I(+z) is `irradiance` whatever w and d are.
// Based on: Roughton 2024, "Hemispherical Lighting Insights". Needs: tangent_frame.

// The directional part for I_z = 1; d_z is kept off the horizon, where filtering may have taken it.
float lumel_irradz_lobe(float2 d, float3 n) {
    float3 direction = lumel_from_hemi_octahedral(d);
    float z = max(direction.z, 0.05);
    return max(dot(n, float3(direction.x, direction.y, z)), 0.0) / z;
}

// `irradz-ahd-rgb`: a weight for each channel.
float3 lumel_irradz_ahd_rgb(float3 irradiance, float3 w, float2 d, float3 n) {
    float lobe = lumel_irradz_lobe(d, n);
    return irradiance * (w * (1.0 - lobe) + float3(lobe, lobe, lobe));
}

// `irradz-hhd-rgb`.
float3 lumel_irradz_hhd_rgb(float3 irradiance, float3 w, float2 d, float3 n) {
    float lobe = lumel_irradz_lobe(d, n);
    return irradiance * (w * (0.5 + 0.5 * n.z - lobe) + float3(lobe, lobe, lobe));
}

// `irradz-ahd`.
float3 lumel_irradz_ahd(float3 irradiance, float w, float2 d, float3 n) {
    return lumel_irradz_ahd_rgb(irradiance, float3(w, w, w), d, n);
}

// `irradz-hhd`, `irradz-hhd-closed`.
float3 lumel_irradz_hhd(float3 irradiance, float w, float2 d, float3 n) {
    return lumel_irradz_hhd_rgb(irradiance, float3(w, w, w), d, n);
}

// `ahd`: ambient and directional colour.
float3 lumel_ahd(float3 ambient, float3 directional, float2 d, float3 n) {
    return ambient + directional * max(dot(n, lumel_from_hemi_octahedral(d)), 0.0);
}
