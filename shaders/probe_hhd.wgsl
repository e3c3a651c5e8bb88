// Made by scripts/shaders from probe_hhd.glsl: edit that.
// HHD of a probe on a surface, channel by channel. Needs: hhd, probe_hemisphere.

// What lumel_multiply_hemisphere_linear gives, as hemisphere, directional light and ring; I = E/pi about n.
fn lumel_linear_sh_hhd(sh: LumelLinearSh, n_v: vec3f, n: vec3f) -> vec3f {
    var b_c: vec3f = sh.l0 * 1.12837916710;
    var x: vec3f = sh.l3 * -0.65147001587;
    var y: vec3f = sh.l1 * -0.65147001587;
    var z: vec3f = sh.l2 * 0.65147001587;
    return vec3f(lumel_evaluate_hhd(lumel_solve_hhd_ring(b_c.x, vec3f(x.x, y.x, z.x), n_v), n_v, n),
                lumel_evaluate_hhd(lumel_solve_hhd_ring(b_c.y, vec3f(x.y, y.y, z.y), n_v), n_v, n),
                lumel_evaluate_hhd(lumel_solve_hhd_ring(b_c.z, vec3f(x.z, y.z, z.z), n_v), n_v, n));
}
