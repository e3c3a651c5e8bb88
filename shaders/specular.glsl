// A highlight from L1: the linear band as one directional light, made as rough as the band is wide. World frame.
// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (direction, strength, smoothness); Walter et
// al. 2007, "Microfacet Models for Refraction" (GGX); Heitz 2014, "Understanding the Masking-Shadowing Function in
// Microfacet-Based BRDFs" (height-correlated Smith). Roughness by adding variances.

struct LumelHighlight {
    vec3 direction;  // towards the light
    vec3 irradiance; // E on a plane that faces it (not E/pi)
    float spread;    // r: 0 light from all around, 1 from one direction
};

// l1n after lumel_decode_ratio.
LumelHighlight lumel_l1_highlight(vec3 l0, vec3 l1n_r, vec3 l1n_g, vec3 l1n_b) {
    vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    vec3 v = l1n_r * (luminance.x * l0.x) + l1n_g * (luminance.y * l0.y) + l1n_b * (luminance.z * l0.z);
    float size = length(v);
    LumelHighlight light;
    light.direction = vec3(0.0, 0.0, 1.0);
    light.irradiance = vec3(0.0, 0.0, 0.0);
    light.spread = 0.0;
    if (size > 0.0) {
        vec3 d = v / size;
        light.direction = d;
        // 4 pi R1.d: keeps the first moment.
        light.irradiance =
            max(l0 * vec3(dot(l1n_r, d), dot(l1n_g, d), dot(l1n_b, d)), vec3(0.0, 0.0, 0.0)) * 12.5663706144;
        light.spread = min(size / dot(luminance, l0), 1.0);
    }
    return light;
}

// GGX alpha for light of spread r: alpha'^2 = alpha^2 + 1/k, k = r (3 - r^2)/(1 - r^2) that of a von Mises-Fisher lobe.
float lumel_widened_alpha(float alpha, float r) {
    if (r <= 0.0) {
        return 1.0;
    }
    float s = min(r, 1.0);
    return min(sqrt(alpha * alpha + (1.0 - s * s) / (s * (3.0 - s * s))), 1.0);
}

// The talk's own: smoothness times sqrt(r).
float lumel_adjusted_smoothness(float smoothness, float r) {
    return smoothness * sqrt(clamp(r, 0.0, 1.0));
}

// How much of the highlight to add: 0 where the material's switch is off (0) or its smoothness is above `last`, where
// reflections take over; all of it below `first`. first < last.
float lumel_highlight_fade(float material_switch, float smoothness, float first, float last) {
    return material_switch * (1.0 - smoothstep(first, last, smoothness));
}

// Radiance towards v of GGX with reflectance f0, n.l included; alpha from lumel_widened_alpha.
vec3 lumel_highlight(LumelHighlight light, vec3 f0, float alpha, vec3 n, vec3 v) {
    vec3 l = light.direction;
    float n_l = dot(n, l);
    float n_v = max(dot(n, v), 0.0001);
    vec3 sum = l + v;
    float size = length(sum);
    if (n_l <= 0.0 || size <= 0.0) {
        return vec3(0.0, 0.0, 0.0);
    }
    vec3 h = sum / size;
    float n_h = clamp(dot(n, h), 0.0, 1.0);
    float a2 = max(alpha * alpha, 0.000001);
    float t = n_h * n_h * (a2 - 1.0) + 1.0;
    float smith = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    float brdf = a2 / (3.14159265359 * t * t) * 0.5 / smith;
    float grazing = pow(1.0 - clamp(dot(v, h), 0.0, 1.0), 5.0);
    vec3 fresnel = f0 + (vec3(1.0, 1.0, 1.0) - f0) * grazing;
    return light.irradiance * fresnel * (brdf * n_l);
}
