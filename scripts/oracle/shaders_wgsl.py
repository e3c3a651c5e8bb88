#!/usr/bin/env python3
"""Compiles the WGSL of shaders/, with all that calls it, in Chromium's WebGPU (tests/shaders/compile_wgsl.mjs).

Exit code 77 where node, Chromium or an adapter is missing."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

from shader_texts import ROOT, cases, library

MAIN = """
@group(0) @binding(0) var<storage, read_write> result: array<vec4f>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {
    var a: LumelSh;
    a.l0 = result[id.x].xyz;
    result[id.x] = vec4f(test_decode(id.x, a, a.l0) + test_other(id.x, a, a.l0, a.l0), 1.0);
}
"""


def main():
    if not shutil.which("node"):
        print("no node: skipped")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "all.wgsl"
        path.write_text(library("wgsl") + cases("wgsl") + MAIN)
        return subprocess.run(["node", ROOT / "tests" / "shaders" / "compile_wgsl.mjs", path], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
