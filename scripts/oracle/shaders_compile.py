#!/usr/bin/env python3
"""Compiles shaders/ with glslang (Debian's glslang-tools): GLSL for desktops and for WebGL 2, HLSL for Vulkan.

Exit code 77 where glslangValidator is missing."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

from shader_texts import cases, library

HEADERS = {
    "desktop": "#version 430\nout vec4 color;\n",
    "webgl2": "#version 300 es\nprecision highp float;\nprecision highp int;\nout vec4 color;\n",
}
CALL_ALL = "    LumelSh a;\n    color = vec4(test_decode(3u, a, a.l0) + test_other(3u, a, a.l0, a.l0), 1.0);\n"


def compile_text(folder, name, text, options):
    path = folder / name
    path.write_text(text)
    done = subprocess.run(["glslangValidator", *options, str(path)], capture_output=True, text=True)
    if done.returncode:
        print(f"{name}:\n{done.stdout}{done.stderr}", file=sys.stderr)
    return done.returncode == 0


def main():
    if not shutil.which("glslangValidator"):
        print("no glslangValidator (glslang-tools): skipped")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder, good = pathlib.Path(name), True
        for kind, header in HEADERS.items():
            body = library("glsl") + cases("glsl") + "void main() {\n" + CALL_ALL + "}\n"
            good &= compile_text(folder, f"{kind}.frag", header + body, [])
        body = library("hlsl") + cases("hlsl") + (
            "float4 main(float3 n : NORMAL) : SV_Target {\n    LumelSh a = (LumelSh)0;\n"
            "    return float4(test_decode(3, a, n) + test_other(3, a, n, n), 1.0);\n}\n")
        good &= compile_text(folder, "all.hlsl", body, ["-D", "-S", "frag", "-e", "main", "-V", "-o", str(folder / "o")])
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
