// Lightmap UVs of instances that share their vertices: each chart of each instance has a transform of its own in one
// buffer (`transforms` of LUMEL_lightmap in scene.glb, `charts.transform` in manifest.json: docs/formats.md). A vertex
// knows its chart and its place in it (`charts`, `chartUvs`), an instance where its charts begin (`firstChart`).
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018), "Unpacking transforms in the shader".
//
//   GLSL 4.30, Vulkan:  layout(std430, binding = 0) readonly buffer LumelCharts { vec4 lumel_charts[]; };
//                       vec2 uv = lumel_lightmap_uv(chart_uv, lumel_charts[lumel_chart_index(first_chart, chart)]);
//   GLSL ES 3.00:       uniform highp sampler2D lumel_charts;  // RGBA32F, rows filled one after the other, nearest
//                       uint i = lumel_chart_index(first_chart, chart), width = uint(textureSize(lumel_charts, 0).x);
//                       ivec2 at = ivec2(lumel_chart_texel(i, width));
//                       vec2 uv = lumel_lightmap_uv(chart_uv, texelFetch(lumel_charts, at, 0));

// Which entry of the buffer.
uint lumel_chart_index(uint first_chart, uint chart) {
    return first_chart + chart;
}

// Where that entry is in a texture of this width.
uvec2 lumel_chart_texel(uint index, uint width) {
    return uvec2(index % width, index / width);
}

// Lightmap UV, 0 to 1 over the page: what TEXCOORD_1 holds.
vec2 lumel_lightmap_uv(vec2 chart_uv, vec4 transform) {
    return chart_uv * transform.xy + transform.zw;
}
