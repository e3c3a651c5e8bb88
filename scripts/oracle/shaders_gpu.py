#!/usr/bin/env python3
"""Runs every function of shaders/*.glsl on Mesa's software GPU (llvmpipe) and compares it with the same text as C++.

  shaders_gpu.py DUMP    DUMP: build target lumel_shader_dump

Exit code 77 without numpy, libegl1, libgl1-mesa-dri or compute shaders."""
import ctypes
import os
import subprocess
import sys
import tempfile

from bc_decode import Gl, Missing  # exits 77 without numpy
from shader_texts import cases, library

import numpy as np

# Errors relative to the result and to the largest number that went in. The GPU's pow, exp2 and its square roots round
# otherwise than libm's, to some 2^-20; a highlight's denominator, 1 - n_h^2 (1 - a^2), magnifies it tenfold.
TOLERANCE = 1e-5
HEADER = "#version 430\nlayout(local_size_x = 64) in;\n"
MAIN = """
layout(std430, binding = 0) readonly buffer Inputs { float inputs[]; };
layout(std430, binding = 1) writeonly buffer Outputs { float outputs[]; };
vec3 at(uint i) { return vec3(inputs[i], inputs[i + 1u], inputs[i + 2u]); }
void main() {
    uint i = gl_GlobalInvocationID.x * 36u;
    if (i >= uint(inputs.length())) { return; }
    LumelSh a;
    a.l0 = at(i + 2u); a.l1 = at(i + 5u); a.l2 = at(i + 8u); a.l3 = at(i + 11u); a.l4 = at(i + 14u);
    a.l5 = at(i + 17u); a.l6 = at(i + 20u); a.l7 = at(i + 23u); a.l8 = at(i + 26u);
    uint which = uint(inputs[i]);
    vec3 o = inputs[i + 1u] == 0.0 ? test_decode(which, a, at(i + 32u)) : test_other(which, a, at(i + 29u), at(i + 32u));
    uint k = gl_GlobalInvocationID.x * 3u;
    outputs[k] = o.x; outputs[k + 1u] = o.y; outputs[k + 2u] = o.z;
}
"""


def program(gl, text):
    shader = gl.call("glCreateShader", 0x91B9)
    source = ctypes.c_char_p(text.encode())
    gl.call("glShaderSource", shader, 1, ctypes.cast(ctypes.pointer(source), ctypes.POINTER(ctypes.c_void_p * 1)).contents, None)
    gl.call("glCompileShader", shader)
    made = gl.call("glCreateProgram")
    gl.call("glAttachShader", made, shader)
    gl.call("glLinkProgram", made)
    linked = (ctypes.c_int * 1)()
    gl.call("glGetProgramiv", made, 0x8B82, linked)
    if not linked[0]:
        log = (ctypes.c_char * 4096)()
        gl.call("glGetShaderInfoLog", shader, 4096, None, log)
        raise SystemExit("shaders_gpu.py: " + log.value.decode())
    return made


def run(gl, inputs):
    """inputs: float32 (n, 36) -> float32 (n, 3)."""
    gl.call("glUseProgram", program(gl, HEADER + library("glsl") + cases("glsl") + MAIN))
    buffers = (ctypes.c_uint * 2)()
    gl.call("glGenBuffers", 2, buffers)
    out = (ctypes.c_float * (3 * len(inputs)))()
    for binding, size, data in ((0, inputs.nbytes, inputs.tobytes()), (1, ctypes.sizeof(out), None)):
        gl.call("glBindBufferBase", 0x90D2, binding, buffers[binding])
        gl.call("glBufferData", 0x90D2, size, data, 0x88E4)
    gl.call("glDispatchCompute", -(-len(inputs) // 64), 1, 1)
    gl.call("glMemoryBarrier", 0x200)
    gl.call("glGetBufferSubData", 0x90D2, 0, ctypes.sizeof(out), out)
    error = gl.call("glGetError")
    if error:
        raise SystemExit(f"shaders_gpu.py: OpenGL error {error:#x}")
    return np.frombuffer(out, np.float32).reshape(-1, 3)


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "cases")
        subprocess.run([sys.argv[1], path], check=True)
        rows = np.fromfile(path, np.float32).reshape(-1, 39)
    try:
        ours = run(Gl(), np.ascontiguousarray(rows[:, :36]))
    except Missing as missing:
        print(f"shaders_gpu.py: {missing}: skipped")
        return 77
    theirs = rows[:, 36:]
    size = np.maximum(np.abs(theirs).max(1), np.abs(rows[:, 2:29]).max(1)) + 1e-6
    error = np.abs(ours - theirs).max(1) / size
    error[~np.isfinite(error)] = np.inf
    failed = False
    for kind, name in enumerate(("test_decode", "test_other")):
        for which in sorted(set(rows[rows[:, 1] == kind, 0])):
            worst = error[(rows[:, 1] == kind) & (rows[:, 0] == which)].max()
            failed |= not worst <= TOLERANCE
            print(f"{name} {int(which):2d}: {worst:.1e}" + ("" if worst <= TOLERANCE else "  TOO FAR"))
    print(f"{len(rows)} cases, worst {error.max():.1e}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
