// Made by scripts/shaders from specular.glsl: edit that.
// A highlight from L1: the linear band as one directional light, made as rough as the band is wide. World frame.
// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (direction, strength, smoothness); Walter et
// al. 2007, "Microfacet Models for Refraction" (GGX); Heitz 2014, "Understanding the Masking-Shadowing Function in
// Microfacet-Based BRDFs" (height-correlated Smith). Roughness by adding variances.

struct LumelHighlight {
    direction: vec3f,  // towards the light
    irradiance: vec3f, // E on a plane that faces it (not E/pi)
    spread: f32,    // r: 0 light from all around, 1 from one direction
}

// l1n after lumel_decode_ratio.
fn lumel_l1_highlight(l0: vec3f, l1n_r: vec3f, l1n_g: vec3f, l1n_b: vec3f) -> LumelHighlight {
    var luminance: vec3f = vec3f(0.2126, 0.7152, 0.0722);
    var v: vec3f = l1n_r * (luminance.x * l0.x) + l1n_g * (luminance.y * l0.y) + l1n_b * (luminance.z * l0.z);
    var size: f32 = length(v);
    var light: LumelHighlight;
    light.direction = vec3f(0.0, 0.0, 1.0);
    light.irradiance = vec3f(0.0, 0.0, 0.0);
    light.spread = 0.0;
    if (size > 0.0) {
        var d: vec3f = v / size;
        light.direction = d;
        // 4 pi R1.d: keeps the first moment.
        light.irradiance =
            max(l0 * vec3f(dot(l1n_r, d), dot(l1n_g, d), dot(l1n_b, d)), vec3f(0.0, 0.0, 0.0)) * 12.5663706144;
        light.spread = min(size / dot(luminance, l0), 1.0);
    }
    return light;
}

// GGX alpha for light of spread r: alpha'^2 = alpha^2 + 1/k, k = r (3 - r^2)/(1 - r^2) that of a von Mises-Fisher lobe.
fn lumel_widened_alpha(alpha: f32, r: f32) -> f32 {
    if (r <= 0.0) {
        return 1.0;
    }
    var s: f32 = min(r, 1.0);
    return min(sqrt(alpha * alpha + (1.0 - s * s) / (s * (3.0 - s * s))), 1.0);
}

// The talk's own: smoothness times sqrt(r).
fn lumel_adjusted_smoothness(smoothness: f32, r: f32) -> f32 {
    return smoothness * sqrt(clamp(r, 0.0, 1.0));
}

// How much of the highlight to add: 0 where the material's switch is off (0) or its smoothness is above `last`, where
// reflections take over; all of it below `first`. first < last.
fn lumel_highlight_fade(material_switch: f32, smoothness: f32, first: f32, last: f32) -> f32 {
    return material_switch * (1.0 - smoothstep(first, last, smoothness));
}

// Radiance towards v of GGX with reflectance f0, n.l included; alpha from lumel_widened_alpha.
fn lumel_highlight(light: LumelHighlight, f0: vec3f, alpha: f32, n: vec3f, v: vec3f) -> vec3f {
    var l: vec3f = light.direction;
    var n_l: f32 = dot(n, l);
    var n_v: f32 = max(dot(n, v), 0.0001);
    var sum: vec3f = l + v;
    var size: f32 = length(sum);
    if (n_l <= 0.0 || size <= 0.0) {
        return vec3f(0.0, 0.0, 0.0);
    }
    var h: vec3f = sum / size;
    var n_h: f32 = clamp(dot(n, h), 0.0, 1.0);
    var a2: f32 = max(alpha * alpha, 0.000001);
    var t: f32 = n_h * n_h * (a2 - 1.0) + 1.0;
    var smith: f32 = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    var brdf: f32 = a2 / (3.14159265359 * t * t) * 0.5 / smith;
    var grazing: f32 = pow(1.0 - clamp(dot(v, h), 0.0, 1.0), 5.0);
    var fresnel: vec3f = f0 + (vec3f(1.0, 1.0, 1.0) - f0) * grazing;
    return light.irradiance * fresnel * (brdf * n_l);
}
