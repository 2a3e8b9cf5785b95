/// \file
/// How much bodies overlap: an independent judge of the engine, which shares no code with it.
#pragma once

#include <carom/base.hpp>
#include <carom/region.hpp>
#include <carom/world.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace carom::scene {

/// What the search finds. A pair touches when the distance of its centres is at most the sum of its radii, a body and
/// a wall when the distance of centre and wall is at most the radius. Overlaps are counted in units of the smaller
/// diameter (of a wall: the body's; where the smaller is 0: the larger). Two static bodies are no pair, a static body
/// and a wall neither; nor do points touch each other or walls, as they have no size to measure an overlap by.
struct OverlapReport {
    double largest = 0;               ///< 0 where nothing touches
    double mean = 0;                  ///< over all that touches; 0 where nothing does
    std::uint64_t touching = 0;       ///< pairs and bodies with walls
    std::uint64_t bodies_outside = 0; ///< centres behind a reflecting face, a plane or the shell
};

/// Searches all pairs of many bodies, of whatever sizes, by a grid of cells per class of sizes. Keeps its memory from
/// call to call.
class OverlapSearch {
public:
    /// Region, radii and static bodies stay what they are in `world` now.
    explicit OverlapSearch(const World& world);
    /// `masses` (kg; infinite: a static body) is as long as `radii` (m).
    OverlapSearch(const Region& region, std::span<const double> radii, std::span<const double> masses);

    /// `positions` (m) in the order of the radii.
    OverlapReport find(std::span<const Vec3> positions);
    /// The bodies of `world`, which are those the search was made with.
    OverlapReport find(const World& world);

private:
    using Cell = std::array<std::int64_t, 3>;

    struct Wall {
        Vec3 point;
        Vec3 normal; ///< unit vector into the region
    };
    struct Axis {
        bool periodic = false;
        double min = 0;
        double length = 0;
    };
    struct Member {
        Vec3 position;
        double radius = 0;
        bool is_static = false;
    };
    /// Bodies of similar radii, sorted by the bucket of their cell.
    struct Level {
        double largest_radius = 0;
        double cells_per_metre = 1;
        std::uint64_t mask = 0; ///< number of buckets less one
        std::vector<std::uint32_t> bodies;
        std::vector<std::uint32_t> bucket_starts; ///< bucket b holds the members from start b to start b + 1
        std::vector<Member> members;
    };
    struct Sum {
        double largest = 0;
        double total = 0;
        std::uint64_t touching = 0;
        void add(double overlap);
    };
    /// A body that looks for partners: itself or an image of it across periodic faces.
    struct Seeker {
        const Member& member;
        const Level& level;  ///< where it looks
        std::uint32_t first; ///< the first member of the level that counts as a partner
        double reach;        ///< m, how far away the centre of a partner can be
    };

    void take_region(const Region& region);
    void take_box(const Box& box);
    void make_levels();
    void sort_into_cells(Level& level, std::span<const Vec3> positions, double extent);
    [[nodiscard]] Vec3 wrapped(Vec3 position) const;
    void find_pairs(std::size_t level_index, double extent, Sum& sum) const;
    void find_around_images(const Seeker& seeker, Vec3 image, std::size_t axis, Sum& sum) const;
    static void find_around(const Seeker& seeker, const Vec3& image, Sum& sum);
    static void look_at(const Seeker& seeker, const Vec3& image, const Member& b, const Cell& cell, Sum& sum);
    [[nodiscard]] bool find_walls(const Vec3& position, double radius, Sum& sum) const;

    std::vector<Wall> walls_;
    std::array<Axis, 3> axes_;
    std::optional<Shell> shell_;

    std::vector<double> radii_;
    std::vector<std::uint8_t> is_static_;
    std::vector<Level> levels_;                              ///< small bodies first
    std::vector<std::pair<Member, std::uint32_t>> unsorted_; ///< with their buckets
    std::vector<BodyId> ids_;
    std::vector<Vec3> positions_;
};

} // namespace carom::scene
