// Made by scripts/shaders from probe_hemisphere.glsl: edit that.
// Quadratic probes on surfaces: only what lies above the surface lights it. n_v is the vertex normal in the frame of
// the coefficients (world), results are in that frame, too. Needs: spherical_harmonics.
// Based on: Roughton 2024, "Hemispherical Lighting Insights"; where its slides misprint, numerical integration decided.

// Cosine of the half angle of the cone whose cosine-weighted visibility (1 - ambient occlusion) is v, about a bent
// direction, a unit vector, at cosine z from n_v. 0 is the hemisphere.
float lumel_cone_cosine(float v, float z) {
    if (v >= z) {
        return 0.0;
    }
    return sqrt(1.0 - v / z);
}

// The Gram matrix of the cone about +z of cosine c (0: hemisphere): radiance inside the cone alone, projected to nine
// coefficients. `sh` is of the tangent frame.
LumelSh lumel_multiply_cone(LumelSh sh, float c) {
    float c2 = c * c;
    float c3 = c2 * c;
    float c4 = c2 * c2;
    float c5 = c4 * c;
    float m02 = 0.43301270189 * (1.0 - c2);
    float m06 = 0.55901699437 * (c - c3);
    float m11 = 0.25 * (2.0 - 3.0 * c + c3);
    float m15 = 0.41926274578 * (1.0 - c2) * (1.0 - c2);
    float m26 = 0.24206145914 * (1.0 + 2.0 * c2 - 3.0 * c4);
    float m44 = 0.0625 * (8.0 - 15.0 * c + 10.0 * c3 - 3.0 * c5);
    float m55 = 0.25 * (2.0 - 5.0 * c3 + 3.0 * c5);
    LumelSh seen;
    seen.l0 = sh.l0 * (0.5 * (1.0 - c)) + sh.l2 * m02 + sh.l6 * m06;
    seen.l1 = sh.l1 * m11 + sh.l5 * m15;
    seen.l2 = sh.l0 * m02 + sh.l2 * (0.5 * (1.0 - c3)) + sh.l6 * m26;
    seen.l3 = sh.l3 * m11 + sh.l7 * m15;
    seen.l4 = sh.l4 * m44;
    seen.l5 = sh.l1 * m15 + sh.l5 * m55;
    seen.l6 = sh.l0 * m06 + sh.l2 * m26 + sh.l6 * (0.125 * (4.0 - 5.0 * c + 10.0 * c3 - 9.0 * c5));
    seen.l7 = sh.l3 * m15 + sh.l7 * m55;
    seen.l8 = sh.l8 * m44;
    return seen;
}

// Linear coefficients by index l(l+1)+m: what lumel_solve_hhd takes its moments from.
struct LumelLinearSh {
    float3 l0;
    float3 l1;
    float3 l2;
    float3 l3;
};

// What of band 2 is linear across n_v, in the order of the coefficients 1 to 3. l0 stays zero.
LumelLinearSh lumel_sh_tangent_quadratic(LumelSh sh, float3 n_v) {
    float3 a = sh.l6 * 0.57735026919;
    float3 q_x = (sh.l8 - a) * n_v.x + sh.l4 * n_v.y - sh.l7 * n_v.z;
    float3 q_y = sh.l4 * n_v.x - (a + sh.l8) * n_v.y - sh.l5 * n_v.z;
    float3 q_z = a * (2.0 * n_v.z) - sh.l7 * n_v.x - sh.l5 * n_v.y;
    float3 along = q_x * n_v.x + q_y * n_v.y + q_z * n_v.z;
    LumelLinearSh p;
    p.l0 = float3(0.0, 0.0, 0.0);
    p.l1 = along * n_v.y - q_y;
    p.l2 = q_z - along * n_v.z;
    p.l3 = along * n_v.x - q_x;
    return p;
}

// Quadratic to linear: the hemisphere about n_v, projected to four coefficients.
LumelLinearSh lumel_multiply_hemisphere_linear(LumelSh sh, float3 n_v) {
    float3 along = lumel_sh_along(sh, n_v);
    float3 up = lumel_sh_irradiance(sh, n_v) * 1.53499006192 - along * 0.5;
    LumelLinearSh p = lumel_sh_tangent_quadratic(sh, n_v);
    p.l0 = sh.l0 * 0.5 + along * 0.43301270189;
    p.l1 = sh.l1 * 0.5 - up * n_v.y + p.l1 * 0.41926274578;
    p.l2 = sh.l2 * 0.5 + up * n_v.z + p.l2 * 0.41926274578;
    p.l3 = sh.l3 * 0.5 - up * n_v.x + p.l3 * 0.41926274578;
    return p;
}

// I(n) = ambient + x n_x + y n_y + z n_z over the hemisphere of n_v; iz = I(n_v).
struct LumelHlsh {
    float3 iz;
    float3 ambient;
    float3 x;
    float3 y;
    float3 z;
};

// HLSH of the light in the cone about n_v of cosine c (lumel_cone_cosine; 0: the hemisphere).
LumelHlsh lumel_hlsh_from_cone(LumelSh sh, float3 n_v, float c) {
    float c2 = c * c;
    float c3 = c2 * c;
    float c4 = c2 * c2;
    float c5 = c4 * c;
    float c6 = c3 * c3;
    float c7 = c6 * c;
    float3 z0 = sh.l0;
    float3 z1 = lumel_sh_along(sh, n_v);
    float3 z2 = lumel_sh_zonal_quadratic(sh, n_v);
    LumelHlsh hlsh;
    hlsh.iz = z0 * (0.28209479177 * (1.0 - c2)) + z1 * (0.32573500794 * (1.0 - c3)) +
              z2 * (0.15769578263 * (1.0 + 2.0 * c2 - 3.0 * c4));
    // The denominators are 4096 sqrt(pi), 8192 sqrt(3 pi), 8192 sqrt(pi)/sqrt(5).
    hlsh.ambient = z0 * ((1024.0 - 1767.0 * c + 512.0 * c2 + 210.0 * c3 + 21.0 * c5) / 7259.97097331) +
                   z1 * ((2203.0 - 5301.0 * c2 + 2048.0 * c3 + 945.0 * c4 + 105.0 * c6) / 25149.27717449) +
                   z2 * ((-448.0 + 1767.0 * c - 512.0 * c2 - 1977.0 * c3 + 768.0 * c4 + 357.0 * c5 + 45.0 * c7) /
                         6493.51544440);
    // 4096 sqrt(3 pi) and 2048 sqrt(pi)/sqrt(15).
    float k1 = (1.0 - c) * (1.0 - c) * (2573.0 + 2074.0 * c + 630.0 * c2 + 210.0 * c3 + 105.0 * c4) / 12574.63858725;
    float k2 = (176.0 - 256.0 * c2 - 105.0 * c3 + 128.0 * c4 + 42.0 * c5 + 15.0 * c7) / 937.25822245;
    float3 up = hlsh.iz - hlsh.ambient - z1 * k1;
    LumelLinearSh p = lumel_sh_tangent_quadratic(sh, n_v);
    hlsh.x = up * n_v.x - sh.l3 * k1 - p.l3 * k2;
    hlsh.y = up * n_v.y - sh.l1 * k1 - p.l1 * k2;
    hlsh.z = up * n_v.z + sh.l2 * k1 + p.l2 * k2;
    return hlsh;
}

float3 lumel_evaluate_hlsh(LumelHlsh hlsh, float3 n) {
    return hlsh.ambient + hlsh.x * n.x + hlsh.y * n.y + hlsh.z * n.z;
}
