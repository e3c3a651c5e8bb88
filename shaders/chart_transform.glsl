// Lightmap UVs of instances that share their vertices: each chart of each instance has a transform of its own in one
// buffer (`transforms` of LUMEL_lightmap in scene.glb, `charts.transform` in manifest.json: docs/formats.md). A vertex
// knows its chart and its place in it (`charts`, `chartUvs`), an instance where its charts begin (`firstChart`).
// docs/stages/shaders.md shows how each language reads that buffer.
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018), "Unpacking transforms in the shader".

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
    return chart_uv * vec2(transform.x, transform.y) + vec2(transform.z, transform.w);
}
