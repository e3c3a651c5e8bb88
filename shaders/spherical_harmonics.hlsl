// Made by scripts/shaders from spherical_harmonics.glsl: edit that.
// Quadratic spherical harmonics of incident radiance, RGB, basis S of docs/conventions.md: `l2` lightmaps and probes.
// Based on: Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps"; Roughton 2024,
// "Hemispherical Lighting Insights" (hemispheres and cones), with band 2 as a symmetric matrix instead of a table.

// Coefficients by index l(l+1)+m.
struct LumelSh {
    float3 l0;
    float3 l1;
    float3 l2;
    float3 l3;
    float3 l4;
    float3 l5;
    float3 l6;
    float3 l7;
    float3 l8;
};

// The linear band along n: the zonal coefficient of band 1.
float3 lumel_sh_along(LumelSh sh, float3 n) {
    return sh.l2 * n.z - sh.l3 * n.x - sh.l1 * n.y;
}

// Band 2 in direction n, without its factor sqrt(5/(4 pi)): the zonal coefficient of band 2.
float3 lumel_sh_zonal_quadratic(LumelSh sh, float3 n) {
    return sh.l6 * (1.5 * n.z * n.z - 0.5) +
           (sh.l4 * (n.x * n.y) - sh.l5 * (n.y * n.z) - sh.l7 * (n.x * n.z)) * 1.73205080757 +
           sh.l8 * (0.86602540378 * (n.x * n.x - n.y * n.y));
}

// I = E/pi about n, world frame: `l2`. May be negative.
float3 lumel_sh_irradiance(LumelSh sh, float3 n) {
    return sh.l0 * 0.28209479177 + lumel_sh_along(sh, n) * 0.32573500794 +
           lumel_sh_zonal_quadratic(sh, n) * 0.15769578263;
}
