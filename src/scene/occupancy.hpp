/// \file
/// Finds quickly whether a new body has room among those that are there already.
#pragma once

#include <carom/base.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace carom::scene {

/// Along which axes space repeats, and how.
struct Periods {
    Vec3 min{};    ///< m, where one copy of space begins
    Vec3 length{}; ///< m; 0 along an axis that is not periodic
};

/// Bodies in hashed cells, of one size per factor of eight in radius, so that radii of any ratio stay cheap.
/// It grows with the bodies, never with the volume.
class Occupancy {
public:
    explicit Occupancy(const Periods& periods = {}) : periods_(periods) {}

    void add(const Vec3& position, double radius);
    /// True if a body there would overlap none that was added; touching is no overlap.
    [[nodiscard]] bool is_free(const Vec3& position, double radius) const;

private:
    struct Entry {
        Vec3 position{};
        double radius = 0;
        std::uint32_t next = 0; ///< next entry in the same bucket
    };
    using Cell = std::array<std::int64_t, 3>;

    /// All bodies of one range of radii.
    class Level {
    public:
        explicit Level(double cell_size) : cell_size_(cell_size) {}
        void add(const Vec3& position, double radius);
        [[nodiscard]] bool is_free(const Vec3& position, double radius) const;

    private:
        void link(std::uint32_t index);
        void grow();
        [[nodiscard]] Cell cell_of(const Vec3& position) const;
        [[nodiscard]] std::size_t bucket_of(const Cell& cell) const;
        [[nodiscard]] bool is_free_among_all(const Vec3& position, double radius) const;
        [[nodiscard]] bool is_free_in(std::size_t bucket, const Vec3& position, double radius) const;

        double cell_size_;
        double largest_radius_ = 0;
        std::vector<Entry> entries_;
        std::vector<std::uint32_t> heads_; ///< first entry of each bucket; their number is a power of two
    };

    [[nodiscard]] bool is_free_at(const Vec3& position, double radius) const;

    Periods periods_;
    double largest_radius_ = 0;
    std::map<int, Level> levels_;
};

} // namespace carom::scene
