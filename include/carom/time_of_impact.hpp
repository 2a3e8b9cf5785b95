/// \file
/// Time of impact: when two things that move on straight lines or parabolas meet for the first time.
///
/// **Conventions of every function here.** SI units. Times are in seconds from now. A path is `p + v t + a t^2 / 2`.
/// The result is the time of the first impact in [0, horizon], or `no_impact`; the horizon may be infinite, a
/// negative one admits nothing. All arithmetic is done in double, from exact products where the input is float, with
/// + - * / and square roots only: the same bits on every machine. Input is finite (but for the horizon and the
/// bounds of a box); lengths, speeds and accelerations whose fourth powers overflow or underflow a double are
/// outside the domain. Mirroring the input in a coordinate plane gives the same bits.
///
/// **The touch rule.** The gap is the distance to the surface, less the radius: positive while the pair is apart.
/// - gap > 0: the impact is when the gap comes down to 0 with a finite approach speed; grazing is no impact.
/// - gap <= 0 and approaching, or at rest along the normal and pressed together by the acceleration: now, 0.
/// - gap <= 0 and parting: the pair parts freely. On a curved path it may come back: if it got clear (gap > 0), the
///   impact is when the gap is 0 again; if it never gets clear, when the gap is what it is now. So an overlapping
///   pair never gets deeper, and a bounce too low for the rounding of the positions still takes its full time.
/// - Neither approaching nor accelerated: no impact. A result of 0 can come with an approach speed of exactly 0
///   (pressed together at rest): such a pair has no bounce left, and it is the caller's to hold it.
///
/// Accuracy: moved to the returned time, the gap is zero to a few eps times (path length + contact distance).
#pragma once

#include <carom/base.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace carom {

/// What every time of impact returns where there is none.
inline constexpr double no_impact = std::numeric_limits<double>::infinity();

namespace detail {

// ---------------------------------------------------------------------------------------------------------------------
// Tools
// ---------------------------------------------------------------------------------------------------------------------

constexpr Vec3 wide(const Vec3& a) { return a; }
constexpr Vec3 wide(const Vector3<float>& a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

template <class T>
constexpr Vector3<T> narrow(const Vec3& a) {
    return {static_cast<T>(a.x), static_cast<T>(a.y), static_cast<T>(a.z)};
}

/// A time rounded to T; one that T cannot hold is no impact.
template <class T>
constexpr T narrow_time(double time) {
    return time <= static_cast<double>(std::numeric_limits<T>::max()) ? static_cast<T>(time)
                                                                      : static_cast<T>(no_impact);
}

constexpr double within(double time, double horizon) { return time <= horizon ? time : no_impact; }

/// Unit vector along a, or zero for the zero vector. Lengths whose squares leave the range of a double are scaled by a
/// power of two first, which rounds nothing.
inline Vec3 direction(const Vec3& a) {
    constexpr double tiny = 0x1p-480;
    constexpr double huge = 0x1p+480;
    const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    if (largest == 0) {
        return {};
    }
    if (largest < tiny) {
        const Vec3 scaled = a * 0x1p+600;
        return scaled / length(scaled);
    }
    if (largest > huge) {
        const Vec3 scaled = a * 0x1p-600;
        return scaled / length(scaled);
    }
    return a / length(a);
}

/// Real roots in ascending order; count is 0, 1 or 2.
struct QuadraticRoots {
    std::size_t count;
    std::array<double, 2> root;
};

/// Roots of `a t^2 + 2 b t + c`, in the form that cancels in neither of them. A double root counts once; a constant
/// has no roots.
inline QuadraticRoots quadratic_roots(double a, double b, double c) {
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0) || (a == 0 && b == 0)) {
        return {0, {}};
    }
    if (a == 0) {
        return {1, {-c / (2 * b)}};
    }
    if (discriminant == 0) {
        return {1, {-b / a}};
    }
    const double spread = std::sqrt(discriminant);
    if (b == 0) {
        // Neither sign may count as that of b: mirrored input would get other bits.
        const double half = spread / std::abs(a);
        return {2, {-half, half}};
    }
    const double large = b > 0 ? -b - spread : spread - b;
    const double first = large / a;
    const double second = c / large;
    return {2, {std::min(first, second), std::max(first, second)}};
}

/// Root of f between two times of which f.value is positive at `above` and not positive at `below` (in either order in
/// time): Newton's method from the secant, with bisection wherever a step leaves the bracket or fails to halve the one
/// before. The limit on the steps is never met inside the domain; it is there so that no input can hang.
template <class Function>
double root_between(const Function& f, double above, double below) {
    constexpr int most_steps = 200;
    constexpr double converged = 0x1p-53;
    constexpr double settled = 0x1p-51;
    const double value_above = f.value(above);
    if (!(value_above > 0)) {
        return above;
    }
    double step = std::abs(below - above);
    double t = above + (below - above) * (value_above / (value_above - f.value(below)));
    if (!(std::abs(t - above) < step)) {
        t = above + (below - above) / 2;
    }
    for (int i = 0; i < most_steps; ++i) {
        const double value = f.value(t);
        if (value == 0) {
            return t;
        }
        (value > 0 ? above : below) = t;
        double next = t - value / f.slope(t);
        const bool inside = next > std::min(above, below) && next < std::max(above, below);
        if (!(inside && std::abs(next - t) < step / 2)) {
            // A step this small that no longer shrinks moves in the rounding noise of f: nothing is left to gain.
            if (step <= settled * t) {
                return t;
            }
            next = above + (below - above) / 2;
        }
        step = std::abs(next - t);
        if (step <= converged * next) {
            return next;
        }
        t = next;
    }
    return below;
}

/// A point on a parabola.
struct Parabola {
    Vec3 position;
    Vec3 velocity;
    Vec3 acceleration;

    [[nodiscard]] Vec3 displacement_at(double t) const { return (velocity + acceleration * (t / 2)) * t; }
    [[nodiscard]] Vec3 position_at(double t) const { return position + displacement_at(t); }
    [[nodiscard]] Vec3 velocity_at(double t) const { return velocity + acceleration * t; }
};

/// Half the rate of change of the squared distance from the origin, d(|p|^2 / 2) / dt.
struct RadialRate {
    const Parabola& path;

    [[nodiscard]] double value(double t) const { return dot(path.position_at(t), path.velocity_at(t)); }
    [[nodiscard]] double slope(double t) const {
        return length_squared(path.velocity_at(t)) + dot(path.position_at(t), path.acceleration);
    }
};

/// Which side of a sphere around the origin a point flies on: the sign that makes the gap grow with the distance.
enum class Side : std::int8_t { outside, inside };

constexpr double sign_of(Side side) { return side == Side::outside ? 1.0 : -1.0; }

/// `side (|p|^2 - level^2)`: the gap in squares, which is smooth where the distance is not.
struct SquaredGap {
    const Parabola& path;
    double level_squared;
    Side side;

    /// Two forms of one number. From afar |p|^2 and level^2 are taken of the point where it is, else the rounding of
    /// the large distance at the start would remain. From near the start, the change since then is computed on its own,
    /// so that a hop far below the rounding of the distance itself still has the right sign.
    [[nodiscard]] double value(double t) const {
        const Vec3 moved = path.displacement_at(t);
        const double start = length_squared(path.position) - level_squared;
        const double distance_gap = side == Side::outside && start > 0
                                        ? length_squared(path.position + moved) - level_squared
                                        : start + dot(moved, path.position + path.position + moved);
        return sign_of(side) * distance_gap;
    }
    [[nodiscard]] double slope(double t) const { return 2 * sign_of(side) * RadialRate{path}.value(t); }
};

/// Whether the gap begins to fall at time t: the first derivative that is not zero decides.
inline bool begins_to_approach(const Parabola& path, Side side, double t) {
    const Vec3 p = path.position_at(t);
    const Vec3 v = path.velocity_at(t);
    const Vec3& a = path.acceleration;
    for (const double derivative : {dot(p, v), dot(v, v) + dot(p, a), dot(v, a)}) {
        if (derivative != 0) {
            return sign_of(side) * derivative < 0;
        }
    }
    return sign_of(side) * dot(a, a) < 0;
}

/// A time after which a path stays more than `reach`, and more than where it starts, away from the origin: infinite for
/// a point at rest.
inline double time_out_of_reach(const Parabola& path, double reach) {
    const double acceleration = length(path.acceleration);
    const double speed = length(path.velocity);
    const double span = 2 * length(path.position) + reach;
    return acceleration > 0 ? 2 * (speed + std::sqrt(acceleration * span)) / acceleration : span / speed;
}

/// The touch rule for the squared distance from the origin, followed along one path or along several in turn (a box).
class DistanceWalk {
public:
    /// `start_squared` is the squared distance at time 0.
    DistanceWalk(Side side, double contact_distance, double start_squared)
        : side_(side), contact_distance_(contact_distance), contact_squared_(contact_distance * contact_distance),
          level_squared_(contact_squared_) {
        if (sign_of(side) * (start_squared - contact_squared_) <= 0) {
            level_squared_ = start_squared;
        }
    }

    /// First impact on this path in [from, to]: the squared distance has at most three turning points, which lie one
    /// each between the zeros of its curvature, and it is monotonic between them.
    double first_impact(const Parabola& path, double from, double to) {
        if (gap(path).value(from) <= 0 && begins_to_approach(path, side_, from)) {
            return from;
        }
        if (to == no_impact) {
            to = std::max(from, time_out_of_reach(path, contact_distance_));
        }
        const RadialRate rate{path};
        double piece = from;
        double before = from;
        for (const double stop : curvature_stops(path, from, to)) {
            const bool rose = rate.value(before) > 0;
            if (rose != (rate.value(stop) > 0)) {
                const double turn = rose ? root_between(rate, before, stop) : root_between(rate, stop, before);
                const double hit = pass(path, piece, turn);
                if (hit <= turn) {
                    return hit;
                }
                piece = turn;
            }
            before = stop;
        }
        const double hit = pass(path, piece, to);
        const bool arrives = hit > to && gap(path).value(to) == 0 && sign_of(side_) * rate.value(to) < 0;
        return arrives ? to : hit;
    }

private:
    [[nodiscard]] SquaredGap gap(const Parabola& path) const { return {path, level_squared_, side_}; }

    /// Follows one monotonic piece: the impact in it, or no_impact and the note that the pair got clear.
    double pass(const Parabola& path, double from, double to) {
        if (gap(path).value(to) < 0) {
            return root_between(gap(path), from, to);
        }
        if (SquaredGap{path, contact_squared_, side_}.value(to) > 0) {
            level_squared_ = contact_squared_;
        }
        return no_impact;
    }

    /// The times in (from, to) where the squared distance changes its curvature, ascending, and then `to`.
    static std::array<double, 3> curvature_stops(const Parabola& path, double from, double to) {
        const QuadraticRoots zeros =
            quadratic_roots(1.5 * length_squared(path.acceleration), 1.5 * dot(path.velocity, path.acceleration),
                            length_squared(path.velocity) + dot(path.position, path.acceleration));
        std::array<double, 3> stops{to, to, to};
        std::size_t n = 0;
        for (std::size_t i = 0; i < zeros.count; ++i) {
            if (zeros.root[i] > from && zeros.root[i] < to) {
                stops[n++] = zeros.root[i];
            }
        }
        return stops;
    }

    Side side_;
    double contact_distance_;
    double contact_squared_;
    double level_squared_;
};

} // namespace detail

// ---------------------------------------------------------------------------------------------------------------------
// Plane
// ---------------------------------------------------------------------------------------------------------------------

namespace detail {

/// A body at or behind the plane, which accelerates.
inline double plane_touching(double gap, double velocity, double acceleration) {
    if (velocity < 0 || (velocity == 0 && acceleration < 0)) {
        return 0;
    }
    if (!(velocity > 0 && acceleration < 0)) {
        return no_impact;
    }
    const double discriminant = velocity * velocity - 2 * acceleration * gap;
    return (velocity + (discriminant > 0 ? std::sqrt(discriminant) : velocity)) / -acceleration;
}

inline double plane(double gap, double velocity, double acceleration, double horizon) {
    // Neither the velocity nor the acceleration, each where it points inwards, can close the gap in time. With the zero
    // first, std::min also drops the NaN of 0 times an infinite horizon.
    const double nearest =
        gap + std::min(0.0, velocity * horizon) + std::min(0.0, acceleration * (horizon / 2) * horizon);
    if (nearest > 0 || !(horizon >= 0)) {
        return no_impact;
    }
    if (acceleration == 0) {
        return velocity < 0 ? within(gap > 0 ? gap / -velocity : 0, horizon) : no_impact;
    }
    if (gap <= 0) {
        return within(plane_touching(gap, velocity, acceleration), horizon);
    }
    const double discriminant = velocity * velocity - 2 * acceleration * gap;
    if (!(discriminant > 0) || (velocity >= 0 && acceleration > 0)) {
        return no_impact;
    }
    const double root = std::sqrt(discriminant);
    return within(velocity < 0 ? 2 * gap / (root - velocity) : (velocity + root) / -acceleration, horizon);
}

} // namespace detail

/// A body and a plane.
///
/// \param gap                  distance of the centre to the surface minus the radius, m, positive outside
/// \param normal_velocity      velocity along the outward normal, m/s: positive parts
/// \param normal_acceleration  acceleration along the outward normal, m/s^2
/// \param horizon              s
///
/// First root of `g + v t + a t^2 / 2`: `2 g / (-v + sqrt(D))` for v < 0, else `(v + sqrt(D)) / -a`, with
/// `D = v^2 - 2 a g`. A gap of +infinity stands for no plane.
template <class T>
T time_to_plane(T gap, T normal_velocity, T normal_acceleration, T horizon) {
    return detail::narrow_time<T>(detail::plane(static_cast<double>(gap), static_cast<double>(normal_velocity),
                                                static_cast<double>(normal_acceleration),
                                                static_cast<double>(horizon)));
}

// ---------------------------------------------------------------------------------------------------------------------
// Sphere and sphere
// ---------------------------------------------------------------------------------------------------------------------

namespace detail {

inline double spheres_straight(const Vec3& delta, const Vec3& velocity, double contact_distance, double horizon) {
    const double closing = -dot(delta, velocity);
    if (!(closing > 0 && horizon >= 0)) {
        return no_impact;
    }
    const double contact_squared = contact_distance * contact_distance;
    const double excess = length_squared(delta) - contact_squared;
    if (excess <= 0) {
        return 0;
    }
    // The root is at least excess / (2 closing), whatever the square root below.
    if (excess > 2 * closing * horizon) {
        return no_impact;
    }
    const double discriminant = length_squared(velocity) * contact_squared - length_squared(cross(delta, velocity));
    if (!(discriminant > 0 || (discriminant == 0 && contact_distance == 0))) {
        return no_impact;
    }
    return within(excess / (closing + std::sqrt(discriminant)), horizon);
}

/// A point meets the origin only on one line with its velocity and its acceleration: a motion in one dimension.
inline double point_curved(const Parabola& path, double horizon) {
    const auto& [p, v, a] = path;
    if (cross(p, v) != Vec3{} || cross(p, a) != Vec3{} || cross(v, a) != Vec3{}) {
        return no_impact;
    }
    const Vec3 axis = direction(p == Vec3{} ? v : p);
    return plane(length(p), dot(v, axis), dot(a, axis), horizon);
}

inline double sphere_curved(const Parabola& path, Side side, double contact_distance, double horizon) {
    if (!(horizon >= 0)) {
        return no_impact;
    }
    const double farthest = (length(path.velocity) + length(path.acceleration) * (horizon / 2)) * horizon;
    const double distance_squared = length_squared(path.position);
    if (farthest < sign_of(side) * (std::sqrt(distance_squared) - contact_distance)) {
        return no_impact;
    }
    return DistanceWalk(side, contact_distance, distance_squared).first_impact(path, 0, horizon);
}

inline double spheres_curved(const Parabola& path, double contact_distance, double horizon) {
    if (path.acceleration == Vec3{}) {
        return spheres_straight(path.position, path.velocity, contact_distance, horizon);
    }
    return contact_distance == 0 ? point_curved(path, horizon)
                                 : sphere_curved(path, Side::outside, contact_distance, horizon);
}

} // namespace detail

/// Two spheres in straight relative motion, or two free bodies under the same uniform gravity, which cancels.
///
/// \param delta             centre of b minus centre of a, m
/// \param delta_velocity    velocity of b minus velocity of a, m/s
/// \param contact_distance  sum of the radii, m, >= 0; 0: two points, which meet only exactly head-on
/// \param horizon           s
///
/// The smaller root of `|d + v t| = R` as `c / (-b + sqrt(D))`, with `b = d.v < 0`, `c = |d|^2 - R^2` and
/// `D = |v|^2 R^2 - |d x v|^2`, which keeps a graze from afar accurate where `b^2 - |v|^2 c` loses all digits.
/// Coincident centres part: no impact.
template <class T>
T time_to_spheres(const Vector3<T>& delta, const Vector3<T>& delta_velocity, T contact_distance, T horizon) {
    return detail::narrow_time<T>(detail::spheres_straight(detail::wide(delta), detail::wide(delta_velocity),
                                                           static_cast<double>(contact_distance),
                                                           static_cast<double>(horizon)));
}

/// Two spheres whose relative motion is a parabola: a free body against a static or held one.
///
/// \param delta_acceleration  acceleration of b minus acceleration of a, m/s^2; zero gives the bits of the straight
/// form
///
/// The first time at which the quartic `|d + v t + a t^2 / 2|^2 - R^2` comes down to zero: bracketed between its
/// turning points and found by safeguarded Newton steps. The other parameters are those of the straight form.
template <class T>
T time_to_spheres(const Vector3<T>& delta, const Vector3<T>& delta_velocity, const Vector3<T>& delta_acceleration,
                  T contact_distance, T horizon) {
    return detail::narrow_time<T>(
        detail::spheres_curved({detail::wide(delta), detail::wide(delta_velocity), detail::wide(delta_acceleration)},
                               static_cast<double>(contact_distance), static_cast<double>(horizon)));
}

// ---------------------------------------------------------------------------------------------------------------------
// Spherical shell
// ---------------------------------------------------------------------------------------------------------------------

namespace detail {

/// The larger root of `|d + v t| = C`; near the shell `b^2 - |v|^2 c` keeps the sign of the smallest hop.
inline double shell_inside_straight(const Vec3& delta, const Vec3& velocity, double clearance, double horizon) {
    const double speed_squared = length_squared(velocity);
    if (!(speed_squared > 0 && horizon >= 0)) {
        return no_impact;
    }
    const double outward = dot(delta, velocity);
    const double excess = length_squared(delta) - clearance * clearance;
    if (excess >= 0 && outward >= 0) {
        return 0;
    }
    const double discriminant = outward * outward - speed_squared * excess;
    if (outward > 0) {
        return within(-excess / (outward + std::sqrt(discriminant)), horizon);
    }
    const bool gets_clear = discriminant > 0;
    return within(((gets_clear ? std::sqrt(discriminant) : -outward) - outward) / speed_squared, horizon);
}

inline double shell_inside(const Parabola& path, double clearance, double horizon) {
    const double room = std::max(clearance, 0.0);
    return path.acceleration == Vec3{} ? shell_inside_straight(path.position, path.velocity, room, horizon)
                                       : sphere_curved(path, Side::inside, room, horizon);
}

} // namespace detail

/// A sphere inside a hollow sphere.
///
/// \param delta_from_centre  centre of the body minus centre of the shell, m
/// \param velocity           of the body relative to the shell, m/s
/// \param acceleration       of the body relative to the shell, m/s^2
/// \param clearance          inner radius of the shell minus radius of the body, m; less than 0 counts as 0
/// \param horizon            s
///
/// The first time at which `|d + v t + a t^2 / 2|` comes up to the clearance. A body that touches the shell and moves
/// along it is pressed against it by the curvature: 0.
template <class T>
T time_to_shell_inside(const Vector3<T>& delta_from_centre, const Vector3<T>& velocity, const Vector3<T>& acceleration,
                       T clearance, T horizon) {
    return detail::narrow_time<T>(
        detail::shell_inside({detail::wide(delta_from_centre), detail::wide(velocity), detail::wide(acceleration)},
                             static_cast<double>(clearance), static_cast<double>(horizon)));
}

/// A sphere outside a solid sphere: two spheres. `contact_distance` is the sum of the radii, m; the other parameters
/// are those of time_to_shell_inside().
template <class T>
T time_to_shell_outside(const Vector3<T>& delta_from_centre, const Vector3<T>& velocity, const Vector3<T>& acceleration,
                        T contact_distance, T horizon) {
    return time_to_spheres(delta_from_centre, velocity, acceleration, contact_distance, horizon);
}

// ---------------------------------------------------------------------------------------------------------------------
// Axis-aligned box, from inside
// ---------------------------------------------------------------------------------------------------------------------

/// Time of impact with a face of a box: 0 to 5 for -x, +x, -y, +y, -z, +z, or -1 where there is no impact.
template <class T>
struct FaceImpact {
    T time = static_cast<T>(no_impact);
    int face = -1;
};

namespace detail {

constexpr std::array<double, 3> components(const Vec3& a) { return {a.x, a.y, a.z}; }

struct Bounds {
    Vec3 min;
    Vec3 max;
};

inline FaceImpact<double> box_inside(const Parabola& path, double radius, const Bounds& box, double horizon) {
    const std::array p = components(path.position);
    const std::array v = components(path.velocity);
    const std::array a = components(path.acceleration);
    const std::array low = components(box.min);
    const std::array high = components(box.max);
    FaceImpact<double> first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::array times{plane(p[axis] - low[axis] - radius, v[axis], a[axis], horizon),
                               plane(high[axis] - p[axis] - radius, -v[axis], -a[axis], horizon)};
        for (std::size_t side = 0; side < 2; ++side) {
            if (times[side] < first.time) {
                first = {times[side], static_cast<int>(2 * axis + side)};
            }
        }
    }
    return first;
}

} // namespace detail

/// A sphere inside an axis-aligned box: the first of its six faces. Of two faces met at one time the one of the lower
/// axis counts as first; the other follows at once.
///
/// \param position      of the centre, m
/// \param velocity      m/s
/// \param acceleration  m/s^2
/// \param radius        m
/// \param box_min       lower corner, m; a component of -infinity opens that face
/// \param box_max       upper corner, m; a component of +infinity opens that face
/// \param horizon       s
///
/// Each face is a plane, see time_to_plane().
template <class T>
FaceImpact<T> time_to_box_inside(const Vector3<T>& position, const Vector3<T>& velocity, const Vector3<T>& acceleration,
                                 T radius, const Vector3<T>& box_min, const Vector3<T>& box_max, T horizon) {
    const FaceImpact<double> first = detail::box_inside(
        {detail::wide(position), detail::wide(velocity), detail::wide(acceleration)}, static_cast<double>(radius),
        {detail::wide(box_min), detail::wide(box_max)}, static_cast<double>(horizon));
    return {detail::narrow_time<T>(first.time), first.face};
}

// ---------------------------------------------------------------------------------------------------------------------
// Axis-aligned box, from outside
// ---------------------------------------------------------------------------------------------------------------------

/// Time of impact with a solid box, and the unit normal out of the box at the point of contact (zero without impact).
template <class T>
struct BoxImpact {
    T time = static_cast<T>(no_impact);
    Vector3<T> normal{};
};

namespace detail {

/// Where a point is as seen from a box, axis by axis: -1 below it, 0 between its faces, +1 above it. In one such region
/// the distance to the box is the distance to one of its faces, edges or corners.
using Region = std::array<int, 3>;

inline Region region_of(const Vec3& point, const Bounds& box) {
    const std::array p = components(point);
    const std::array low = components(box.min);
    const std::array high = components(box.max);
    Region region{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        region[axis] = (p[axis] > high[axis] ? 1 : 0) - (p[axis] < low[axis] ? 1 : 0);
    }
    return region;
}

/// The path relative to the face, edge or corner of a region: without the axes along which that extends.
inline Parabola seen_from(const Region& region, const Parabola& path, const Bounds& box) {
    const auto keep = [&](double Vec3::* axis, int side) -> std::array<double, 3> {
        if (side == 0) {
            return {};
        }
        const double bound = side > 0 ? box.max.*axis : box.min.*axis;
        return {path.position.*axis - bound, path.velocity.*axis, path.acceleration.*axis};
    };
    const std::array x = keep(&Vec3::x, region[0]);
    const std::array y = keep(&Vec3::y, region[1]);
    const std::array z = keep(&Vec3::z, region[2]);
    return {{x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]}};
}

/// A face of a box seen by a point inside the box: its outward normal and how far below it the point is. Of faces
/// equally near the first in the order of FaceImpact counts.
struct DeepFace {
    Vec3 normal;
    double depth;
};

inline DeepFace nearest_face(const Vec3& point, const Bounds& box) {
    const Vec3 above_min = point - box.min;
    const Vec3 below_max = box.max - point;
    DeepFace nearest{{-1, 0, 0}, above_min.x};
    for (const DeepFace& face :
         {DeepFace{{1, 0, 0}, below_max.x}, DeepFace{{0, -1, 0}, above_min.y}, DeepFace{{0, 1, 0}, below_max.y},
          DeepFace{{0, 0, -1}, above_min.z}, DeepFace{{0, 0, 1}, below_max.z}}) {
        if (face.depth < nearest.depth) {
            nearest = face;
        }
    }
    return nearest;
}

/// Whether the box around the whole path stays clear of the box around the solid: cheap, and true for most pairs.
inline bool stays_beside(const Parabola& path, double radius, const Bounds& box, double horizon) {
    const std::array p = components(path.position);
    const std::array v = components(path.velocity);
    const std::array a = components(path.acceleration);
    const std::array low = components(box.min);
    const std::array high = components(box.max);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // With the zero first, std::min and std::max also drop the NaN of 0 times an infinite horizon.
        const double by_velocity = v[axis] * horizon;
        const double by_acceleration = a[axis] * (horizon / 2) * horizon;
        const double lowest = p[axis] + std::min(0.0, by_velocity) + std::min(0.0, by_acceleration);
        const double highest = p[axis] + std::max(0.0, by_velocity) + std::max(0.0, by_acceleration);
        if (lowest - radius > high[axis] || highest + radius < low[axis]) {
            return true;
        }
    }
    return false;
}

/// The times in (0, horizon) at which the path changes its region, ascending, and then the horizon.
class RegionChanges {
public:
    RegionChanges(const Parabola& path, const Bounds& box, double horizon) {
        const std::array p = components(path.position);
        const std::array v = components(path.velocity);
        const std::array a = components(path.acceleration);
        const std::array low = components(box.min);
        const std::array high = components(box.max);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const double bound : {low[axis], high[axis]}) {
                const QuadraticRoots crossings = quadratic_roots(a[axis] / 2, v[axis] / 2, p[axis] - bound);
                for (std::size_t i = 0; i < crossings.count; ++i) {
                    if (crossings.root[i] > 0 && crossings.root[i] < horizon) {
                        times_[count_++] = crossings.root[i];
                    }
                }
            }
        }
        std::sort(begin(), end());
        times_[count_++] = horizon;
    }
    double* begin() { return times_.data(); }
    double* end() { return times_.data() + count_; }

private:
    static constexpr std::size_t most = 13; // four crossings on each axis, and the horizon
    std::array<double, most> times_{};
    std::size_t count_ = 0;
};

inline BoxImpact<double> box_outside(const Parabola& path, double radius, const Bounds& box, double horizon) {
    if (!(horizon >= 0) || stays_beside(path, radius, box, horizon)) {
        return {};
    }
    const Vec3 start = seen_from(region_of(path.position, box), path, box).position;
    DistanceWalk walk(Side::outside, radius, length_squared(start));
    double from = 0;
    for (const double to : RegionChanges(path, box, horizon)) {
        const double sample = to == no_impact ? 2 * from + 1 : from + (to - from) / 2;
        const Region region = region_of(path.position_at(sample), box);
        if (region == Region{}) {
            // A centre inside the box is deep in the face nearest to it, as in a plane. It gets there only from a start
            // inside, or as a point without a radius, which has no gap left when it enters.
            const DeepFace face = nearest_face(path.position_at(from), box);
            const double hit =
                from > 0 ? from
                         : plane(-face.depth, dot(path.velocity, face.normal), dot(path.acceleration, face.normal), to);
            if (hit <= to) {
                return {hit, face.normal};
            }
        } else {
            const Parabola seen = seen_from(region, path, box);
            const double hit = walk.first_impact(seen, from, to);
            if (hit <= to) {
                const Vec3 away = seen.position_at(hit);
                return {hit, away == Vec3{} ? nearest_face(path.position_at(hit), box).normal : direction(away)};
            }
        }
        from = to;
    }
    return {};
}

} // namespace detail

/// A sphere and a solid axis-aligned box around which it flies: faces, edges (cylinders) and corners (spheres).
///
/// The parameters are those of time_to_box_inside(); a box with infinite bounds is a slab, a column or a half space.
/// The distance to the box is followed from region to region (face, edge, corner), in each as the distance of two
/// spheres in one, two or three dimensions. A centre inside the box counts as deep in the face nearest to it. The
/// normal points from the box to the centre.
template <class T>
BoxImpact<T> time_to_box_outside(const Vector3<T>& position, const Vector3<T>& velocity, const Vector3<T>& acceleration,
                                 T radius, const Vector3<T>& box_min, const Vector3<T>& box_max, T horizon) {
    const BoxImpact<double> first = detail::box_outside(
        {detail::wide(position), detail::wide(velocity), detail::wide(acceleration)}, static_cast<double>(radius),
        {detail::wide(box_min), detail::wide(box_max)}, static_cast<double>(horizon));
    return {detail::narrow_time<T>(first.time), detail::narrow<T>(first.normal)};
}

// ---------------------------------------------------------------------------------------------------------------------
// Surfaces without thickness: triangle, frustum
// ---------------------------------------------------------------------------------------------------------------------

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
/// A surface tells how a point sees it, and by how much (m) a neighbour that it is joined to is nearer: what a
/// neighbour hides cannot be touched.
template <class Surface>
class SurfaceMarch {
public:
    SurfaceMarch(const Surface& surface, const Parabola& path, double contact_distance, double horizon)
        : surface_(surface), path_(path), contact_distance_(contact_distance), horizon_(horizon),
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
            const bool touches = sight_.distance <= level_ || step <= settled * time_;
            if (touches && takes_touch(dot(sight_.normal, path_.velocity_at(time_)) < 0)) {
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

    [[nodiscard]] bool begins_to_approach() const {
        const double speed = dot(sight_.normal, path_.velocity);
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
        level_ = std::min(level_, sight_.distance);
        if (hidden > 0 || time_ > 0) {
            level_ -= std::max(rounding_at(p), hidden / 2);
        }
        return false;
    }

    /// m, more than the distance may be wrong.
    [[nodiscard]] double rounding_at(const Vec3& p) const { return 0x1p-50 * (length(p) + contact_distance_); }

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
            const auto halfway = surface_.sight(path_.position_at(time_ + most / 2));
            if (!(halfway.distance > contact_distance_)) {
                return false;
            }
            go_to(time_ + most / 2);
            level_ = contact_distance_;
            return true;
        }
        const double step = shell_inside(
            {sight_.normal * sight_.distance, path_.velocity_at(time_), path_.acceleration}, contact_distance_, most);
        if (!(step < most)) {
            return false;
        }
        go_to(time_ + step);
        if (sight_.distance + rounding_at(p) >= contact_distance_) {
            level_ = contact_distance_;
        }
        return true;
    }

    /// s in which the path comes nowhere nearer than the level.
    [[nodiscard]] double safe_time() const {
        const Parabola here{path_.position_at(time_), path_.velocity_at(time_), path_.acceleration};
        const double gap = sight_.distance - level_;
        const double left = horizon_ - time_;
        const double trusted = std::min(left, surface_.trusted_time(sight_, here));
        const double sag = surface_.sag(sight_, here, trusted);
        const double to_plane = sag == no_impact ? 0
                                                 : plane(gap, dot(sight_.normal, here.velocity),
                                                         dot(sight_.normal, here.acceleration) - sag, trusted);
        const double to_end = to_plane == no_impact && trusted < left ? trusted : to_plane;
        return std::max(to_end, plane(gap, -length(here.velocity), -length(here.acceleration), left));
    }

    const Surface& surface_;
    Parabola path_;
    double contact_distance_;
    double horizon_;
    double level_; ///< m, the distance that counts as a touch
    double time_ = 0;
    int clear_steps_ = 0;
    decltype(surface_.sight(Vec3{})) sight_;
};

template <class Surface>
double time_to_surface(const Surface& surface, const Parabola& path, double contact_distance, double horizon) {
    return SurfaceMarch<Surface>(surface, path, contact_distance, horizon).first_touch();
}

template <class T, class Surface>
SurfaceImpact<T> surface_impact(const Surface& surface, const Parabola& path, double radius, double horizon) {
    const double time = time_to_surface(surface, path, radius, horizon);
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
