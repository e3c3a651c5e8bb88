// A rectangle of uniform radiance, lit on one side, sampled uniformly in solid angle.
// Based on: Urena, Fajardo, King 2013, "An Area-Preserving Parametrization for Spherical Rectangles".
// Differs: double precision and arc functions of our own; the solid angle as four arc tangents, which cancel less than
// the four angles of the polygon; rectangles that look small, and sheared ones, are sampled by area.
#pragma once

#include "light/planar.h"

namespace lumel {

class RectangleLight {
public:
    explicit RectangleLight(const Light& light);

    [[nodiscard]] double power() const;
    [[nodiscard]] LightBounds bounds() const;
    [[nodiscard]] bool can_be_hit() const { return true; }
    [[nodiscard]] LightSample sample(Vec3 point, Vec2 u) const;
    [[nodiscard]] LightHit intersect(Vec3 origin, Vec3 direction) const;

    // The rectangle in the frame of its edges seen from a point: x0..x1 by y0..y1 at the given height.
    struct View {
        double x0, x1, y0, y1, height;
        [[nodiscard]] double solid_angle() const;
        // The point of the rectangle for a uniform direction.
        struct Position {
            double x, y;
        };
        [[nodiscard]] Position sample(Vec2 u) const;
    };

private:
    [[nodiscard]] View view_from(Vec3 point) const;
    // Zero where the rectangle is to be sampled by area.
    [[nodiscard]] double sampled_solid_angle(const View& view) const;

    PlanarPatch patch_;
    Vec3 x_axis_, y_axis_;
    double half_width_, half_height_;
    bool right_angled_;
    Vec3 radiance_;
};

}  // namespace lumel
