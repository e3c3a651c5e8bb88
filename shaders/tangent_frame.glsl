// The frame of encodings that are relative to the surface: a function of the world-space vertex normal alone, never
// glTF's TANGENT (docs/stages/encode.md, "Tangent frame").

// The world-space vector v in the frame of the unit normal n_v, which becomes +z.
vec3 lumel_to_tangent(vec3 n_v, vec3 v) {
    vec3 pole = vec3(2.0, 3.0, 6.0) / 7.0;
    vec3 axis = vec3(6.0, 2.0, -3.0) / 7.0;
    float along = 1.0 + dot(pole, n_v);
    vec3 tangent = axis;
    if (along > 0.0001) {
        tangent = tangent - (pole + n_v) * (dot(axis, n_v) / along);
    }
    tangent = normalize(tangent - n_v * dot(tangent, n_v));
    return vec3(dot(tangent, v), dot(cross(n_v, tangent), v), dot(n_v, v));
}

// An upper-hemisphere direction of the tangent frame from two numbers in [0, 1].
// Based on: Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors" (hemi-oct).
vec3 lumel_from_hemi_octahedral(vec2 uv) {
    float x = uv.x + uv.y - 1.0;
    float y = uv.x - uv.y;
    return normalize(vec3(x, y, 1.0 - abs(x) - abs(y)));
}
