// Based on: Iwanicki 2013, "Lighting Technology of The Last of Us" (seams by least squares over the lookups of both
// sides). Here across objects and T-junctions, on all coefficients of the master, by conjugate gradients without a
// matrix (Hestenes and Stiefel 1952), preconditioned by the diagonal.
#include "seam/blend_seams.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"

namespace lumel {
namespace {

constexpr std::size_t kMoments = 3 * (kShCoefficients + 1);                // numbers of a layer
constexpr std::size_t kNumbers = kLayerCount * kMoments;                   // of a texel
constexpr std::size_t kLanes = 8;                                          // numbers that are solved for together
constexpr std::size_t kBatchesOfLayer = (kMoments + kLanes - 1) / kLanes;  // also on threads of their own at once
constexpr std::size_t kBatches = kLayerCount * kBatchesOfLayer;
constexpr float kHeld = 10.0f;  // weight that holds a texel still, against 1 of a texel of seam
using Lanes = std::array<float, kLanes>;
using Values = std::vector<Lanes>;

// Number `n` of a texel: by layer, then moment (the irradiance last), then channel.
float& number_of(std::array<LayerMoments, kLayerCount>& layers, std::size_t n) {
    LayerMoments& layer = layers[n / kMoments];
    const std::size_t moment = n % kMoments / 3, channel = n % 3;
    return moment < kShCoefficients ? layer.sh[moment][channel] : layer.irradiance[channel];
}
float number_of(const std::array<LayerMoments, kLayerCount>& layers, std::size_t n) {
    const LayerMoments& layer = layers[n / kMoments];
    const std::size_t moment = n % kMoments / 3, channel = n % 3;
    return moment < kShCoefficients ? layer.sh[moment][channel] : layer.irradiance[channel];
}

std::uint32_t later_page(const SeamSample& s) { return std::max(s.a.page, s.b.page); }
std::uint32_t earlier_page(const SeamSample& s) { return std::min(s.a.page, s.b.page); }

}  // namespace

// What the samples of a page say: sum over entries of share * texel, plus what was remembered, is to be zero.
struct SeamBlender::Equations {
    struct Entry {
        std::uint32_t unknown;
        float share;  // of the texel in lookup a, minus that in lookup b
    };
    struct Row {
        std::uint32_t first_entry = 0;
        float weight = 0.0f;
        std::uint32_t remembered = kNone;  // index into `crossing_`
        float sign = 0.0f;                 // of what was remembered
    };
    std::vector<Row> rows;  // and one past the end
    std::vector<Entry> entries;
    std::vector<std::uint32_t> texels;                           // of each unknown: index into the lightmap
    std::array<std::vector<float>, kLayerCount> hold, diagonal;  // per unknown

    [[nodiscard]] std::size_t row_count() const { return rows.empty() ? 0 : rows.size() - 1; }
    [[nodiscard]] std::span<const Entry> entries_of(std::size_t row) const {
        return std::span(entries).subspan(rows[row].first_entry, rows[row + 1].first_entry - rows[row].first_entry);
    }
};

namespace {

template <class Equations>
class ConjugateGradients {
public:
    ConjugateGradients(const Equations& equations, std::size_t layer)
        : e_(equations),
          hold_(equations.hold[layer]),
          diagonal_(equations.diagonal[layer]),
          image_(equations.texels.size()) {}

    // Corrections of the unknowns for the given residuals of the rows. One set of steps serves all lanes, so that each
    // goes through the same map. False: cancelled.
    // `first_size`: what the tolerance is relative to; set where it is zero.
    bool solve(const Values& residuals, const SeamOptions& options, const Context& context, double& first_size,
               Values& x) {
        const std::size_t n = e_.texels.size();
        x.assign(n, Lanes{});
        Values gradient(n), direction(n);
        for (std::size_t r = 0; r < e_.row_count(); ++r) spread(r, residuals[r], -1.0f, gradient);
        double size = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            direction[i] = scaled(gradient[i], 1.0f / diagonal_[i]);
            size += product(gradient[i], direction[i]);
        }
        if (first_size == 0.0) first_size = size;
        const double small = double{options.tolerance} * double{options.tolerance} * first_size;
        for (std::uint32_t k = 0; k < options.iterations && size > small; ++k) {
            if (context.cancelled()) return false;
            multiply(direction);
            double curvature = 0.0;
            for (std::size_t i = 0; i < n; ++i) curvature += product(direction[i], image_[i]);
            if (!(curvature > 0.0)) break;
            const auto step = static_cast<float>(size / curvature);
            double next = 0.0;
            for (std::size_t i = 0; i < n; ++i) {
                add(direction[i], step, x[i]);
                add(image_[i], -step, gradient[i]);
                next += product(gradient[i], gradient[i]) / static_cast<double>(diagonal_[i]);
            }
            const auto turn = static_cast<float>(next / size);
            for (std::size_t i = 0; i < n; ++i) {
                const float inverse = 1.0f / diagonal_[i];
                for (std::size_t l = 0; l < kLanes; ++l)
                    direction[i][l] = gradient[i][l] * inverse + turn * direction[i][l];
            }
            size = next;
        }
        return true;
    }

private:
    static Lanes scaled(Lanes v, float s) {
        for (float& lane : v) lane *= s;
        return v;
    }
    static void add(const Lanes& v, float s, Lanes& to) {
        for (std::size_t l = 0; l < kLanes; ++l) to[l] += s * v[l];
    }
    static double product(const Lanes& a, const Lanes& b) {
        float sum = 0.0f;
        for (std::size_t l = 0; l < kLanes; ++l) sum += a[l] * b[l];
        return static_cast<double>(sum);
    }
    // The transpose of row r.
    void spread(std::size_t r, const Lanes& value, float sign, Values& to) const {
        for (const auto& entry : e_.entries_of(r))
            add(value, sign * e_.rows[r].weight * entry.share, to[entry.unknown]);
    }
    void multiply(const Values& v) {
        for (std::size_t i = 0; i < v.size(); ++i) image_[i] = scaled(v[i], hold_[i]);
        for (std::size_t r = 0; r < e_.row_count(); ++r) {
            Lanes sum{};
            for (const auto& entry : e_.entries_of(r)) add(v[entry.unknown], entry.share, sum);
            spread(r, sum, 1.0f, image_);
        }
    }

    const Equations& e_;
    const std::vector<float>&hold_, &diagonal_;
    Values image_;
};

// Does a channel of a layer hold light that can be: no less than none, and |R1| <= R0, which is
// l1^2 + l2^2 + l3^2 <= 3 l0^2 in the coefficients?
bool is_possible(const LayerMoments& m, std::size_t c) {
    const float l0 = m.sh[0][c], x = m.sh[1][c], y = m.sh[2][c], z = m.sh[3][c];
    constexpr float kRounding = 1.0001f;  // of vectors on the rim, as lights that are points have them
    return m.irradiance[c] >= 0.0f && l0 >= 0.0f && x * x + y * y + z * z <= 3.0f * kRounding * l0 * l0;
}

void move_channel(LayerMoments& light, const LayerMoments& from, const LayerMoments& to, std::size_t c, float share) {
    for (std::size_t k = 0; k < kShCoefficients; ++k) light.sh[k][c] = std::lerp(from.sh[k][c], to.sh[k][c], share);
    light.irradiance[c] = std::lerp(from.irradiance[c], to.irradiance[c], share);
}

// Takes each channel as far from `before` to `light` as it stays possible. False: it did not get there.
bool keep_possible(const LayerMoments& before, LayerMoments& light) {
    constexpr float kLeastShare = 1.0f / 64.0f;
    bool whole = true;
    for (std::size_t c = 0; c < 3; ++c) {
        if (is_possible(light, c)) continue;
        whole = false;
        const LayerMoments wanted = light;
        // To where neither is negative, then by halves to where the vector is valid.
        float share = 1.0f;
        const auto bound = [&](float from, float to) {
            if (to < 0.0f) share = std::min(share, from > 0.0f ? from / (from - to) : 0.0f);
        };
        bound(before.irradiance[c], wanted.irradiance[c]);
        bound(before.sh[0][c], wanted.sh[0][c]);
        share *= 0.999f;  // rounding
        for (;; share *= 0.5f) {
            if (share < kLeastShare) share = 0.0f;
            move_channel(light, before, wanted, c, share);
            if (share == 0.0f || is_possible(light, c)) break;
        }
    }
    return whole;
}

}  // namespace

SeamBlender::SeamBlender(std::vector<SeamSample> samples, const Atlas& atlas, const SeamOptions& options)
    : samples_(std::move(samples)), first_sample_(atlas.pages.size() + 1), pages_(atlas.pages), options_(options) {
    std::ranges::stable_sort(samples_, {}, later_page);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        ++first_sample_[later_page(samples_[i]) + 1];
        if (samples_[i].a.page != samples_[i].b.page) crossing_.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t p = 0; p < pages_.size(); ++p) first_sample_[p + 1] += first_sample_[p];
    remembered_.resize(crossing_.size() * kNumbers);
}

SeamBlender::Equations SeamBlender::equations_of(const Lightmap& map) const {
    Equations out;
    std::vector<std::uint32_t> unknown_of(map.texels.size(), kNone);
    const auto unknown = [&](std::uint32_t texel) {
        if (unknown_of[texel] == kNone) {
            unknown_of[texel] = static_cast<std::uint32_t>(out.texels.size());
            out.texels.push_back(texel);
        }
        return unknown_of[texel];
    };
    const auto add = [&](const SeamPoint& point, float sign) {
        lookup_at(options_.filter, point.texels)
            .for_each(map.width, map.height, [&](std::uint32_t x, std::uint32_t y, float share) {
                const std::uint32_t texel = map.texel_at[std::size_t{y} * map.width + x];
                if (texel != kNone) out.entries.push_back({unknown(texel), sign * share});
            });
    };
    for (std::size_t i = first_sample_[map.page]; i < first_sample_[map.page + 1]; ++i) {
        const SeamSample& sample = samples_[i];
        Equations::Row row{static_cast<std::uint32_t>(out.entries.size()), sample.weight};
        if (sample.a.page == map.page) add(sample.a, 1.0f);
        if (sample.b.page == map.page) add(sample.b, -1.0f);
        if (sample.a.page != sample.b.page) {
            row.remembered = static_cast<std::uint32_t>(std::ranges::lower_bound(crossing_, i) - crossing_.begin());
            row.sign = sample.a.page == map.page ? -1.0f : 1.0f;
        }
        out.rows.push_back(row);
    }
    out.rows.push_back({static_cast<std::uint32_t>(out.entries.size())});
    std::vector<float> hold, diagonal;
    for (const std::uint32_t texel : out.texels)
        hold.push_back(map.coverage[texel] == Coverage::baked ? options_.hold : options_.hold_ring);
    diagonal = hold;
    for (std::size_t r = 0; r < out.row_count(); ++r)
        for (const auto& entry : out.entries_of(r))
            diagonal[entry.unknown] += out.rows[r].weight * entry.share * entry.share;
    out.hold.fill(hold);
    out.diagonal.fill(diagonal);
    return out;
}

// One round of all batches. Sizes are those of ConjugateGradients::solve. False: cancelled.
bool SeamBlender::solve(const Equations& equations, std::span<double> first_sizes, Lightmap& map,
                        Context& context) const {
    const auto solve_batch = [&](std::size_t batch) {
        const std::size_t layer = batch / kBatchesOfLayer, lane = batch % kBatchesOfLayer * kLanes;
        const std::size_t first = layer * kMoments + lane, count = std::min(kLanes, kMoments - lane);
        Values residuals(equations.row_count());
        for (std::size_t r = 0; r < residuals.size(); ++r) {
            const Equations::Row& row = equations.rows[r];
            for (std::size_t l = 0; l < count; ++l) {
                float sum = 0.0f;
                for (const Equations::Entry& entry : equations.entries_of(r))
                    sum += entry.share * number_of(map.texels.layers[equations.texels[entry.unknown]], first + l);
                if (row.remembered != kNone) sum += row.sign * remembered_[row.remembered * kNumbers + first + l];
                residuals[r][l] = sum;
            }
        }
        Values x;
        if (!ConjugateGradients(equations, layer).solve(residuals, options_, context, first_sizes[batch], x)) return;
        for (std::size_t i = 0; i < x.size(); ++i)
            for (std::size_t l = 0; l < count; ++l)
                number_of(map.texels.layers[equations.texels[i]], first + l) += x[i][l];
    };
    for (std::size_t b = 0; b < kBatches; b += kBatchesOfLayer) {
        const bool done =
            parallel_for(context, kBatchesOfLayer, 1, [&](const ChunkRange& range) { solve_batch(b + range.begin); });
        if (!done || context.cancelled()) return false;
    }
    return true;
}

Status SeamBlender::blend(Lightmap& map, Context& context) {
    LUMEL_CHECK(map.page < pages_.size(), map.page, pages_.size());
    Equations equations = equations_of(map);
    std::array<double, kBatches> first_sizes{};
    const std::uint32_t rounds = equations.row_count() > 0 ? options_.rounds : 0;
    for (std::uint32_t round = 0; round < rounds; ++round) {
        std::vector<std::array<LayerMoments, kLayerCount>> before;
        before.reserve(equations.texels.size());
        for (const std::uint32_t texel : equations.texels) before.push_back(map.texels.layers[texel]);
        if (!solve(equations, first_sizes, map, context)) return cancelled_error();
        // Texels that cannot go where they should are held there, and the others go the rest of the way.
        std::size_t held = 0;
        for (std::size_t i = 0; i < before.size(); ++i)
            for (std::size_t l = 0; l < kLayerCount; ++l) {
                if (keep_possible(before[i][l], map.texels.layers[equations.texels[i]][l])) continue;
                ++held;
                equations.diagonal[l][i] += kHeld - equations.hold[l][i];
                equations.hold[l][i] = kHeld;
            }
        context.report("seams", static_cast<double>(round + 1) / static_cast<double>(rounds));
        if (held == 0) break;
    }
    remember(map);
    return success();
}

void SeamBlender::remember(const Lightmap& map) {
    for (std::size_t k = 0; k < crossing_.size(); ++k) {
        const SeamSample& sample = samples_[crossing_[k]];
        if (earlier_page(sample) != map.page) continue;
        const SeamPoint& point = sample.a.page == map.page ? sample.a : sample.b;
        lookup_at(options_.filter, point.texels)
            .for_each(map.width, map.height, [&](std::uint32_t x, std::uint32_t y, float share) {
                const std::uint32_t texel = map.texel_at[std::size_t{y} * map.width + x];
                if (texel == kNone) return;
                for (std::size_t n = 0; n < kNumbers; ++n)
                    remembered_[k * kNumbers + n] += share * number_of(map.texels.layers[texel], n);
            });
    }
}

}  // namespace lumel
