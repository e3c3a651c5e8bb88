// Every function of shaders/ behind a number, in the subset of scripts/shaders: a GPU and C++ run the same ones.
// a: the numbers of an encoding in the order of its fields, three by three; the vectors are unit and of one frame.

// Decodes that lie in the tangent frame, n_v = +z; 0 is plain irradiance.
vec3 test_decode(uint which, LumelSh a, vec3 n) {
    vec3 up = vec3(0.0, 0.0, 1.0);
    vec2 d = vec2(a.l1.y, a.l1.z);
    vec2 d_rgb = vec2(a.l2.x, a.l2.y);
    if (which == 1u) { return lumel_irradz_ahd(a.l0, a.l1.x, d, n); }
    if (which == 2u) { return lumel_irradz_hhd(a.l0, a.l1.x, d, n); }
    if (which == 3u) { return lumel_irradz_ahd_rgb(a.l0, a.l1, d_rgb, n); }
    if (which == 4u) { return lumel_irradz_hhd_rgb(a.l0, a.l1, d_rgb, n); }
    if (which == 5u) { return lumel_l1_mono(a.l0, a.l1, up, n); }
    if (which == 6u) { return lumel_l1_linear(a.l0, a.l1, a.l2, a.l3, n); }
    if (which == 7u) { return lumel_l1_hazel(a.l0, a.l1, a.l2, a.l3, n); }
    if (which == 8u) { return lumel_l1_hhd(a.l0, a.l1, a.l2, a.l3, up, n); }
    if (which == 9u) { return lumel_zh3_hallucinated(a.l0, a.l1, a.l2, a.l3, n); }
    if (which == 10u) { return lumel_zh3(a.l0, a.l1, a.l2, a.l3, a.l4, n); }
    if (which == 11u) { return lumel_hlsh(a.l0, a.l1, a.l2, a.l3, n); }
    if (which == 12u) { return lumel_h4(a.l0, a.l1, a.l2, a.l3, n); }
    if (which == 13u) { return lumel_h6(a.l0, a.l1, a.l2, a.l3, a.l4, a.l5, n); }
    if (which == 14u) { return lumel_sh_irradiance(a, n); }
    if (which == 15u) { return lumel_ahd(a.l0, a.l1, d_rgb, n); }
    if (which == 16u) { return lumel_rnm(a.l0, a.l1, a.l2, n); }
    if (which == 17u) { return lumel_ambient_cube(a.l0, a.l1, a.l2, a.l3, a.l4, n); }
    if (which == 18u) { return lumel_sg5(a.l0, a.l1, a.l2, a.l3, a.l4, n); }
    return a.l0;
}

// All else, on numbers of L1 (l0, l1 to l3 as L1n) or of spherical harmonics. n_v is any normal.
vec3 test_other(uint which, LumelSh a, vec3 n_v, vec3 n) {
    float c = 0.5 + 0.5 * n_v.x;
    vec4 bytes = vec4(0.2 + 0.1 * n.x, 0.3, 0.5 + 0.05 * n.y, 0.7);
    LumelHighlight light = lumel_l1_highlight(a.l0, a.l1, a.l2, a.l3);
    LumelTaps taps = lumel_bicubic_taps(vec2(c, 0.5 + 0.5 * n.x), vec2(64.0, 32.0));
    LumelHhd hhd = lumel_solve_hhd(4.0 * a.l0.x, a.l1 * (4.0 * a.l0.x), n_v);
    LumelLinearSh flat4 = lumel_multiply_hemisphere_linear(a, n_v);
    if (which == 0u) { return lumel_to_tangent(n_v, n); }
    if (which == 1u) { return lumel_from_hemi_octahedral(vec2(c, 0.5 + 0.5 * n.y)); }
    if (which == 2u) { return lumel_decode_ratio(n); }
    if (which == 3u) { return lumel_decode_rgbm(bytes, 8.0); }
    if (which == 4u) { return lumel_decode_rgbd(bytes, 8.0); }
    if (which == 5u) { return lumel_decode_logluv(bytes, 8.0); }
    if (which == 6u) { return vec3(hhd.iz, hhd.ambient, hhd.directional); }
    if (which == 7u) {
        float split = lumel_evaluate_hhd_split(hhd.iz, hhd.direction * hhd.directional, n_v, n);
        return vec3(lumel_evaluate_hhd(hhd, n_v, n), split, lumel_hazel(a.l0.x, a.l1, n));
    }
    if (which == 8u) { return lumel_l1_hhd(a.l0, a.l1, a.l2, a.l3, n_v, n); }
    if (which == 9u) { return lumel_l1_mono(a.l0, a.l1, n_v, n); }
    if (which == 10u) { return lumel_sh_irradiance(lumel_multiply_cone(a, c), n); }
    if (which == 11u) { return flat4.l0 + flat4.l1 * n.x + flat4.l2 * n.y + flat4.l3 * n.z; }
    if (which == 12u) { return lumel_evaluate_hlsh(lumel_hlsh_from_cone(a, n_v, c), n); }
    if (which == 13u) { return lumel_linear_sh_hhd(flat4, n_v, n); }
    if (which == 14u) { return vec3(lumel_cone_cosine(0.3 * c, 0.8), lumel_cone_cosine(0.9, 0.8), 0.0); }
    if (which == 15u) { return lumel_self_bounce(a.l0, vec3(0.5, 0.3, 0.8), n_v, n); }
    if (which == 16u) { return light.irradiance + light.direction * light.spread; }
    if (which == 17u) {
        return vec3(lumel_widened_alpha(0.2, c), lumel_adjusted_smoothness(0.6, c),
                    lumel_highlight_fade(1.0, c, 0.3, 0.7));
    }
    if (which == 18u) { return lumel_highlight(light, vec3(0.04, 0.04, 0.04), 0.3, n_v, n); }
    if (which == 19u) { return vec3(taps.x0, taps.x1, taps.y0 + taps.y1); }
    if (which == 20u) { return vec3(taps.w00, taps.w10, taps.w01 + 2.0 * taps.w11); }
    vec2 uv = lumel_lightmap_uv(vec2(n.x, n.y), vec4(n_v.x, n_v.y, 0.1, 0.2));
    uvec2 texel = lumel_chart_texel(lumel_chart_index(1000u, 29u), 256u);
    return vec3(uv.x, uv.y, float(texel.x + 300u * texel.y));
}
