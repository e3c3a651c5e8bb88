// Made by scripts/shaders from bicubic.glsl: edit that.
// Bicubic (B-spline) lookups with four bilinear taps: smooth lightmaps at few texels. The layout must leave room for
// them (docs/formats.md, `lookups`: "bicubic").
// Based on: Sigg and Hadwiger 2005, "Fast Third-Order Texture Filtering", GPU Gems 2, chapter 20.

// Sample at (x0, y0), (x1, y0), (x0, y1), (x1, y1), with UV in [0, 1], a filter that is bilinear; the value is
// the sum of the four times w00, w10, w01, w11.
struct LumelTaps {
    x0: f32,
    x1: f32,
    y0: f32,
    y1: f32,
    w00: f32,
    w10: f32,
    w01: f32,
    w11: f32,
}

// Along one axis, for a place x in texels: the two taps in texels and the weight of the second.
fn lumel_cubic_taps(x: f32) -> vec3f {
    var first: f32 = floor(x - 0.5);
    var f: f32 = x - 0.5 - first;
    var g: f32 = 1.0 - f;
    var f2: f32 = f * f;
    var f3: f32 = f2 * f;
    var b0: f32 = g * g * g / 6.0;
    var b1: f32 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
    var b3: f32 = f3 / 6.0;
    var b2: f32 = 1.0 - b0 - b1 - b3;
    return vec3f(first - 0.5 + b1 / (b0 + b1), first + 1.5 + b3 / (b2 + b3), b2 + b3);
}

// uv in [0, 1]; size of the texture's level in texels.
fn lumel_bicubic_taps(uv: vec2f, size: vec2f) -> LumelTaps {
    var x: vec3f = lumel_cubic_taps(uv.x * size.x);
    var y: vec3f = lumel_cubic_taps(uv.y * size.y);
    var taps: LumelTaps;
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
