// Charts and smooth seams of xatlas on the meshes of `lumel_bench charts --write` (bench/charts_bench.cpp has the format).
import {openSync, readSync, fstatSync} from 'node:fs';
import {basename} from 'node:path';
import * as watlas from 'watlas';

// Reads a file front to back.
class Reader {
    constructor(path) {
        this.file = openSync(path);
        this.left = fstatSync(this.file).size;
    }
    array(type, count) {
        const out = new type(count);
        if (readSync(this.file, new Uint8Array(out.buffer)) !== out.byteLength) throw new Error('the file ends early');
        this.left -= out.byteLength;
        return out;
    }
    mesh() {
        const [vertices, triangles, contacts] = this.array(Uint32Array, 3);
        return {
            positions: this.array(Float32Array, 3 * vertices),
            normals: this.array(Float32Array, 3 * vertices),
            indices: this.array(Uint32Array, 3 * triangles),
            contacts: this.contacts(contacts),
        };
    }
    contacts(count) {
        const view = new DataView(this.array(Uint8Array, 48 * count).buffer);
        return Array.from({length: count}, (_, i) => {
            const u32 = (at) => view.getUint32(48 * i + at, true), f64 = (at) => view.getFloat64(48 * i + at, true);
            return {a: u32(0), b: u32(4), a0: f64(8), a1: f64(16), b0: f64(24), b1: f64(32), length: f64(40)};
        });
    }
}

// Length of the contacts whose triangles lie on other places of the layout.
function smoothSeam(mesh, made) {
    const indices = new Uint32Array(made.indexCount);
    made.getIndexArray(indices);
    const chart = new Int32Array(made.vertexCount), uv = new Float64Array(2 * made.vertexCount);
    for (let i = 0; i < made.vertexCount; ++i) {
        const v = made.getVertex(i);
        chart[i] = v.chartIndex;
        uv[2 * i] = v.uv[0], uv[2 * i + 1] = v.uv[1];
    }
    const along = (edge, s) => {
        const v = indices[edge], w = indices[edge % 3 === 2 ? edge - 2 : edge + 1];
        return [0, 1].map((c) => uv[2 * v + c] + s * (uv[2 * w + c] - uv[2 * v + c]));
    };
    const distance = (p, q) => Math.hypot(p[0] - q[0], p[1] - q[1]);
    let seam = 0;
    for (const c of mesh.contacts) {
        const chartA = chart[indices[c.a]], chartB = chart[indices[c.b]];
        let cut = chartA < 0 || chartA !== chartB;
        if (!cut) {
            const a0 = along(c.a, c.a0), a1 = along(c.a, c.a1), b0 = along(c.b, c.b0), b1 = along(c.b, c.b1);
            const tolerance = Math.max(0.01 * distance(a0, a1), 1e-2);
            cut = distance(a0, b0) > tolerance || distance(a1, b1) > tolerance;
        }
        if (cut) seam += c.length;
    }
    return seam;
}

await watlas.Initialize();
console.log('scene,meshes,triangles,charts,smooth_seam_m,cpu_seconds');
for (const path of process.argv.slice(2)) {
    const reader = new Reader(path), meshes = [];
    while (reader.left > 0) meshes.push(reader.mesh());
    const start = process.cpuUsage();
    const atlas = new watlas.Atlas();
    for (const m of meshes)
        atlas.addMesh({
            vertexPositionData: m.positions, vertexCount: m.positions.length / 3, vertexPositionStride: 12,
            vertexNormalData: m.normals, vertexNormalStride: 12,
            indexData: m.indices, indexCount: m.indices.length,
        });
    atlas.computeCharts({});
    const spent = process.cpuUsage(start);
    atlas.packCharts({resolution: 4096, padding: 1, bilinear: true});
    let charts = 0, seam = 0, triangles = 0;
    meshes.forEach((m, i) => {
        const made = atlas.getMesh(i);
        charts += made.chartCount;
        triangles += m.indices.length / 3;
        seam += smoothSeam(m, made);
    });
    atlas.delete();
    console.log([basename(path, '.meshes'), meshes.length, triangles, charts, seam.toFixed(2),
                 ((spent.user + spent.system) / 1e6).toFixed(1)].join(','));
}
