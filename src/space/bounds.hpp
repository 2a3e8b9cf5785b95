/// \file
/// What surrounds the bodies, in the world's own units: gaps and normals of the region's faces, periodic images, and
/// the obstacles.
#pragma once

#include "space/motion.hpp"
#include "space/obstacles.hpp"
#include "space/sum.hpp"

#include <carom/region.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace carom::core {

/// The faces and periods of a Region, in units of the resolution, and the facets of the obstacles, which are numbered
/// on from the walls.
class Bounds {
public:
    enum class Shape : std::uint8_t { flat, shell };

    /// One reflecting face. A flat face lets bodies be where normal . (x - point) < 0.
    struct Wall {
        Int3 point{};  ///< units; a point of a flat face, or the centre of the shell
        Vec3 normal{}; ///< unit vector into the face; not used by the shell
        int axis = -1; ///< 0, 1, 2 if the normal is along an axis, else -1
        Surface surface{};
        std::int32_t face = 0; ///< number in the public API
        FaceMotion motion{};
        bool is_driven = false; ///< it moves, or its surface does
        Sum travelled{};        ///< m towards the bodies, at the start of the step, without the vibration
        Sum phase{};            ///< rad, at the start of the step
        double offset = 0;      ///< m from the point towards the bodies, at the start of the step
    };

    Bounds() = default;
    /// Throws Error naming the member of the region, or the obstacle, that is refused; `origin` in units.
    Bounds(const Region& region, const std::vector<Obstacle>& obstacles, const Resolution& resolution,
           const Int3& origin);

    [[nodiscard]] Shape shape() const { return shape_; }
    [[nodiscard]] const std::vector<Wall>& walls() const { return walls_; }
    [[nodiscard]] double shell_radius() const { return shell_radius_; }

    /// Moves a wall in another way, from where it is. Throws Error naming the member of `where` that is refused.
    void set_motion(std::size_t wall, const FaceMotion& motion, const std::string& where);
    /// Throws Error naming a face that may run over another one, or leave the world, within `duration` s.
    void check_motion(double duration, const Resolution& resolution) const;
    /// A step of `duration` s begins.
    void begin_step(double duration, const Resolution& resolution);
    /// It ended after `reached` s.
    void end_step(double reached);
    [[nodiscard]] bool any_driven() const { return any_driven_; }
    /// m, at least how far any wall comes towards the bodies in `duration` s.
    [[nodiscard]] double farthest_way(double duration) const;
    /// m from the wall's point towards the bodies, `time` s after the start of the step.
    [[nodiscard]] static double offset_at(const Wall& wall, double time) {
        return wall.is_driven ? driven_offset(wall, time) : wall.offset;
    }
    /// m/s, of the wall's surface where it touches a body at `x + d` (units + m), `time` s after the start of the step.
    [[nodiscard]] static Vec3 velocity(const Wall& wall, const Int3& x, const Vec3& d, double time) {
        return wall.is_driven ? driven_velocity(wall, x, d, time) : Vec3{};
    }
    /// m/s^2
    [[nodiscard]] static Vec3 acceleration(const Wall& wall, double time);
    /// m/s, at least as fast as the wall ever comes towards the bodies.
    [[nodiscard]] static double top_speed(const Wall& wall) {
        return std::max(0.0, wall.motion.velocity) + wall.motion.amplitude * wall.motion.angular_frequency;
    }
    template <class Archive>
    void transfer_motion(Archive& archive);

    /// Null where there are none.
    [[nodiscard]] const Obstacles* obstacles() const { return obstacles_.get(); }
    [[nodiscard]] bool is_empty() const { return walls_.empty() && !obstacles_; }
    /// Walls and facets.
    [[nodiscard]] std::uint32_t size() const { return first_facet() + (obstacles_ ? obstacles_->size() : 0); }
    [[nodiscard]] std::uint32_t first_facet() const { return static_cast<std::uint32_t>(walls_.size()); }
    [[nodiscard]] bool is_facet(std::uint32_t wall) const { return wall >= first_facet(); }
    /// Whether a wall or facet, or its surface, moves.
    [[nodiscard]] bool is_driven(std::uint32_t wall) const {
        return is_facet(wall) ? obstacles_->turns(wall - first_facet()) : walls_[wall].is_driven;
    }
    /// The surface of a wall or facet.
    [[nodiscard]] const Surface& surface(std::uint32_t wall) const {
        return is_facet(wall) ? obstacles_->surface(wall - first_facet()) : walls_[wall].surface;
    }
    /// The number of the first obstacle in the public API: that of the region's faces.
    [[nodiscard]] std::int32_t first_obstacle() const { return first_obstacle_; }
    /// The number of a wall, or of the obstacle of a facet, in the public API.
    [[nodiscard]] std::int32_t face(std::uint32_t wall) const {
        if (!is_facet(wall)) return walls_[wall].face;
        return first_obstacle_ + static_cast<std::int32_t>(obstacles_->obstacle_of(wall - first_facet()));
    }
    /// How a body of `radius` at `x + d` (units + m) meets a wall or facet, `time` s after the start of the step.
    [[nodiscard]] Touch impact(std::uint32_t wall, const Int3& x, const Vec3& d, double radius, double time,
                               const Resolution& resolution) const;
    /// How one at `x` lies on it.
    [[nodiscard]] Touch contact(std::uint32_t wall, const Int3& x, double radius, double time,
                                const Resolution& resolution) const {
        return is_facet(wall) ? obstacles_->contact(wall - first_facet(), x, radius)
                              : impact(wall, x, {}, radius, time, resolution);
    }

    /// False only if a body at `x` that reaches no further than `reach` (m) along any axis cannot touch a wall or
    /// facet in the present step.
    [[nodiscard]] bool may_touch(const Int3& x, double reach, const Resolution& resolution) const {
        return may_touch_wall(x, reach, resolution) || (obstacles_ && obstacles_->may_touch(x, reach));
    }
    [[nodiscard]] bool may_touch_wall(const Int3& x, double reach, const Resolution& resolution) const {
        // A little more than rounding can change, and the tolerance that lets touching bodies come to rest.
        const double units = reach * resolution.per_metre * (1 + 1e-9) + 4;
        constexpr double far = 1.0e17;
        if (!only_axis_walls_ || !(units < far)) return true;
        const auto margin = static_cast<std::int64_t>(units);
        return (x.x - margin < low_.x) | (x.y - margin < low_.y) | (x.z - margin < low_.z) | (x.x + margin > high_.x) |
               (x.y + margin > high_.y) | (x.z + margin > high_.z);
    }

    /// Units; 0 along an axis that is not periodic.
    [[nodiscard]] std::int64_t period(int axis) const { return period_[static_cast<std::size_t>(axis)]; }
    [[nodiscard]] bool any_periodic() const { return period_[0] != 0 || period_[1] != 0 || period_[2] != 0; }
    /// Units; the lower side of a periodic axis.
    [[nodiscard]] std::int64_t period_start(int axis) const { return component(period_start_, axis); }

    /// Brings a position into the periodic box: exact.
    [[nodiscard]] Int3 wrapped(Int3 x) const;

    /// Unit vector from a body at `x + d` (units + m) into the face.
    [[nodiscard]] Vec3 normal(const Wall& wall, const Int3& x, const Vec3& d, const Resolution& resolution) const;
    /// m between the face and the surface of a body of `radius` at `x + d` (units + m), `time` s after the start of the
    /// step; negative: through the face.
    [[nodiscard]] double gap(const Wall& wall, const Int3& x, const Vec3& d, double radius, double time,
                             const Resolution& resolution) const;
    /// m from the shell's centre to a body at `x + d`.
    static Vec3 from_centre(const Wall& wall, const Int3& x, const Vec3& d, const Resolution& resolution) {
        return to_metres(x - wall.point, resolution) + d;
    }

private:
    static constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
    static constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();

    void add_box(const Box& box, const Resolution& resolution, const Int3& origin);
    void add_planes(const std::vector<Plane>& planes, const Resolution& resolution, const Int3& origin);
    void add_shell(const Shell& shell, const Resolution& resolution, const Int3& origin);

    void add_wall(Wall wall, const FaceMotion& motion);
    void narrow(const Wall& wall, double way, const Resolution& resolution);
    static double driven_offset(const Wall& wall, double time);
    static Vec3 driven_velocity(const Wall& wall, const Int3& x, const Vec3& d, double time);
    static double rest_offset(const Wall& wall);

    Shape shape_ = Shape::flat;
    bool only_axis_walls_ = true;
    bool any_driven_ = false;
    bool is_box_ = false;
    Int3 low_{lowest, lowest, lowest};     ///< units; no axis-aligned wall beyond
    Int3 high_{highest, highest, highest}; ///< units
    std::vector<Wall> walls_;
    std::shared_ptr<const Obstacles> obstacles_; ///< never changes: copies of a world share it
    std::int32_t first_obstacle_ = 0;
    std::array<std::int64_t, 3> period_{};
    Int3 period_start_{};
    double shell_radius_ = 0;
};

inline double Bounds::gap(const Wall& wall, const Int3& x, const Vec3& d, double radius, double time,
                          const Resolution& resolution) const {
    if (shape_ == Shape::shell) return (shell_radius_ - radius) - length(from_centre(wall, x, d, resolution));
    if (wall.axis >= 0) {
        const double depth = metres_between(component(x, wall.axis), component(wall.point, wall.axis), resolution) -
                             component(d, wall.axis);
        return (component(wall.normal, wall.axis) > 0 ? depth : -depth) - radius - offset_at(wall, time);
    }
    return -dot(wall.normal, to_metres(x - wall.point, resolution) + d) - radius - offset_at(wall, time);
}

template <class Archive>
void Bounds::transfer_motion(Archive& archive) {
    for (Wall& wall : walls_) {
        archive(wall.travelled, wall.phase);
        wall.offset = rest_offset(wall);
    }
}

} // namespace carom::core
