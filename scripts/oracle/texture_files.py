#!/usr/bin/env python3
"""Reads what `lumel encode` writes with parsers of its own, has Mesa decode the blocks (bc_decode.py), and compares every
channel with the EXR files of the same encoding.

  texture_files.py check LUMEL BAKE     encodes the bake into folders of its own; fails where a file is not as it should be

Needs numpy, libzstd and, for blocks, Debian's libegl1 and libgl1-mesa-dri.
"""
import ctypes
import json
import os
import struct
import subprocess
import sys
import tempfile
import zlib

try:
    import numpy as np
except ImportError:
    print("texture_files.py: numpy is missing (python3-numpy)", file=sys.stderr)
    sys.exit(77)  # what ctest takes as skipped

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bc_decode  # noqa: E402

# VkFormat: (name of the block decoder or None, bytes of a block, its edge, bytes of a number, colour model, samples)
FORMATS = {
    37: (None, 4, 1, 1, 1, 4), 97: (None, 8, 1, 2, 1, 4), 123: (None, 4, 1, 4, 1, 6),
    131: ("bc1", 8, 4, 1, 128, 1), 139: ("bc4", 8, 4, 1, 131, 1), 141: ("bc5", 16, 4, 1, 132, 2),
    143: ("bc6h_uf16", 16, 4, 1, 133, 1), 144: ("bc6h_sf16", 16, 4, 1, 133, 1), 145: ("bc7", 16, 4, 1, 134, 1),
}
DXGI = {28: 37, 10: 97, 67: 123, 71: 131, 80: 139, 83: 141, 95: 143, 96: 144, 98: 145}


def need(condition, *what):
    if not condition:
        raise AssertionError(" ".join(str(w) for w in what))


def unpack_zstd(data, size):
    try:
        library = ctypes.CDLL("libzstd.so.1")
    except OSError:
        raise bc_decode.Missing("no libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    out = ctypes.create_string_buffer(size)
    got = library.ZSTD_decompress(out, ctypes.c_size_t(size), data, ctypes.c_size_t(len(data)))
    need(got == size, "Zstandard gave", got, "bytes, not", size)
    return out.raw


def read_ktx2(path):
    """-> VkFormat, width, height, of each level its layers as bytes."""
    data = open(path, "rb").read()
    need(data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n", path, "is no KTX2")
    vk, type_size, width, height, depth, layers, faces, levels, scheme = struct.unpack_from("<9I", data, 12)
    dfd_at, dfd_size, kvd_at, kvd_size, sgd_at, sgd_size = struct.unpack_from("<4I2Q", data, 48)
    name, block, edge, number, model, samples = FORMATS[vk]
    need((type_size, depth, faces) == (number, 0, 1) and levels >= 1, path, "header")
    need((sgd_at, sgd_size) == (0, 0) and dfd_at == 80 + 24 * levels, path, "index")
    total, vendor, version, words, edges, planes = struct.unpack_from("<5IQ", data, dfd_at)
    need(total == dfd_size == 28 + 16 * samples and vendor == 0, path, "size of the descriptor")
    need(version == (2 | (24 + 16 * samples) << 16) and words == (model | 1 << 8 | 1 << 16), path, "descriptor")
    need(edges == ((edge - 1) | (edge - 1) << 8) and planes == block, path, "block of the descriptor")
    pairs, at = {}, kvd_at
    while at < kvd_at + kvd_size:
        size, = struct.unpack_from("<I", data, at)
        key, value = data[at + 4:at + 4 + size].split(b"\0", 1)
        pairs[key] = value
        at += 4 + (size + 3) // 4 * 4
    need(pairs.get(b"KTXorientation") == b"rd\0" and list(pairs) == sorted(pairs), path, "key values", pairs)
    out, end = [], len(data)
    for level in range(levels):  # the largest first in the index and last in the file
        offset, size, unpacked = struct.unpack_from("<3Q", data, 80 + 24 * level)
        need(offset + size == end, path, "level", level, "does not end where the one before begins")
        end = offset
        texels = unpack_zstd(data[offset:offset + size], unpacked) if scheme == 2 else data[offset:offset + size]
        need(len(texels) == (layers or 1) * level_size(vk, width, height, level), path, "size of level", level)
        out.append(split(texels, layers or 1, path))
    return vk, width, height, out


def read_dds(path):
    data = open(path, "rb").read()
    size, flags, height, width, pitch, depth, levels = struct.unpack_from("<7I", data, 4)
    need(data[:4] == b"DDS " and size == 124 and flags & 0x1007 == 0x1007, path, "is no DDS")
    need(struct.unpack_from("<2I", data, 76) == (32, 4) and data[84:88] == b"DX10", path, "pixel format")
    dxgi, dimension, _, layers, _ = struct.unpack_from("<5I", data, 128)
    need((dimension, depth) == (3, 0) and levels >= 1, path, "header")
    need(bool(flags & 0x20000) == (levels > 1), path, "flag of mips")
    vk = DXGI[dxgi]
    _, block, edge, *_ = FORMATS[vk]
    across, down = -(-width // edge), -(-height // edge)
    need(pitch == across * block * (down if edge > 1 else 1), path, "pitch", pitch)
    sizes = [level_size(vk, width, height, level) for level in range(levels)]
    need(len(data) == 148 + layers * sum(sizes), path, "size")
    out, at = [[] for _ in sizes], 148
    for _ in range(layers):
        for level, size in enumerate(sizes):
            out[level].append(data[at:at + size])
            at += size
    return vk, width, height, out


def level_size(vk, width, height, level):
    _, block, edge, *_ = FORMATS[vk]
    return -(-max(width >> level, 1) // edge) * -(-max(height >> level, 1) // edge) * block


def split(data, layers, path):
    need(len(data) % layers == 0, path, "layers of unequal size")
    size = len(data) // layers
    return [data[i * size:(i + 1) * size] for i in range(layers)]


def decode(gl, vk, data, width, height):
    """-> (height, width, channels) float."""
    name, block, edge, *_ = FORMATS[vk]
    if name:
        across, down = -(-width // 4), -(-height // 4)
        texels = gl.decode(name, np.frombuffer(data, np.uint8).reshape(-1, block))
        image = texels.reshape(down, across, 4, 4, 4).transpose(0, 2, 1, 3, 4).reshape(4 * down, 4 * across, 4)
        return image[:height, :width]
    if vk == 37:
        return np.frombuffer(data, np.uint8).reshape(height, width, 4) / 255.0
    if vk == 97:
        return np.frombuffer(data, np.float16).reshape(height, width, 4).astype(float)
    code = np.frombuffer(data, np.uint32).reshape(height, width)
    rgb = np.stack([code & 511, code >> 9 & 511, code >> 18 & 511], -1)
    return rgb * 2.0 ** ((code >> 27).astype(float) - 24)[..., None]


def read_png(path):
    data = open(path, "rb").read()
    need(data[:8] == b"\x89PNG\r\n\x1a\n", path, "is no PNG")
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack_from(">IIBB", body)
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    channels = {2: 3, 6: 4}[colour]
    need(bits == 8, path, "is not of 8 bits")
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels)
    out = np.zeros((height, width * channels), np.uint8)
    for y in range(height):
        kind, line = rows[y, 0], rows[y, 1:].astype(int)
        above = out[y - 1].astype(int) if y else np.zeros(width * channels, int)
        for x in range(width * channels):
            a = int(out[y, x - channels]) if x >= channels else 0
            b, c = above[x], above[x - channels] if x >= channels else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            out[y, x] = (line[x] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
    return out.reshape(height, width, channels) / 255.0


def read_light(path, code):
    rgba = read_png(path)
    rgb, a = rgba[..., :3], rgba[..., 3:]
    if code == "RGBM":
        return rgb * a
    if code == "RGBD":
        return np.where(a > 0, rgb ** 2.2 / np.maximum(a, 1e-9), 0)
    y = np.exp2((rgb[..., 2] * 255 + a[..., 0] - 127) / 2)
    s = np.where(rgb[..., 1] > 0, y / np.maximum(rgb[..., 1], 1e-9), 0)
    back = np.array([[6.0014, -1.3320, 0.3008], [-2.7008, 3.1029, -1.0882], [-1.7996, -5.7721, 5.6268]])
    return np.maximum(np.stack([rgb[..., 0] * s, np.where(s > 0, y, 0), s], -1) @ back.T, 0)


def read_hdr(path):
    data = open(path, "rb").read()
    end = data.index(b"\n\n") + 2
    line = data[end:data.index(b"\n", end)].split()
    need(data[:2] == b"#?" and line[0] == b"-Y" and line[2] == b"+X", path, "header")
    height, width = int(line[1]), int(line[3])
    at = data.index(b"\n", end) + 1
    out = np.zeros((height, width, 4))
    for y in range(height):
        if width < 8 or width > 32767:
            out[y] = np.frombuffer(data, np.uint8, 4 * width, at).reshape(width, 4)
            at += 4 * width
            continue
        need(data[at:at + 4] == bytes([2, 2, width >> 8, width & 255]), path, "row", y)
        at += 4
        for channel in range(4):
            x = 0
            while x < width:
                count = data[at]
                if count > 128:
                    out[y, x:x + count - 128, channel] = data[at + 1]
                    x, at = x + count - 128, at + 2
                else:
                    out[y, x:x + count, channel] = np.frombuffer(data, np.uint8, count, at + 1)
                    x, at = x + count, at + 1 + count
    return np.where(out[..., 3:] > 0, out[..., :3] * 2.0 ** (out[..., 3:] - 136), 0)


def read_exr(path):
    """Scan lines, ZIP or none, half and float. -> {name: (height, width)}"""
    data = open(path, "rb").read()
    need(data[:4] == b"\x76\x2f\x31\x01", path, "is no EXR")
    at, attributes = 8, {}
    while data[at]:
        name, kind = (data[at:].split(b"\0", 2)[i] for i in range(2))
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<I", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    x0, y0, x1, y1 = struct.unpack("<4i", attributes[b"dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = {0: 1, 2: 1, 3: 16}[attributes[b"compression"][0]]
    channels, rest = [], attributes[b"channels"]
    while rest[0]:
        name, rest = rest.split(b"\0", 1)
        channels.append((name.decode(), {1: np.float16, 2: np.float32}[struct.unpack_from("<I", rest)[0]]))
        rest = rest[16:]
    out = {name: np.zeros((height, width)) for name, _ in channels}
    row = sum(width * np.dtype(kind).itemsize for _, kind in channels)
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at + 1):
        y, size = struct.unpack_from("<iI", data, offset)
        y -= y0
        count = min(lines, height - y)
        chunk = data[offset + 8:offset + 8 + size]
        if size < count * row:
            raw = np.frombuffer(zlib.decompress(chunk), np.uint8).astype(np.int64)
            raw[1:] -= 128
            raw = (np.cumsum(raw) & 255).astype(np.uint8)
            half = (len(raw) + 1) // 2
            chunk = np.zeros(len(raw), np.uint8)
            chunk[0::2], chunk[1::2] = raw[:half], raw[half:]
            chunk = chunk.tobytes()
        at_byte = 0
        for line in range(count):
            for name, kind in channels:
                out[name][y + line] = np.frombuffer(chunk, kind, width, at_byte)
                at_byte += width * np.dtype(kind).itemsize
    return out


def close(stored, truth, is_light):
    """Root mean square of the error over that of what is true; ratios and units have a range of their own."""
    scale = np.sqrt(np.mean(truth ** 2)) if is_light else 1.0
    return np.sqrt(np.mean((stored - truth) ** 2)) / max(scale, 1e-9)


def encode(lumel, bake, encoding, options):
    folder = tempfile.mkdtemp(dir=bake)
    subprocess.run([lumel, "encode", bake, "--encoding", encoding, "-o", folder, "--progress", "none", *options],
                   check=True)
    with open(os.path.join(folder, f"encoded_{encoding}.json")) as text:
        return folder, json.load(text)


def read_texture(gl, folder, texture, place, format_name, cache):
    path = os.path.join(folder, place["file"])
    if format_name in ("ktx2", "dds"):
        if path not in cache:
            cache[path] = read_ktx2(path) if format_name == "ktx2" else read_dds(path)
        vk, width, height, levels = cache[path]
        need(vk == texture["vk_format"], path, "vkFormat", vk)
        level = place["level"]
        return decode(gl, vk, levels[level][place["layer"]], max(width >> level, 1), max(height >> level, 1))
    if path.endswith(".hdr"):
        return read_hdr(path)
    return read_png(path) if texture["texels"] == "R8G8B8A8_UNORM" else read_light(path, texture["texels"])


def with_mips(pages):
    return [level for page in pages for level in [page, *page["mips"]]]


def check_one(gl, lumel, bake, encoding, options, limit):
    exr_folder, exr = encode(lumel, bake, encoding, [])
    folder, description = encode(lumel, bake, encoding, options)
    kinds = {c["name"]: c["kind"] for c in description["channels"]}
    cache, worst = {}, 0.0
    pages, exr_pages = with_mips(description["pages"]), with_mips(exr["pages"])
    need(len(pages) == len(exr_pages), encoding, "has", len(pages), "pages and mips, EXR files", len(exr_pages))
    for page, exr_page in zip(pages, exr_pages):
        truth = read_exr(os.path.join(exr_folder, exr_page["file"]))
        covered = np.any([plane != 0 for plane in truth.values()], axis=0)
        need(covered.any(), encoding, "has an empty page")
        for texture, place in zip(description["textures"], page["textures"]):
            image = read_texture(gl, folder, texture, place, description["format"], cache)
            need(image.shape[:2] == (page["height"], page["width"]), place["file"], "size", image.shape)
            for c, name in enumerate(texture["channels"]):
                kind = kinds[name]
                value = image[..., c] * place["scale"] if "light" in kind else image[..., c]
                value = 2 * value - 1 if kind == "ratio" else value
                error = close(value[covered], truth[name][covered], "light" in kind)
                need(error <= limit, encoding, options, place["file"], name, "is off by", error)
                worst = max(worst, error)
    for vk, _, _, levels in cache.values():
        need(len(levels) == 1 + len(description["pages"][0]["mips"]), encoding, "levels", len(levels))
    print(f"{encoding} {' '.join(options)}: {len(pages)} pages and mips, worst error {worst:.4f}")


def check(gl, lumel, bake):
    # What is swapped, shifted or of another layer is off by about 1. Blocks of noisy texels of tiny charts are off by a
    # tenth or two, of either sign by half (what is near zero costs them their codes), codes of single texels by what they
    # round.
    for container in ("ktx2", "dds"):
        for encoding, storage, limit in (
                ("l1-hhd", "bc7", 0.25), ("l1-hhd", "bc1", 0.25), ("irradz-hhd", "bc45", 0.25),
                ("irradz-hhd-rgb", "bc7", 0.25), ("hlsh", "bc7", 0.7), ("l1-mono", "rgb9e5", 0.01),
                ("h4", "rgba16f", 0.01)):
            check_one(gl, lumel, bake, encoding, ["--format", container, "--storage", storage], limit)
    for format_name, limit in (("png-rgbm", 0.02), ("png-rgbd", 0.02), ("png-logluv", 0.05), ("hdr", 0.01)):
        check_one(gl, lumel, bake, "irradz-hhd", ["--format", format_name], limit)


def main():
    if len(sys.argv) != 4 or sys.argv[1] != "check":
        print(__doc__, file=sys.stderr)
        return 2
    try:
        check(bc_decode.Gl(), sys.argv[2], sys.argv[3])
    except bc_decode.Missing as missing:
        print(f"texture_files.py: {missing}", file=sys.stderr)
        return 77
    except AssertionError as error:
        print(f"texture_files.py: FAILED: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
