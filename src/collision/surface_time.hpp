/// \file
/// Times of impact with surfaces without thickness, touched from both sides: triangles, and what a segment sweeps as it
/// turns round an axis.
#pragma once

#include "collision/growing_sphere.hpp"

#include <carom/time_of_impact.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom {

/// Time of impact with a surface, and the unit normal from it to the centre of the body (zero without impact).
template <class T>
struct SurfaceImpact {
    T time = static_cast<T>(no_impact);
    Vector3<T> normal{};
};

namespace detail {

/// Some unit vector square to another.
inline Vec3 square_to(const Vec3& unit) {
    const Vec3 other = std::abs(unit.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return direction(cross(unit, other));
}

/// Place of the point of a segment from a to b that is nearest to p: 0 at a, 1 at b.
inline double nearest_place(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double size = length_squared(along);
    return size > 0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0.0;
}

/// A triangle that can be touched from both sides.
class Triangle {
public:
    /// Corners by bits of a Sight.
    static constexpr unsigned face = 7;

    /// How a point sees the triangle.
    struct Sight {
        double distance = 0;     ///< m
        Vec3 normal{};           ///< unit vector from the nearest point; from a point in the triangle, its own normal
        unsigned corners = face; ///< the corners of what the nearest point lies on: the face, an edge, or a corner
    };

    Triangle() = default;
    /// The corners are not in one line.
    Triangle(const Vec3& a, const Vec3& b, const Vec3& c)
        : corners_{a, b, c}, normal_(direction(cross(b - a, c - a))) {}

    [[nodiscard]] const std::array<Vec3, 3>& corners() const { return corners_; }

    [[nodiscard]] Sight sight(const Vec3& p) const {
        bool is_above = true;
        for (std::size_t k = 0; k < 3; ++k) {
            is_above = is_above && dot(cross(normal_, along_edge(k)), p - corners_[k]) >= 0;
        }
        if (is_above) {
            const double height = dot(normal_, p - corners_[0]);
            return {std::abs(height), height < 0 ? -normal_ : normal_, face};
        }
        Sight nearest{.distance = no_impact};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const double place = nearest_place(p, corners_[k], corners_[next]);
            const Vec3 away = p - (place < 1 ? corners_[k] + along_edge(k) * place : corners_[next]);
            const double distance = length(away);
            if (distance < nearest.distance) {
                const unsigned from = place < 1 ? 1U << k : 0U;
                const unsigned to = place > 0 ? 1U << next : 0U;
                nearest = {distance, distance > 0 ? away / distance : normal_, from | to};
            }
        }
        return nearest;
    }

    /// m/s^2, how the distance of a point changes as it goes straight on at v: along an edge only what is square to it
    /// counts.
    [[nodiscard]] double bending(const Sight& sight, const Vec3& v) const {
        if (sight.corners == face || sight.distance == 0) {
            return 0;
        }
        const double approach = dot(v, sight.normal);
        double across = length_squared(v) - approach * approach;
        for (std::size_t k = 0; k < 3; ++k) {
            if (sight.corners == (1U << k | 1U << (k + 1) % 3)) {
                const double along = dot(v, direction(along_edge(k)));
                across -= along * along;
            }
        }
        return std::max(0.0, across) / sight.distance;
    }

    /// The plane through the nearest point, square to the normal, has the whole triangle behind it.
    static double sag(const Sight& /*sight*/, const Parabola& /*path*/, double /*duration*/) { return 0; }
    static double trusted_time(const Sight& /*sight*/, const Parabola& /*path*/) { return no_impact; }
    static double hidden_by(const Sight& /*sight*/, const Vec3& /*p*/) { return 0; }

private:
    [[nodiscard]] Vec3 along_edge(std::size_t k) const { return corners_[(k + 1) % 3] - corners_[k]; }

    std::array<Vec3, 3> corners_{};
    Vec3 normal_{};
};

/// What a segment sweeps as it turns round an axis: the wall of a cylinder, of a cone, or a disc, touched from both
/// sides. In the half plane of the distance from the axis (rho) and the height along it, it is the segment.
class Frustum {
public:
    struct Sight {
        double distance = 0; ///< m
        Vec3 normal{};       ///< unit vector from the nearest point; all round the axis, along it
        double rho = 0;      ///< m from the axis
        Vec3 outward{};      ///< unit vector from the axis
        double slant = 0;    ///< the normal along `outward`
        bool is_rim = false;
    };

    Frustum() = default;
    /// `axis` is a unit vector, the height is >= 0, and the two circles are not one.
    Frustum(const Vec3& base, const Vec3& axis, double height, double base_radius, double top_radius)
        : base_(base), axis_(axis), height_(height), base_radius_(base_radius), top_radius_(top_radius),
          length_(std::sqrt(height * height + (top_radius - base_radius) * (top_radius - base_radius))) {}

    [[nodiscard]] Sight sight(const Vec3& p) const {
        const Vec3 from_base = p - base_;
        const double z = dot(from_base, axis_);
        const Vec3 across = from_base - axis_ * z;
        Sight sight{.rho = length(across)};
        sight.outward = sight.rho > 0 ? across / sight.rho : square_to(axis_);
        const double widening = (top_radius_ - base_radius_) / length_;
        const double rise = height_ / length_;
        const double along = (sight.rho - base_radius_) * widening + z * rise;
        double upward = 0;
        if (along >= 0 && along <= length_) {
            const double off = (sight.rho - base_radius_) * rise - z * widening;
            sight.distance = std::abs(off);
            sight.slant = off < 0 ? -rise : rise;
            upward = off < 0 ? widening : -widening;
        } else {
            const double off = sight.rho - (along < 0 ? base_radius_ : top_radius_);
            const double above = z - (along < 0 ? 0 : height_);
            sight.is_rim = true;
            sight.distance = std::sqrt(off * off + above * above);
            sight.slant = off / sight.distance;
            upward = above / sight.distance;
        }
        // On the axis the surface is equally near all round: what it does there together is along the axis.
        const bool all_round = sight.rho == 0 && upward != 0;
        sight.normal = all_round ? axis_ * (upward > 0 ? 1.0 : -1.0) : sight.outward * sight.slant + axis_ * upward;
        return sight;
    }

    /// m/s^2, how the distance of a point changes as it goes straight on at v: it turns round the axis, and round a
    /// rim.
    [[nodiscard]] double bending(const Sight& sight, const Vec3& v) const {
        const double up = dot(v, axis_);
        const double out = dot(v, sight.outward);
        const double round_squared = std::max(0.0, length_squared(v) - up * up - out * out);
        double bending = sight.rho > 0 ? sight.slant * round_squared / sight.rho : 0;
        if (sight.is_rim && sight.distance > 0) {
            const double approach = dot(v, sight.normal);
            bending += std::max(0.0, up * up + out * out - approach * approach) / sight.distance;
        }
        return bending;
    }

    /// Seen from inside, the surface bends round the path: with y across the axis, rho <= rho_0 + y_out + y^2 / 2 rho_0
    /// at any distance, and the distance to a segment is convex. m/s^2, for a path of at most `duration` s.
    [[nodiscard]] double sag(const Sight& sight, const Parabola& path, double duration) const {
        if (sight.slant >= 0) {
            return 0;
        }
        const double acceleration = across(path.acceleration);
        const double speed = across(path.velocity) + (acceleration > 0 ? acceleration * (duration / 2) : 0);
        return sight.rho > 0 ? -sight.slant * speed * speed / sight.rho : no_impact;
    }
    /// s for which the sag is not much more than it must be.
    [[nodiscard]] double trusted_time(const Sight& sight, const Parabola& path) const {
        const double acceleration = across(path.acceleration);
        if (sight.slant >= 0 || acceleration == 0) {
            return no_impact;
        }
        const double speed = across(path.velocity);
        return (speed + std::sqrt(speed * speed + 2 * acceleration * sight.rho)) / acceleration;
    }
    static double hidden_by(const Sight& /*sight*/, const Vec3& /*p*/) { return 0; }

    /// The nearest point to p of the segment where it is, turned by a third of the circle `thirds` times from p's side.
    [[nodiscard]] Vec3 nearest_on_meridian(const Vec3& p, int thirds) const {
        constexpr double half_root_of_three = 0.8660254037844386;
        const Vec3 outward = sight(p).outward;
        const Vec3 turned =
            outward * -0.5 + cross(axis_, outward) * (thirds == 1 ? half_root_of_three : -half_root_of_three);
        const Vec3 side = thirds == 0 ? outward : turned;
        const Vec3 a = base_ + side * base_radius_;
        const Vec3 b = base_ + axis_ * height_ + side * top_radius_;
        const double place = nearest_place(p, a, b);
        return place < 1 ? a + (b - a) * place : b;
    }

private:
    [[nodiscard]] double across(const Vec3& v) const { return length(v - axis_ * dot(v, axis_)); }

    Vec3 base_{};
    Vec3 axis_{0, 0, 1};
    double height_ = 1;
    double base_radius_ = 1;
    double top_radius_ = 1;
    double length_ = 1;
};

/// The touch rule for the distance from a surface: a march along the path, each step to where it can touch at the
/// earliest. That is where it crosses the plane that touches a ball around the point it has reached and has the whole
/// surface behind it; for a surface that bends round the path, the plane comes towards it. Or where a path straight to
/// the surface would end, if that is later. Both never pass the first touch, and the planes close in on it like
/// Newton's method.
///
/// The distance at which the two touch may grow, at a constant rate of any sign: then the planes come towards the path
/// by as much.
///
/// A surface tells how a point sees it, and by how much (m) a neighbour that it is joined to is nearer: what a
/// neighbour hides cannot be touched.
template <class Surface>
class SurfaceMarch {
public:
    SurfaceMarch(const Surface& surface, const Parabola& path, double contact_distance, double growth, double horizon)
        : surface_(surface), path_(path), contact_distance_(contact_distance), growth_(growth), horizon_(horizon),
          level_(contact_distance), sight_(surface.sight(path.position)) {}

    double first_touch() {
        // Never met: each step brings the path nearer by a part of what is left, whatever the surface.
        constexpr int most_steps = 10'000;
        constexpr double settled = 0x1p-52;
        if (!(horizon_ >= 0)) {
            return no_impact;
        }
        if (sight_.distance <= contact_distance_ && takes_touch(begins_to_approach())) {
            return 0;
        }
        for (int i = 0; i < most_steps; ++i) {
            const double step = safe_time();
            if (level_ < contact_distance_ && gets_clear(std::min(step, horizon_ - time_))) {
                continue;
            }
            if (!(step <= horizon_ - time_)) {
                return no_impact;
            }
            go_to(time_ + step);
            const bool touches = sight_.distance <= level_ + grown() || step <= settled * time_;
            if (touches && takes_touch(dot(sight_.normal, path_.velocity_at(time_)) < growth_)) {
                return time_;
            }
        }
        return time_;
    }

private:
    void go_to(double time) {
        time_ = time;
        sight_ = surface_.sight(path_.position_at(time));
    }

    /// m, by how much all distances at which something counts as a touch have grown.
    [[nodiscard]] double grown() const { return growth_ * time_; }

    [[nodiscard]] bool begins_to_approach() const {
        const double speed = dot(sight_.normal, path_.velocity) - growth_;
        return speed < 0 ||
               (speed == 0 && dot(sight_.normal, path_.acceleration) + surface_.bending(sight_, path_.velocity) < 0);
    }

    /// Whether a touch counts; if not, what is to count from now on is a deeper one.
    bool takes_touch(bool approaches) {
        const Vec3 p = path_.position_at(time_);
        const double hidden = surface_.hidden_by(sight_, p);
        if (approaches && hidden == 0) {
            return true;
        }
        level_ = std::min(level_, sight_.distance - grown());
        if (hidden > 0 || time_ > 0) {
            level_ -= std::max(rounding_at(p), hidden / 2);
        }
        return false;
    }

    /// m, more than the distance may be wrong.
    [[nodiscard]] double rounding_at(const Vec3& p) const {
        return 0x1p-50 * (length(p) + contact_distance_ + grown());
    }

    /// Of a path that began in touch, and parted: goes on to where it can get clear at the earliest, if that is within
    /// `most` s. The distance is nowhere more than that from the point that is nearest now. A path along the surface
    /// gets little further by that: whether it is clear halfway, where a hop is highest, has to do then.
    bool gets_clear(double most) {
        constexpr int few = 32;
        const Vec3 p = path_.position_at(time_);
        if (clear_steps_++ >= few) {
            if (most == no_impact) {
                return false;
            }
            const double halfway = time_ + most / 2;
            const double contact = contact_distance_ + growth_ * halfway;
            if (!(surface_.sight(path_.position_at(halfway)).distance > contact)) {
                return false;
            }
            go_to(halfway);
            level_ = contact_distance_;
            return true;
        }
        const Parabola around{sight_.normal * sight_.distance, path_.velocity_at(time_), path_.acceleration};
        const double contact = contact_distance_ + grown();
        const double step = growth_ == 0 ? shell_inside(around, contact, most)
                                         : time_to_shell_growing(around.position, around.velocity, around.acceleration,
                                                                 contact, -growth_, most);
        if (!(step < most)) {
            return false;
        }
        go_to(time_ + step);
        if (sight_.distance + rounding_at(p) >= contact_distance_ + grown()) {
            level_ = contact_distance_;
        }
        return true;
    }

    /// s in which the path comes nowhere nearer than the level.
    [[nodiscard]] double safe_time() const {
        const Parabola here{path_.position_at(time_), path_.velocity_at(time_), path_.acceleration};
        const double gap = sight_.distance - (level_ + grown());
        const double left = horizon_ - time_;
        const double trusted = std::min(left, surface_.trusted_time(sight_, here));
        const double sag = surface_.sag(sight_, here, trusted);
        const double to_plane = sag == no_impact ? 0
                                                 : plane(gap, dot(sight_.normal, here.velocity) - growth_,
                                                         dot(sight_.normal, here.acceleration) - sag, trusted);
        const double to_end = to_plane == no_impact && trusted < left ? trusted : to_plane;
        return std::max(to_end, plane(gap, -length(here.velocity) - growth_, -length(here.acceleration), left));
    }

    const Surface& surface_;
    Parabola path_;
    double contact_distance_; ///< m, at first
    double growth_;           ///< m/s
    double horizon_;
    double level_; ///< m, the distance that counts as a touch, less what it has grown by
    double time_ = 0;
    int clear_steps_ = 0;
    decltype(surface_.sight(Vec3{})) sight_;
};

/// The horizon is finite where there is growth (m/s), and the contact distance (m) stays positive up to it.
template <class Surface>
double time_to_surface(const Surface& surface, const Parabola& path, double contact_distance, double growth,
                       double horizon) {
    return SurfaceMarch<Surface>(surface, path, contact_distance, growth, horizon).first_touch();
}

template <class T, class Surface>
SurfaceImpact<T> surface_impact(const Surface& surface, const Parabola& path, double radius, double horizon) {
    const double time = time_to_surface(surface, path, radius, 0, horizon);
    if (time == no_impact) {
        return {};
    }
    return {narrow_time<T>(time), narrow<T>(surface.sight(path.position_at(time)).normal)};
}

} // namespace detail

/// A sphere and a triangle without thickness, from either side: its face, its edges and its corners.
///
/// \param position      of the centre, m
/// \param velocity      m/s
/// \param acceleration  m/s^2
/// \param radius        m, > 0: a point has no side to bounce back to
/// \param a             m, a corner; the three are not in one line
/// \param horizon       s
///
/// The first time at which the distance of the centre from the triangle comes down to the radius. The distance from a
/// convex set lies nowhere below its tangent plane, and the path crosses that plane at the root of a quadratic: the
/// first such crossing is the impact if it is with the face, and else a step nearer to it.
template <class T>
SurfaceImpact<T> time_to_triangle(const Vector3<T>& position, const Vector3<T>& velocity,
                                  const Vector3<T>& acceleration, T radius, const Vector3<T>& a, const Vector3<T>& b,
                                  const Vector3<T>& c, T horizon) {
    return detail::surface_impact<T>(detail::Triangle(detail::wide(a), detail::wide(b), detail::wide(c)),
                                     {detail::wide(position), detail::wide(velocity), detail::wide(acceleration)},
                                     static_cast<double>(radius), static_cast<double>(horizon));
}

/// A sphere and a frustum without thickness, from either side, its rims included.
///
/// \param base         m, the centre of the base
/// \param axis         any length but zero; only the direction counts
/// \param height       m along the axis, >= 0; 0: a disc, or a ring
/// \param base_radius  m, >= 0
/// \param top_radius   m, >= 0; the base's: a cylinder, 0: a cone. Both circles are not one.
///
/// The other parameters and the method are those of time_to_triangle(). A centre on the axis touches all round: the
/// normal is along the axis.
template <class T>
// NOLINTNEXTLINE(readability-function-size): a motion and a frustum have so many parameters.
SurfaceImpact<T> time_to_frustum(const Vector3<T>& position, const Vector3<T>& velocity, const Vector3<T>& acceleration,
                                 T radius, const Vector3<T>& base, const Vector3<T>& axis, T height, T base_radius,
                                 T top_radius, T horizon) {
    return detail::surface_impact<T>(detail::Frustum(detail::wide(base), detail::direction(detail::wide(axis)),
                                                     static_cast<double>(height), static_cast<double>(base_radius),
                                                     static_cast<double>(top_radius)),
                                     {detail::wide(position), detail::wide(velocity), detail::wide(acceleration)},
                                     static_cast<double>(radius), static_cast<double>(horizon));
}

} // namespace carom
