// From what a texture holds to the numbers of an encoding (docs/formats.md, "Encoded"). Light is the sample times the
// page's `scale` (1 where halves hold it), units are the sample itself.

// Numbers of [-1, 1], kept as 0.5 + 0.5 x.
vec3 lumel_decode_ratio(vec3 x) {
    return x * 2.0 - vec3(1.0, 1.0, 1.0);
}

// The codes of PNG files: four bytes over 255, times the page's scale. Sample RGBM and RGBD unfiltered where their
// alpha differs much; never filter LogLuv.
vec3 lumel_decode_rgbm(vec4 x, float scale) {
    return vec3(x.x, x.y, x.z) * (x.w * scale);
}

vec3 lumel_decode_rgbd(vec4 x, float scale) {
    return vec3(pow(x.x, 2.2), pow(x.y, 2.2), pow(x.z, 2.2)) * (scale / max(x.w, 1.0 / 255.0));
}

// Based on: Larson 1998, "LogLuv Encoding for Full-Gamut, High-Dynamic Range Images" (the idea; 16 bits of log2 Y).
vec3 lumel_decode_logluv(vec4 x, float scale) {
    float y = exp2((255.0 * x.z + x.w - 127.0) * 0.5);
    float s = y / max(x.y, 1.0 / 255.0);
    vec3 v = vec3(x.x * s, y, s);
    vec3 rgb = vec3(dot(vec3(6.0013654, -1.3320037, 0.3007831), v), dot(vec3(-2.7007574, 3.1029433, -1.0881942), v),
                    dot(vec3(-1.7995519, -5.7720911, 5.6268162), v));
    return max(rgb, vec3(0.0, 0.0, 0.0)) * scale;
}
