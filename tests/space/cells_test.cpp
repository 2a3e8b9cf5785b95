// The lists of neighbours that cells give are those of a comparison of all with all, whatever the sizes of balls and of
// the torus.

#include "space/cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace {

using carom::core::Ball;
using carom::core::BallSearcher;
using carom::core::Cells;
using carom::core::Index;
using carom::core::Tick;
using carom::core::TickScale;

struct Case {
    const char* name = "";
    double part_of_torus = 1;  ///< along each axis, where the balls lie
    double radius = 0;         ///< in parts of the torus
    double ratio_of_radii = 1; ///< largest to smallest
    std::size_t balls = 400;
    std::uint64_t seed = 5;
};

constexpr double turn = 4294967296.0;

/// Random balls, and the cells that they are sorted into. Lengths in parts of the torus.
class World {
public:
    explicit World(const Case& c) : random_(c.seed) {
        for (std::size_t k = 0; k < c.balls; ++k) {
            const auto radius = static_cast<float>(c.radius * std::pow(c.ratio_of_radii, -unit_(random_)));
            // Across the seam of the torus.
            balls.push_back({moved({}, {part(c), part(c), part(c)}), radius});
        }
        axes_.metres_per_tick.fill(1 / turn);
        axes_.extent.fill(c.part_of_torus * turn);
        build();
    }

    void build() {
        cells.build(*carom::make_serial_executor(), balls.size(), axes_, [this](Index i) { return balls[i]; });
    }

    /// For each ball another one that it touches, as far away as the comparison of ticks allows.
    void add_touching() {
        const TickScale& scale = cells.scale();
        for (std::size_t k = 0, count = balls.size(); k < count; ++k) {
            const Ball ball = balls[k];
            const std::array<double, 3> d{unit_(random_) - 0.5, unit_(random_) - 0.5, unit_(random_) - 0.5};
            const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            Ball other = ball;
            double distance = 2.000001 * static_cast<double>(ball.radius);
            do {
                const double f = distance / length;
                other.centre = moved(ball.centre, {d[0] * f, d[1] * f, d[2] * f});
                distance *= 1 - 1e-8;
            } while (!carom::core::balls_meet(ball, other, scale));
            balls.push_back(other);
        }
        build();
    }

    /// Those that meet a ball, if it were larger by so much.
    [[nodiscard]] std::set<Index> meeting(Index self, float larger) const {
        Ball ball = balls[self];
        ball.radius += larger;
        std::set<Index> all;
        for (Index i = 0; i < balls.size(); ++i) {
            if (i != self && carom::core::balls_meet(ball, balls[i], cells.scale())) all.insert(i);
        }
        return all;
    }

    std::vector<Ball> balls;
    Cells cells;

private:
    double part(const Case& c) { return (unit_(random_) - 0.5) * c.part_of_torus; }
    static std::array<Tick, 3> moved(std::array<Tick, 3> place, const std::array<double, 3>& d) {
        for (std::size_t k = 0; k < 3; ++k) place[k] += static_cast<Tick>(static_cast<std::int64_t>(d[k] * turn));
        return place;
    }

    std::mt19937_64 random_;
    std::uniform_real_distribution<double> unit_{0, 1};
    Cells::Axes axes_;
};

void expect_between(const std::set<Index>& least, const std::set<Index>& found, const std::set<Index>& most) {
    EXPECT_TRUE(std::includes(found.begin(), found.end(), least.begin(), least.end()));
    EXPECT_TRUE(std::includes(most.begin(), most.end(), found.begin(), found.end()));
}

/// Compares all lists with a comparison of all with all; returns how long they are together.
std::size_t check_lists(const World& world, double largest_radius) {
    BallSearcher searcher;
    searcher.start();
    std::size_t all = 0;
    for (std::uint32_t k = 0; k < world.balls.size(); ++k) {
        std::vector<Index> found;
        std::size_t used = 0;
        world.cells.find_neighbours(k, searcher, found, used);
        found.resize(used);
        const Index self = world.cells.spatial_order()[k];
        const std::set<Index> set(found.begin(), found.end());
        EXPECT_EQ(set.size(), found.size());
        // Seen from a place in its cell a ball is larger by roundings of some cells: 1e-4 of the largest radius here.
        expect_between(world.meeting(self, 0), set, world.meeting(self, static_cast<float>(1e-4 * largest_radius)));
        all += found.size();
    }
    return all;
}

class CellsTest : public testing::TestWithParam<Case> {};

TEST_P(CellsTest, ListsAreThoseOfAComparisonOfAllWithAll) {
    const World world(GetParam());
    EXPECT_GT(check_lists(world, GetParam().radius), world.balls.size() / 4);
}

/// Roundings decide here, and must not lose one.
TEST_P(CellsTest, WhatJustTouchesIsFound) {
    World world(GetParam());
    world.add_touching();
    EXPECT_GE(check_lists(world, GetParam().radius), world.balls.size());
}

/// Grids of few cells that repeat: balls of one cell may lie on opposite sides of the torus.
TEST(Cells, FewBallsRoundATorus) {
    std::size_t all = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const double radius = 0.05 + 0.0002 * static_cast<double>(seed);
        all += check_lists(World({.radius = radius, .balls = 10 + seed % 30, .seed = seed}), radius);
    }
    EXPECT_GT(all, 5000U);
}

TEST_P(CellsTest, LateBallsAreFound) {
    World world(GetParam());
    BallSearcher searcher;
    searcher.start();
    for (Index i = 0; i < world.balls.size(); i += 5) {
        world.balls[i].centre[0] += static_cast<Tick>(GetParam().radius * turn);
        world.cells.update(i, world.balls[i]);
    }
    for (Index self = 0; self < world.balls.size(); ++self) {
        std::vector<Index> found;
        world.cells.find_meeting(world.balls[self], self, searcher, found);
        EXPECT_EQ(std::set<Index>(found.begin(), found.end()), world.meeting(self, 0));
    }
}

TEST_P(CellsTest, TilesHaveEveryBodyOnce) {
    World world(GetParam());
    const std::span<Index> order = world.cells.take_tiled_order();
    std::sort(order.begin(), order.end());
    ASSERT_EQ(order.size(), world.balls.size());
    for (Index i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

INSTANTIATE_TEST_SUITE_P(
    Worlds, CellsTest,
    testing::Values(
        Case{.name = "some_balls_a_cell", .part_of_torus = 0.02, .radius = 1e-3, .balls = 1500},
        Case{.name = "few_cells_round_a_torus", .radius = 0.06},
        Case{.name = "three_cells", .radius = 0.15, .balls = 60},
        Case{.name = "many_cells", .radius = 0.03, .balls = 3000},
        Case{.name = "giants", .radius = 0.49, .ratio_of_radii = 1000},
        Case{.name = "many_sizes", .radius = 0.3, .ratio_of_radii = 1000},
        Case{.name = "a_small_part_of_the_torus", .part_of_torus = 1e-3, .radius = 6e-5, .ratio_of_radii = 3},
        Case{.name = "a_grid_that_repeats", .radius = 0.014, .balls = 3000}),
    [](const auto& c) { return std::string(c.param.name); });

} // namespace
