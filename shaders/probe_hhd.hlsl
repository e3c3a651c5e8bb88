// Made by scripts/shaders from probe_hhd.glsl: edit that.
// HHD of a probe on a surface, channel by channel. Needs: hhd, probe_hemisphere.

// What lumel_multiply_hemisphere_linear gives, as hemisphere, directional light and ring; I = E/pi about n.
float3 lumel_linear_sh_hhd(LumelLinearSh sh, float3 n_v, float3 n) {
    float3 b_c = sh.l0 * 1.12837916710;
    float3 x = sh.l3 * -0.65147001587;
    float3 y = sh.l1 * -0.65147001587;
    float3 z = sh.l2 * 0.65147001587;
    return float3(lumel_evaluate_hhd(lumel_solve_hhd_ring(b_c.x, float3(x.x, y.x, z.x), n_v), n_v, n),
                lumel_evaluate_hhd(lumel_solve_hhd_ring(b_c.y, float3(x.y, y.y, z.y), n_v), n_v, n),
                lumel_evaluate_hhd(lumel_solve_hhd_ring(b_c.z, float3(x.z, y.z, z.z), n_v), n_v, n));
}
