// The lists of neighbours that cells give are those of a comparison of all with all, whatever the sizes of balls and of
// the torus.

#include "space/cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
};

class CellsTest : public testing::TestWithParam<Case> {
protected:
    static constexpr double turn = 4294967296.0;

    CellsTest() {
        const Case& c = GetParam();
        // NOLINTNEXTLINE(cert-msc51-cpp): fixed
        std::mt19937_64 random{5};
        std::uniform_real_distribution<double> unit(0, 1);
        axes_.metres_per_tick = {1 / turn, 1 / turn, 1 / turn};
        axes_.extent.fill(c.part_of_torus * turn);
        for (std::size_t k = 0; k < c.balls; ++k) {
            Ball ball;
            // Across the seam of the torus.
            for (Tick& x : ball.centre) {
                x = static_cast<Tick>(static_cast<std::int64_t>((unit(random) - 0.5) * c.part_of_torus * turn));
            }
            ball.radius = static_cast<float>(c.radius * std::pow(c.ratio_of_radii, -unit(random)));
            balls_.push_back(ball);
        }
        cells_.build(balls_.size(), axes_, [this](Index i) { return balls_[i]; });
    }

    /// Those that meet a ball, if it were larger by so much.
    std::set<Index> meeting(Index self, float larger) const {
        Ball ball = balls_[self];
        ball.radius += larger;
        std::set<Index> all;
        for (Index i = 0; i < balls_.size(); ++i) {
            if (i != self && carom::core::balls_meet(ball, balls_[i], cells_.scale())) all.insert(i);
        }
        return all;
    }

    Cells::Axes axes_;
    std::vector<Ball> balls_;
    Cells cells_;
};

void expect_between(const std::set<Index>& least, const std::set<Index>& found, const std::set<Index>& most) {
    EXPECT_TRUE(std::includes(found.begin(), found.end(), least.begin(), least.end()));
    EXPECT_TRUE(std::includes(most.begin(), most.end(), found.begin(), found.end()));
}

TEST_P(CellsTest, ListsAreThoseOfAComparisonOfAllWithAll) {
    BallSearcher searcher;
    searcher.start();
    std::size_t all = 0;
    for (std::uint32_t k = 0; k < balls_.size(); ++k) {
        std::vector<Index> found;
        std::size_t used = 0;
        cells_.find_neighbours(k, searcher, found, used);
        found.resize(used);
        const Index self = cells_.spatial_order()[k];
        const std::set<Index> set(found.begin(), found.end());
        EXPECT_EQ(set.size(), found.size());
        // Seen from a place in its cell a ball is larger by roundings of some cells: 1e-4 of the largest radius here.
        expect_between(meeting(self, 0), set, meeting(self, static_cast<float>(1e-4 * GetParam().radius)));
        all += found.size();
    }
    EXPECT_GT(all, balls_.size() / 4);
}

TEST_P(CellsTest, LateBallsAreFound) {
    BallSearcher searcher;
    searcher.start();
    for (Index i = 0; i < balls_.size(); i += 5) {
        balls_[i].centre[0] += static_cast<Tick>(GetParam().radius * turn);
        cells_.update(i, balls_[i]);
    }
    for (Index self = 0; self < balls_.size(); ++self) {
        std::vector<Index> found;
        cells_.find_meeting(balls_[self], self, searcher, found);
        EXPECT_EQ(std::set<Index>(found.begin(), found.end()), meeting(self, 0));
    }
}

TEST_P(CellsTest, TilesHaveEveryBodyOnce) {
    std::vector<Index> order = cells_.tiled_order();
    std::sort(order.begin(), order.end());
    ASSERT_EQ(order.size(), balls_.size());
    for (Index i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

INSTANTIATE_TEST_SUITE_P(Worlds, CellsTest,
                         testing::Values(Case{.name = "few_cells_round_a_torus", .radius = 0.06},
                                         Case{.name = "three_cells", .radius = 0.15, .balls = 60},
                                         Case{.name = "many_cells", .radius = 0.03, .balls = 3000},
                                         Case{.name = "many_sizes", .radius = 0.3, .ratio_of_radii = 1000},
                                         Case{.name = "a_small_part_of_the_torus",
                                              .part_of_torus = 1e-3,
                                              .radius = 6e-5,
                                              .ratio_of_radii = 3},
                                         Case{.name = "a_grid_that_repeats", .radius = 0.014, .balls = 3000}),
                         [](const auto& world) { return std::string(world.param.name); });

} // namespace
