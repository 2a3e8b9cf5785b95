/// \file
/// The obstacles in the world's own units: which are near a body, and how it touches them.
///
/// They consist of *facets*, numbered through all obstacles: of a mesh its triangles, of a frustum three that are one
/// surface. A body meets the first of these; lying in a cone or a narrow tube, it touches all three, a third of the
/// circle apart.
#pragma once

#include "collision/surface_time.hpp"
#include "space/motion.hpp"

#include <carom/region.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>
#include <vector>

namespace carom::core {

/// How a body touches something.
struct Touch {
    double gap = std::numeric_limits<double>::infinity(); ///< m between the two; infinite where they cannot touch
    Vec3 normal{};                                        ///< unit vector from the body into the other
};

class Obstacles {
public:
    /// Throws Error naming the obstacle and its member that is refused; `origin` in units.
    Obstacles(const std::vector<Obstacle>& obstacles, const Resolution& resolution, const Int3& origin);

    /// Facets.
    [[nodiscard]] std::uint32_t size() const { return facets_; }
    /// The obstacle that a facet belongs to.
    [[nodiscard]] std::uint32_t obstacle_of(std::uint32_t facet) const {
        return static_cast<std::uint32_t>(std::upper_bound(firsts_.begin(), firsts_.end(), facet) - firsts_.begin()) -
               1;
    }
    [[nodiscard]] const Surface& surface(std::uint32_t facet) const { return solids_[obstacle_of(facet)].surface; }
    /// Whether the surface of any obstacle moves, or that of a facet.
    [[nodiscard]] bool any_turns() const { return any_turns_; }
    [[nodiscard]] bool turns(std::uint32_t facet) const { return solids_[obstacle_of(facet)].spin != Vec3{}; }
    /// m/s, of a facet where a body of `radius` at `x + d` (units + m) touches it: along it.
    [[nodiscard]] Vec3 surface_velocity(std::uint32_t facet, const Int3& x, const Vec3& d, double radius,
                                        const Vec3& normal) const;

    /// m, the distance at which a body of `radius` touches: a smaller one would be rounded through a surface.
    [[nodiscard]] double contact_distance(double radius) const {
        return std::max(radius, smallest * resolution_.metres);
    }
    /// m/s, how that distance grows with a body of `radius` in the next `duration` s: one too small is not rounded
    /// through a surface as it shrinks, either.
    [[nodiscard]] double contact_growth(double radius, double growth, double duration) const {
        const double then = radius + growth * duration;
        if (std::min(radius, then) >= smallest * resolution_.metres) return growth;
        return (contact_distance(then) - contact_distance(radius)) / duration;
    }
    /// s until the centre of a body at x first comes so near to a facet (m), which grows (m/s); see time_of_impact.hpp.
    [[nodiscard]] double time_to(std::uint32_t facet, const Int3& x, const Vec3& v, const Vec3& a, double distance,
                                 double growth, double horizon) const;
    /// How a body of `radius` at `x + d` (units + m) meets a facet.
    [[nodiscard]] Touch impact(std::uint32_t facet, const Int3& x, const Vec3& d, double radius) const;
    /// How it lies there: as impact(), but three times on a frustum, and only on the facets whose nearest points are
    /// the nearest of their neighbourhood.
    [[nodiscard]] Touch contact(std::uint32_t facet, const Int3& x, double radius) const;
    /// 1/m, of the path of a body that goes along a facet with velocity v: positive where it presses the body on.
    [[nodiscard]] double bend(std::uint32_t facet, const Int3& x, const Vec3& d, const Vec3& v) const;

    /// False only if nothing is nearer to x than `reach` (m).
    [[nodiscard]] bool may_touch(const Int3& x, double reach) const;
    /// m from x to the nearest facet, or `most` if that is less.
    [[nodiscard]] double distance(const Int3& x, double most) const;
    /// Calls f(facet) for all facets that a body may meet and that are nearer to x than `reach` (m).
    template <class F>
    void for_each_near(const Int3& x, double reach, F&& f) const {
        const double most = reach_with_margin(reach);
        for_each_leaf(x, most, [&](std::uint32_t facet) {
            if (distance_to(facet, x) < most) f(facet);
        });
    }
    /// Calls f(facet) for all facets on which a body may lie and that are nearer to x than `reach` (m).
    template <class F>
    void for_each_contact(const Int3& x, double reach, F&& f) const {
        for_each_near(x, reach, [&](std::uint32_t facet) {
            f(facet);
            if (is_mesh(facet)) return;
            for (std::uint32_t k = 1; k < meridians; ++k) f(facet + k);
        });
    }

private:
    static constexpr std::uint32_t meridians = 3;
    static constexpr double smallest = 16; ///< units

    /// Triangles, and which of them meet at a corner.
    struct Surfaces {
        std::vector<detail::Triangle> triangles;
        std::vector<std::array<std::uint32_t, 3>> corners; ///< of one place all the same
        std::vector<std::uint32_t> first_at;               ///< per corner: in `at_corner`
        std::vector<std::uint32_t> at_corner;              ///< triangles

        void join();
        [[nodiscard]] std::span<const std::uint32_t> triangles_at(std::uint32_t corner) const {
            return std::span(at_corner).subspan(first_at[corner], first_at[corner + 1] - first_at[corner]);
        }
        template <class F>
        void for_each_neighbour(std::uint32_t triangle, unsigned shared, F&& f) const;
        [[nodiscard]] bool is_hidden(std::uint32_t triangle, const detail::Triangle::Sight& sight, const Vec3& p) const;
    };
    /// One triangle for the march of time_of_impact.hpp, among its neighbours.
    struct Facet;
    /// An obstacle: what it is made of, in metres from its anchor.
    struct Solid {
        Int3 anchor{};           ///< units
        std::uint32_t first = 0; ///< facet
        Surface surface{};
        Vec3 spin{}; ///< rad/s, round an axis through the anchor
        std::variant<detail::Frustum, Surfaces> shape{};
    };
    /// Of the tree of boxes, in the order of a walk: the first child follows its parent.
    struct Node {
        Int3 low{};              ///< units
        Int3 high{};             ///< units
        std::uint32_t other = 0; ///< the second child; of a leaf, the first item
        std::uint32_t items = 0; ///< 0: no leaf
    };
    struct Item {
        Int3 low{};
        Int3 high{};
        std::uint32_t facet = 0;
    };

    void add(const Frustum& frustum, const std::string& name, const Int3& origin, std::vector<Item>& items);
    void add(const Mesh& mesh, const std::string& name, const Int3& origin, std::vector<Item>& items);
    [[nodiscard]] Item box_of(const Int3& anchor, const Vec3& low, const Vec3& high) const;
    void build(std::span<Item> items);

    [[nodiscard]] bool is_mesh(std::uint32_t facet) const { return solids_[obstacle_of(facet)].shape.index() == 1; }
    [[nodiscard]] Vec3 place_in(const Solid& solid, const Int3& x, const Vec3& d) const {
        return to_metres(x - solid.anchor, resolution_) + d;
    }
    [[nodiscard]] double distance_to(std::uint32_t facet, const Int3& x) const;
    /// m: rounded bodies touch already, and the smallest from further away.
    [[nodiscard]] double reach_with_margin(double reach) const { return reach + 2 * smallest * resolution_.metres; }

    /// Calls f(facet) for the leaves whose boxes are nearer to x than `reach` (m), which f may make less.
    template <class F>
    void for_each_leaf(const Int3& x, const double& reach, F&& f) const;

    Resolution resolution_{};
    std::uint32_t facets_ = 0;
    bool any_turns_ = false;
    std::vector<std::uint32_t> firsts_; ///< facet of each obstacle
    std::vector<Solid> solids_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_; ///< facets, in the order of the tree
};

template <class F>
void Obstacles::for_each_leaf(const Int3& x, const double& reach, F&& f) const {
    constexpr std::size_t deepest = 64;
    std::array<std::uint32_t, deepest> waiting{};
    std::size_t count = nodes_.empty() ? 0 : 1;
    while (count > 0) {
        const std::uint32_t at = waiting[--count];
        const Node& node = nodes_[at];
        // A little more than rounding can change.
        const double units = reach * resolution_.per_metre * (1 + 1e-9) + 4;
        constexpr double far = 1.0e17;
        if (units < far) {
            const auto margin = static_cast<std::int64_t>(units);
            const bool is_beside = (x.x + margin < node.low.x) | (x.x - margin > node.high.x) |
                                   (x.y + margin < node.low.y) | (x.y - margin > node.high.y) |
                                   (x.z + margin < node.low.z) | (x.z - margin > node.high.z);
            if (is_beside) continue;
        }
        for (std::uint32_t k = 0; k < node.items; ++k) f(leaves_[node.other + k]);
        if (node.items > 0) continue;
        waiting[count++] = node.other;
        waiting[count++] = at + 1;
    }
}

} // namespace carom::core
