// Light in 32 bits of a texel: RGB9E5 of GPUs and four ways to put RGB into the four bytes of a PNG or a .hdr.
// Based on: Khronos Data Format Specification 1.3, "Shared exponent formats" (RGB9E5); Ericson 2007, "Converting RGB to
// LogLuv in a fragment shader" (matrices and layout, here with the inverse of their own matrix); Ward 1991, "Real
// Pixels" (RGBE); Karis 2009, "RGBM color encoding"; Babylon.js' fromRGBD (RGBD: gamma 2.2, divisor in alpha).
//
// All take values >= 0; what is negative or no number is 0, what is too large the largest. Decoding is what shaders do.
#pragma once

#include <array>
#include <cstdint>

#include "lumel/vec.h"

namespace lumel {

using PixelBytes = std::array<std::uint8_t, 4>;

// Nine bits a channel, one exponent of five bits: up to 65408, steps of 2^-24 at least. Little-endian: R is lowest.
inline constexpr float kLargestRgb9e5 = 65408.0f;
std::uint32_t encode_rgb9e5(Vec3 light);
Vec3 decode_rgb9e5(std::uint32_t code);

// rgb * m, all 0..1; light up to 1. m is the least that makes room for the brightest channel.
PixelBytes encode_rgbm(Vec3 light);
Vec3 decode_rgbm(PixelBytes code);

// pow(rgb, 2.2) / d, all 0..1, d > 0; light up to 255.
inline constexpr float kLargestRgbd = 255.0f;
PixelBytes encode_rgbd(Vec3 light);
Vec3 decode_rgbd(PixelBytes code);

// log2 of the luminance in sixteen bits (bytes 2 and 3), from 2^-63 to 2^64, chromaticity in bytes 0 and 1. Not to be
// filtered: the two bytes of the logarithm belong together.
PixelBytes encode_logluv(Vec3 light);
Vec3 decode_logluv(PixelBytes code);

// Eight bits a channel and an exponent: rgb * 2^(e - 136).
PixelBytes encode_rgbe(Vec3 light);
Vec3 decode_rgbe(PixelBytes code);

}  // namespace lumel
