// Made by scripts/shaders from spherical_harmonics.glsl: edit that.
// Quadratic spherical harmonics of incident radiance, RGB, basis S of docs/conventions.md: `l2` lightmaps and probes.
// Based on: Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps"; Roughton 2024,
// "Hemispherical Lighting Insights" (hemispheres and cones), with band 2 as a symmetric matrix instead of a table.

// Coefficients by index l(l+1)+m.
struct LumelSh {
    l0: vec3f,
    l1: vec3f,
    l2: vec3f,
    l3: vec3f,
    l4: vec3f,
    l5: vec3f,
    l6: vec3f,
    l7: vec3f,
    l8: vec3f,
}

// The linear band along n: the zonal coefficient of band 1.
fn lumel_sh_along(sh: LumelSh, n: vec3f) -> vec3f {
    return sh.l2 * n.z - sh.l3 * n.x - sh.l1 * n.y;
}

// Band 2 in direction n, without its factor sqrt(5/(4 pi)): the zonal coefficient of band 2.
fn lumel_sh_zonal_quadratic(sh: LumelSh, n: vec3f) -> vec3f {
    return sh.l6 * (1.5 * n.z * n.z - 0.5) +
           (sh.l4 * (n.x * n.y) - sh.l5 * (n.y * n.z) - sh.l7 * (n.x * n.z)) * 1.73205080757 +
           sh.l8 * (0.86602540378 * (n.x * n.x - n.y * n.y));
}

// I = E/pi about n, world frame: `l2`. May be negative.
fn lumel_sh_irradiance(sh: LumelSh, n: vec3f) -> vec3f {
    return sh.l0 * 0.28209479177 + lumel_sh_along(sh, n) * 0.32573500794 +
           lumel_sh_zonal_quadratic(sh, n) * 0.15769578263;
}
