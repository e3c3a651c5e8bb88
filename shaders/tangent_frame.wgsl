// Made by scripts/shaders from tangent_frame.glsl: edit that.
// The frame of encodings that are relative to the surface: a function of the world-space vertex normal alone, never
// glTF's TANGENT (docs/stages/encode.md, "Tangent frame").

// The world-space vector v in the frame of the unit normal n_v, which becomes +z.
fn lumel_to_tangent(n_v: vec3f, v: vec3f) -> vec3f {
    var pole: vec3f = vec3f(2.0, 3.0, 6.0) / 7.0;
    var axis: vec3f = vec3f(6.0, 2.0, -3.0) / 7.0;
    var along: f32 = 1.0 + dot(pole, n_v);
    var tangent: vec3f = axis;
    if (along > 0.0001) {
        tangent = tangent - (pole + n_v) * (dot(axis, n_v) / along);
    }
    tangent = normalize(tangent - n_v * dot(tangent, n_v));
    return vec3f(dot(tangent, v), dot(cross(n_v, tangent), v), dot(n_v, v));
}

// An upper-hemisphere direction of the tangent frame from two numbers in [0, 1].
// Based on: Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors" (hemi-oct).
fn lumel_from_hemi_octahedral(uv: vec2f) -> vec3f {
    var x: f32 = uv.x + uv.y - 1.0;
    var y: f32 = uv.x - uv.y;
    return normalize(vec3f(x, y, 1.0 - abs(x) - abs(y)));
}
