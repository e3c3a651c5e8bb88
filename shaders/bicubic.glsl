// Bicubic (B-spline) lookups with four bilinear taps: smooth lightmaps at few texels. The layout must leave room for
// them (docs/formats.md, `lookups`: "bicubic").
// Based on: Sigg and Hadwiger 2005, "Fast Third-Order Texture Filtering", GPU Gems 2, chapter 20.

// Sample at (x0, y0), (x1, y0), (x0, y1), (x1, y1), with UV in [0, 1], a filter that is bilinear; the value is
// the sum of the four times w00, w10, w01, w11.
struct LumelTaps {
    float x0;
    float x1;
    float y0;
    float y1;
    float w00;
    float w10;
    float w01;
    float w11;
};

// Along one axis, for a place x in texels: the two taps in texels and the weight of the second.
vec3 lumel_cubic_taps(float x) {
    float first = floor(x - 0.5);
    float f = x - 0.5 - first;
    float g = 1.0 - f;
    float f2 = f * f;
    float f3 = f2 * f;
    float b0 = g * g * g / 6.0;
    float b1 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
    float b3 = f3 / 6.0;
    float b2 = 1.0 - b0 - b1 - b3;
    return vec3(first - 0.5 + b1 / (b0 + b1), first + 1.5 + b3 / (b2 + b3), b2 + b3);
}

// uv in [0, 1]; size of the texture's level in texels.
LumelTaps lumel_bicubic_taps(vec2 uv, vec2 size) {
    vec3 x = lumel_cubic_taps(uv.x * size.x);
    vec3 y = lumel_cubic_taps(uv.y * size.y);
    LumelTaps taps;
    taps.x0 = x.x / size.x;
    taps.x1 = x.y / size.x;
    taps.y0 = y.x / size.y;
    taps.y1 = y.y / size.y;
    taps.w00 = (1.0 - x.z) * (1.0 - y.z);
    taps.w10 = x.z * (1.0 - y.z);
    taps.w01 = (1.0 - x.z) * y.z;
    taps.w11 = x.z * y.z;
    return taps;
}
