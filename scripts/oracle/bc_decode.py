#!/usr/bin/env python3
"""Decodes block-compressed textures with Mesa's software OpenGL (llvmpipe): an independent reference for src/bc.

  bc_decode.py decode FORMAT BLOCKS OUT    file of blocks -> float32 RGBA, 16 texels a block, row by row
  bc_decode.py table OUT                   writes the table of tests (src/bc/known_blocks.h): blocks of every mode
  bc_decode.py check DUMP [COUNT]          COUNT random blocks of every mode and format through DUMP (build target
                                           lumel_bc_dump) and through Mesa; fails where they differ

FORMAT: bc1 bc1a bc4 bc5 bc6h_uf16 bc6h_sf16 bc7. Needs Debian's libegl1 and libgl1-mesa-dri, and numpy.
"""
import ctypes
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("bc_decode.py: numpy is missing (python3-numpy)", file=sys.stderr)
    sys.exit(77)  # what ctest takes as skipped

FORMATS = {  # GL enum, bytes per block
    "bc1": (0x83F0, 8), "bc1a": (0x83F1, 8), "bc4": (0x8DBB, 8), "bc5": (0x8DBD, 16),
    "bc6h_sf16": (0x8E8E, 16), "bc6h_uf16": (0x8E8F, 16), "bc7": (0x8E8C, 16),
}
BLOCKS_PER_ROW = 256


class Missing(Exception):
    """The oracle is not installed."""


class Gl:
    """A surfaceless desktop OpenGL context of llvmpipe."""

    def __init__(self):
        os.environ.setdefault("EGL_PLATFORM", "surfaceless")
        os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
        try:
            self.egl = ctypes.CDLL("libEGL.so.1")
        except OSError:
            raise Missing("no libEGL.so.1 (libegl1)")
        self.egl.eglGetDisplay.restype = ctypes.c_void_p
        self.egl.eglGetProcAddress.restype = ctypes.c_void_p
        self.egl.eglCreateContext.restype = ctypes.c_void_p
        get_platform = self.egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
        platform_display = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p)
        display = ctypes.c_void_p(platform_display(get_platform)(0x31DD, None, None))
        if not self.egl.eglInitialize(display, None, None):
            raise Missing("EGL has no surfaceless display (libegl1, libgl1-mesa-dri)")
        self.egl.eglBindAPI(0x30A2)
        attributes = (ctypes.c_int * 5)(0x3033, 0, 0x3040, 0x0008, 0x3038)
        config, count = ctypes.c_void_p(), ctypes.c_int()
        self.egl.eglChooseConfig(display, attributes, ctypes.byref(config), 1, ctypes.byref(count))
        context = ctypes.c_void_p(self.egl.eglCreateContext(display, config, None, None))
        if not self.egl.eglMakeCurrent(display, None, None, context):
            raise Missing("EGL has no surfaceless context (libgl1-mesa-dri)")

    def call(self, name, *arguments):
        address = self.egl.eglGetProcAddress(name.encode())
        kinds = [ctypes.c_void_p if isinstance(a, (bytes, ctypes.Array, type(None))) else ctypes.c_int
                 for a in arguments]
        return ctypes.CFUNCTYPE(ctypes.c_uint, *kinds)(address)(
            *[ctypes.cast(a, ctypes.c_void_p) if isinstance(a, (bytes, ctypes.Array)) else a for a in arguments])

    def decode(self, name, blocks):
        """blocks: uint8 (n, bytes per block) -> float32 (n, 16, 4)."""
        enum, size = FORMATS[name]
        count = len(blocks)
        rows = -(-count // BLOCKS_PER_ROW)
        padded = np.zeros((rows * BLOCKS_PER_ROW, size), np.uint8)
        padded[:count] = blocks
        width, height = 4 * BLOCKS_PER_ROW, 4 * rows
        texture = (ctypes.c_uint * 1)()
        self.call("glGenTextures", 1, texture)
        self.call("glBindTexture", 0x0DE1, texture[0])
        self.call("glCompressedTexImage2D", 0x0DE1, 0, enum, width, height, 0, padded.nbytes, padded.tobytes())
        out = (ctypes.c_float * (width * height * 4))()
        self.call("glGetTexImage", 0x0DE1, 0, 0x1908, 0x1406, out)
        error = self.call("glGetError")
        if error:
            raise RuntimeError(f"OpenGL error {error:#x} for {name}")
        self.call("glDeleteTextures", 1, texture)
        texels = np.frombuffer(out, np.float32).reshape(rows, 4, BLOCKS_PER_ROW, 4, 4)
        return texels.transpose(0, 2, 1, 3, 4).reshape(-1, 16, 4)[:count]


BC6H_MODES = [(0b00, 2), (0b01, 2)] + [(m, 5) for m in
              (0b00010, 0b00110, 0b01010, 0b01110, 0b10010, 0b10110, 0b11010, 0b11110,
               0b00011, 0b00111, 0b01011, 0b01111, 0b10011, 0b10111, 0b11011, 0b11111)]
BC7_MODES = [(1 << m, m + 1) for m in range(8)] + [(0, 8)]


def random_blocks(rng, name, count):
    """Random bits, `count` blocks of each mode; for the others blocks of both orders of end points."""
    size = FORMATS[name][1]
    modes = BC6H_MODES if name.startswith("bc6h") else BC7_MODES if name == "bc7" else [(0, 0), (0, 0)]
    out = []
    for bits, length in modes:
        blocks = rng.integers(0, 256, (count, size), dtype=np.uint8)
        blocks[:, 0] = (blocks[:, 0] & (0xFF << length & 0xFF)) | bits
        out.append(blocks)
    return np.concatenate(out)


def as_codes(name, texels):
    """What a table stores: half-float bits for BC6H, 8-bit codes for BC7."""
    if name.startswith("bc6h"):
        return texels[..., :3].astype(np.float16).view(np.uint16)
    return np.rint(texels * 255).astype(np.uint8)


def write_table(gl, path):
    rng = np.random.default_rng(1)
    lines = ["// Made by scripts/oracle/bc_decode.py table: random blocks of every mode, reserved ones too, and their texels as",
             "// Mesa's software OpenGL (llvmpipe) decodes them. BC6H: half-float bits of R, G, B; BC7: codes of R, G, B, A.",
             "#pragma once", "", "#include <array>", "#include <cstdint>", "", "namespace lumel::bc_test {", "",
             "template <class Code, int kChannels>", "struct KnownBlock {", "    std::array<std::uint8_t, 16> block;",
             "    std::array<Code, 16 * kChannels> texels;", "};", "", "// clang-format off"]
    for name, kind, channels, symbol in (("bc6h_uf16", "std::uint16_t", 3, "kKnownBc6hUnsigned"),
                                         ("bc6h_sf16", "std::uint16_t", 3, "kKnownBc6hSigned"),
                                         ("bc7", "std::uint8_t", 4, "kKnownBc7")):
        blocks = random_blocks(rng, name, 2)
        codes = as_codes(name, gl.decode(name, blocks))
        lines.append(f"inline constexpr KnownBlock<{kind}, {channels}> {symbol}[] = {{")
        for block, texels in zip(blocks, codes):
            lines.append("    {{" + ",".join(map(str, block)) + "},")
            lines.append("     {" + ",".join(map(str, texels.ravel())) + "}},")
        lines.append("};")
    lines += ["// clang-format on", "", "}  // namespace lumel::bc_test", ""]
    with open(path, "w") as out:
        out.write("\n".join(lines))


def dumped(program, name, blocks):
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, "blocks"), os.path.join(folder, "texels")
        blocks.tofile(source)
        subprocess.run([program, name, source, target], check=True)
        return np.fromfile(target, np.float32).reshape(-1, 16, 4)


def check(gl, program, count):
    rng = np.random.default_rng(2)
    failed = False
    for name in FORMATS:
        blocks = random_blocks(rng, name, count)
        theirs, ours = gl.decode(name, blocks), dumped(program, name, blocks)
        channels = {"bc4": 1, "bc5": 2}.get(name, 3 if name.startswith("bc6h") or name == "bc1" else 4)
        difference = np.abs(theirs - ours)[..., :channels]
        # BC1, BC4 and BC5 are specified in real numbers; Mesa interpolates in whole eight-bit codes, rounding down at
        # each step, 1.7 codes in all.
        bar = 0.0 if name.startswith("bc6h") else 1e-6 if name == "bc7" else 2.0 / 255
        worst = np.nan_to_num(difference, nan=np.inf).max()
        print(f"{name}: {len(blocks)} blocks, largest difference {worst:g}, bar {bar:g}")
        failed |= bool(worst > bar)
    return 1 if failed else 0


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        gl = Gl()
    except Missing as missing:
        print(f"bc_decode.py: {missing}", file=sys.stderr)
        sys.exit(77)
    if sys.argv[1] == "decode" and len(sys.argv) == 5:
        name = sys.argv[2]
        gl.decode(name, np.fromfile(sys.argv[3], np.uint8).reshape(-1, FORMATS[name][1])).tofile(sys.argv[4])
    elif sys.argv[1] == "table":
        write_table(gl, sys.argv[2])
    elif sys.argv[1] == "check":
        sys.exit(check(gl, sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 2000))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
