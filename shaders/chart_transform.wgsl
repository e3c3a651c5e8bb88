// Made by scripts/shaders from chart_transform.glsl: edit that.
// Lightmap UVs of instances that share their vertices: each chart of each instance has a transform of its own in one
// buffer (`transforms` of LUMEL_lightmap in scene.glb, `charts.transform` in manifest.json: docs/formats.md). A vertex
// knows its chart and its place in it (`charts`, `chartUvs`), an instance where its charts begin (`firstChart`).
// docs/stages/shaders.md shows how each language reads that buffer.
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018), "Unpacking transforms in the shader".

// Which entry of the buffer.
fn lumel_chart_index(first_chart: u32, chart: u32) -> u32 {
    return first_chart + chart;
}

// Where that entry is in a texture of this width.
fn lumel_chart_texel(index: u32, width: u32) -> vec2u {
    return vec2u(index % width, index / width);
}

// Lightmap UV, 0 to 1 over the page: what TEXCOORD_1 holds.
fn lumel_lightmap_uv(chart_uv: vec2f, transform: vec4f) -> vec2f {
    return chart_uv * vec2f(transform.x, transform.y) + vec2f(transform.z, transform.w);
}
