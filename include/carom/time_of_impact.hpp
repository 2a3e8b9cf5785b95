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

} // namespace carom
