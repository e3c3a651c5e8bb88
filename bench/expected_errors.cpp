#include "expected_errors.h"

#include <limits>

namespace lumel::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// clang-format off
constexpr ExpectedRow kRows[] = {
    {"synthetic", "scalar I_z", {0.385, 0.329, 0.543, 0.702, 0.876, 0.326, 0.731, 0.742, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L1 moments, linear", {0, 0.038, 0.133, 0.238, 0.344, 0.161, 0.179, 0.234, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L1 moments, linear, I_z fixed", {0, 0.047, 0.134, 0.238, 0.355, 0.251, 0.188, 0.249, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L1 moments, Hazel", {0.099, 0.118, 0.097, 0.111, 0.104, 0.185, 0.081, 0.12, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L1 moments, HHD", {0, 0.097, 0.017, 0.065, 0.032, 0.513, 0, 0.101, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L1 moments, HHD+ring", {0, 0.013, 0.017, 0.065, 0.032, 0.022, 0, 0.089, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "H4", {0, 0.011, 0.097, 0.193, 0.297, 0.06, 0.107, 0.18, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "HLSH", {0, 0.017, 0.099, 0.195, 0.299, 0.13, 0.112, 0.186, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L1 radiance over the hemisphere", {0.385, 0.625, 0.306, 0.483, 1.47, 1.96, 0.217, 1.01, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "ambient cube, sampled", {0.122, 0.121, 0.21, 0.324, 0.413, 0.128, 0.252, 0.307, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "ambient cube, fitted", {0.048, 0.048, 0.141, 0.238, 0.317, 0.047, 0.159, 0.222, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "H6", {0, 0.011, 0.068, 0.108, 0.126, 0.06, 0.089, 0.093, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "ZH3 hallucinated", {0.086, 0.105, 0.091, 0.254, 0.106, 0.182, 0.078, 0.12, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "ZH3 stored", {0, 0.001, 0.088, 0.235, 0.086, 0.026, 0.078, 0.107, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L2 moments", {0, 0.001, 0.028, 0.043, 0.069, 0.026, 0.044, 0.046, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "L2 fitted", {0, 0.001, 0.026, 0.041, 0.066, 0.018, 0.042, 0.043, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "AHD sphere Gram, linear direction", {0.145, 0.144, 0.165, 0.566, 0.122, 0.326, 0.104, 0.209, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "AHD hemisphere Gram, linear direction", {0.002, 0.101, 0.123, 0.55, 0.122, 0.326, 0.077, 0.195, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "AHD hemisphere Gram, search", {0.002, 0.101, 0.118, 0.547, 0.04, 0.27, 0.038, 0.149, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "AHD exact lobes, search", {0, 0.101, 0.117, 0.547, 0.04, 0.27, 0.038, 0.149, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "AHD search, weight per channel", {0, 0.017, 0.103, 0.534, 0.039, 0.27, 0.031, 0.128, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "HHD sphere Gram, linear direction", {0, 0.097, 0.195, 0.571, 0.135, 0.513, 0.137, 0.24, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "HHD hemisphere Gram, linear direction", {0, 0.097, 0.197, 0.569, 0.133, 0.513, 0.134, 0.238, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "HHD hemisphere Gram, search", {0, 0.099, 0.11, 0.551, 0.033, 0.415, 0.026, 0.152, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "HHD exact lobes, search", {0, 0.099, 0.11, 0.551, 0.033, 0.415, 0.026, 0.152, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "HHD search, weight per channel", {0, 0.079, 0.029, 0.462, 0.032, 0.414, 0, 0.113, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"synthetic", "HHD closed form", {0, 0.097, 0.109, 0.556, 0.034, 0.513, 0.026, 0.161, kNone, kNone, kNone, kNone, kNone, kNone, kNone}},
    {"maps", "L1 moments, linear", {0.298, 0.264, 0.232, 0.262, 0.226, 0.216, 0.259, 0.282, 0.275, 0.21, 0.128, 0.23, 0.151, 0.173, 0.234}},
    {"maps", "L1 moments, Hazel", {0.131, 0.105, 0.081, 0.104, 0.112, 0.126, 0.187, 0.135, 0.115, 0.137, 0.092, 0.083, 0.128, 0.1, 0.12}},
    {"maps", "L1 moments, HHD+ring", {0.079, 0.041, 0.085, 0.05, 0.053, 0.072, 0.121, 0.113, 0.058, 0.128, 0.102, 0.096, 0.097, 0.095, 0.089}},
    {"maps", "H4", {0.236, 0.207, 0.176, 0.206, 0.175, 0.164, 0.2, 0.22, 0.214, 0.163, 0.085, 0.169, 0.113, 0.126, 0.18}},
    {"maps", "ZH3 hallucinated", {0.12, 0.096, 0.083, 0.11, 0.109, 0.128, 0.184, 0.123, 0.114, 0.154, 0.099, 0.082, 0.14, 0.101, 0.12}},
    {"maps", "ZH3 stored", {0.105, 0.077, 0.077, 0.089, 0.086, 0.118, 0.174, 0.113, 0.092, 0.146, 0.079, 0.074, 0.127, 0.093, 0.107}},
    {"maps", "H6", {0.117, 0.113, 0.094, 0.11, 0.094, 0.083, 0.09, 0.107, 0.107, 0.084, 0.061, 0.095, 0.055, 0.069, 0.093}},
    {"maps", "L2 moments", {0.066, 0.064, 0.037, 0.061, 0.052, 0.045, 0.041, 0.052, 0.051, 0.041, 0.018, 0.034, 0.027, 0.025, 0.046}},
    {"maps", "ambient cube, fitted", {0.296, 0.253, 0.228, 0.234, 0.216, 0.199, 0.227, 0.245, 0.248, 0.219, 0.151, 0.226, 0.135, 0.178, 0.222}},
    {"maps", "AHD sphere Gram, linear direction", {0.198, 0.131, 0.193, 0.215, 0.19, 0.175, 0.252, 0.196, 0.178, 0.287, 0.207, 0.165, 0.261, 0.222, 0.209}},
    {"maps", "AHD hemisphere Gram, linear direction", {0.191, 0.108, 0.186, 0.202, 0.166, 0.16, 0.246, 0.185, 0.168, 0.278, 0.18, 0.156, 0.238, 0.208, 0.195}},
    {"maps", "AHD hemisphere Gram, search", {0.146, 0.083, 0.134, 0.179, 0.151, 0.073, 0.137, 0.138, 0.082, 0.234, 0.17, 0.09, 0.208, 0.163, 0.149}},
    {"maps", "AHD search, weight per channel", {0.095, 0.075, 0.091, 0.136, 0.112, 0.07, 0.121, 0.111, 0.073, 0.218, 0.158, 0.088, 0.199, 0.134, 0.128}},
    {"maps", "HHD sphere Gram, linear direction", {0.215, 0.149, 0.209, 0.233, 0.198, 0.21, 0.33, 0.239, 0.193, 0.326, 0.236, 0.172, 0.304, 0.265, 0.24}},
    {"maps", "HHD hemisphere Gram, linear direction", {0.213, 0.144, 0.208, 0.233, 0.199, 0.207, 0.329, 0.236, 0.191, 0.323, 0.234, 0.171, 0.303, 0.26, 0.238}},
    {"maps", "HHD hemisphere Gram, search", {0.145, 0.083, 0.133, 0.179, 0.149, 0.064, 0.169, 0.145, 0.078, 0.234, 0.174, 0.093, 0.212, 0.162, 0.152}},
    {"maps", "HHD search, weight per channel", {0.086, 0.039, 0.08, 0.075, 0.064, 0.059, 0.154, 0.118, 0.061, 0.192, 0.137, 0.091, 0.186, 0.1, 0.113}},
    {"maps", "HHD closed form", {0.151, 0.083, 0.136, 0.181, 0.152, 0.077, 0.214, 0.153, 0.08, 0.241, 0.183, 0.098, 0.215, 0.172, 0.161}},
    {"probes", "L2, no occlusion", {0.617, 0.492, 0.383, 0.511, 0.478, 0.475, 0.495, 0.828, 0.467, 0.421, 0.415, 0.378, 0.457, 0.493, 0.506}},
    {"probes", "L2 x Gram (9 coeff.)", {0.296, 0.299, 0.108, 0.332, 0.215, 0.204, 0.148, 0.323, 0.224, 0.117, 0.086, 0.104, 0.124, 0.11, 0.211}},
    {"probes", "quadratic to linear", {0.454, 0.423, 0.256, 0.428, 0.339, 0.307, 0.276, 0.459, 0.362, 0.213, 0.157, 0.254, 0.189, 0.199, 0.324}},
    {"probes", "HLSH", {0.382, 0.361, 0.194, 0.382, 0.279, 0.258, 0.234, 0.388, 0.301, 0.172, 0.119, 0.19, 0.162, 0.158, 0.271}},
    {"probes", "quadratic to linear to HHD", {0.279, 0.268, 0.112, 0.308, 0.191, 0.179, 0.241, 0.266, 0.203, 0.162, 0.121, 0.119, 0.143, 0.141, 0.205}},
    {"sphere", "AHD sphere Gram, linear direction", {0.315, 0.132, 0.181, 0.145, 0.293, 0.244, 0.473, 0.281, 0.123, 0.364, 0.332, 0.193, 0.356, 0.336, 0.287}},
    {"sphere", "AHD sphere Gram, search", {0.325, 0.172, 0.182, 0.157, 0.291, 0.218, 0.338, 0.306, 0.16, 0.334, 0.311, 0.166, 0.328, 0.32, 0.268}},
    {"sphere", "AHD hemisphere Gram, linear direction", {0.23, 0.096, 0.171, 0.137, 0.203, 0.204, 0.469, 0.27, 0.101, 0.348, 0.31, 0.19, 0.349, 0.271, 0.26}},
    {"sphere", "AHD hemisphere Gram, search", {0.217, 0.092, 0.15, 0.136, 0.194, 0.161, 0.307, 0.255, 0.094, 0.3, 0.271, 0.127, 0.3, 0.241, 0.216}},
    {"sphere", "HHD sphere Gram, linear direction", {0.339, 0.166, 0.188, 0.17, 0.361, 0.317, 0.513, 0.283, 0.201, 0.381, 0.345, 0.183, 0.391, 0.37, 0.317}},
    {"sphere", "HHD sphere Gram, search", {0.354, 0.201, 0.205, 0.187, 0.353, 0.278, 0.428, 0.321, 0.201, 0.365, 0.338, 0.196, 0.374, 0.359, 0.308}},
    {"sphere", "HHD hemisphere Gram, linear direction", {0.231, 0.111, 0.174, 0.152, 0.241, 0.249, 0.481, 0.269, 0.138, 0.344, 0.303, 0.176, 0.365, 0.278, 0.269}},
    {"sphere", "HHD hemisphere Gram, search", {0.223, 0.102, 0.158, 0.144, 0.224, 0.186, 0.357, 0.257, 0.111, 0.311, 0.28, 0.139, 0.326, 0.254, 0.233}},
};
// clang-format on

}  // namespace

std::span<const ExpectedRow> expected_errors() { return kRows; }

}  // namespace lumel::bench
