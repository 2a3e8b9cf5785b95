// The vectorised searches find what the plain ones find, for every instruction set and every length of a list.

#include "same_bits/keeps_simd_target.hpp"
#include "space/simd_search.hpp"

#include <carom/base.hpp>
#include <carom/executor.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

using carom::core::BallArrays;
using carom::core::Index;
using carom::core::PackedBalls;
using carom::core::SeenBall;
using carom::core::simd_padding;
using carom::core::Tick;
using carom::core::Track;
using carom::core::TrackScale;
using Runs = std::vector<carom::core::Run>;

constexpr std::size_t count = 300;

/// Balls as one instruction set packs and searches them.
class Seen {
public:
    Seen(std::string_view target, const BallArrays& balls, const std::array<Tick, 3>& origin, const Runs& runs)
        : target_(target) {
        for (const carom::core::Run& run : runs) size_ += run.to - run.from;
        for (std::vector<float>* const array : {&x_, &y_, &z_, &radius_}) array->resize(size_ + simd_padding);
        body_.resize(size_ + simd_padding);
        carom::use_simd_target(target_);
        carom::core::ball_packing()(balls, origin, runs.data(), runs.size(),
                                    {x_.data(), y_.data(), z_.data(), radius_.data(), body_.data()});
    }

    [[nodiscard]] std::vector<float> places() const {
        std::vector<float> all;
        for (const std::vector<float>* const array : {&x_, &y_, &z_}) {
            all.insert(all.end(), array->begin(), array->begin() + static_cast<std::ptrdiff_t>(size_));
        }
        return all;
    }

    [[nodiscard]] std::vector<Index> meeting(const SeenBall& ball) const {
        // The searches only read what they are given.
        Seen copy = *this;
        const PackedBalls balls{copy.x_.data(), copy.y_.data(), copy.z_.data(), copy.radius_.data(), copy.body_.data()};
        std::vector<Index> list(size_ + simd_padding);
        carom::use_simd_target(target_);
        const Index* const end = carom::core::ball_search()(balls, size_, ball, list.data());
        list.resize(static_cast<std::size_t>(end - list.data()));
        EXPECT_EQ(copy.places(), places());
        return list;
    }

private:
    std::string target_;
    std::size_t size_ = 0;
    std::vector<float> x_;
    std::vector<float> y_;
    std::vector<float> z_;
    std::vector<float> radius_;
    std::vector<Index> body_;
};

class SimdSearch : public testing::Test {
protected:
    float within(double low, double high) {
        return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random_));
    }
    /// Near the seam of the torus.
    Tick tick() { return below(2000) - 1000; }
    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_()) % end; }

private:
    // NOLINTNEXTLINE(cert-msc51-cpp): fixed
    std::mt19937 random_{11};
};

TEST_F(SimdSearch, BallsAreFoundAlike) {
    const carom::test::KeepsSimdTarget keeps;
    std::vector<Tick> x(count + simd_padding);
    std::vector<Tick> y(count + simd_padding);
    std::vector<Tick> z(count + simd_padding);
    std::vector<float> radius(count + simd_padding);
    std::vector<Index> body(count + simd_padding);
    for (std::size_t k = 0; k < count; ++k) {
        x[k] = tick();
        y[k] = tick();
        z[k] = tick();
        radius[k] = k % 17 == 0 ? std::numeric_limits<float>::quiet_NaN() : within(0, 0.4);
        body[k] = static_cast<Index>(1000 - k);
    }
    const BallArrays arrays{x.data(), y.data(), z.data(), radius.data(), body.data(), {1e-3F, 1e-3F, 2e-3F}};
    std::size_t found = 0;
    for (std::uint32_t from = 0; from < 70; ++from) {
        const Runs runs{{from, from + from % 40}, {from + 50, from + 50}, {150, 150 + 2 * from}};
        const SeenBall ball{within(-1, 1), within(-1, 1), within(-1, 1), within(0, 0.5), body[from]};
        const std::array<Tick, 3> origin{tick(), tick(), tick()};
        const Seen expected("scalar", arrays, origin, runs);
        const std::vector<Index> expected_list = expected.meeting(ball);
        found += expected_list.size();
        for (const std::string_view target : carom::simd_targets()) {
            const Seen seen(target, arrays, origin, runs);
            EXPECT_EQ(seen.places(), expected.places()) << target << ", from " << from;
            EXPECT_EQ(seen.meeting(ball), expected_list) << target << ", from " << from;
        }
    }
    EXPECT_GT(found, 100U);
}

TEST_F(SimdSearch, TracksAreFoundAlike) {
    const carom::test::KeepsSimdTarget keeps;
    std::vector<Track> tracks(count);
    for (std::size_t k = 0; k < count; ++k) {
        tracks[k] = {.start = {tick(), tick(), tick()},
                     .reach = k % 19 == 0 ? std::numeric_limits<float>::infinity() : within(0, 0.3),
                     .speed = {within(-2, 2), within(-2, 2), within(-2, 2)},
                     .room = within(-1, 1)};
        if (k % 5 == 0) tracks[k].reach *= -1;
    }
    tracks[7].speed = {1e30F, 1e30F, -1e30F};
    const TrackScale scale{{1e-3F, 1e-3F, 2e-3F}, 1e-3F};
    std::size_t found = 0;
    for (std::size_t length = 0; length < 100; ++length) {
        std::vector<Index> list(length + simd_padding);
        for (Index& other : list) other = below(count);
        const auto search = [&](std::string_view target, std::vector<Index>& bodies, std::vector<float>& times) {
            carom::use_simd_target(target);
            bodies.assign(length + simd_padding, 0);
            times.assign(length + simd_padding, 0);
            const std::size_t hits = carom::core::track_search()(tracks.data(), scale, tracks[length], list.data(),
                                                                 length, 0.25F, 1.5F, {bodies.data(), times.data()});
            bodies.resize(hits);
            times.resize(hits);
        };
        std::vector<Index> expected;
        std::vector<float> expected_times;
        search("scalar", expected, expected_times);
        found += expected.size();
        for (const std::string_view target : carom::simd_targets()) {
            std::vector<Index> bodies;
            std::vector<float> times;
            search(target, bodies, times);
            EXPECT_EQ(bodies, expected) << target << ", " << length << " bodies";
            EXPECT_EQ(times, expected_times) << target << ", " << length << " bodies";
        }
    }
    EXPECT_GT(found, 100U);
}

TEST_F(SimdSearch, AnUnknownInstructionSetIsRefused) {
    const std::string before(carom::simd_target());
    EXPECT_THROW(carom::use_simd_target("mmx"), carom::Error);
    EXPECT_EQ(carom::simd_target(), before);
}

} // namespace
