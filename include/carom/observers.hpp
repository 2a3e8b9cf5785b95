/// \file
/// Observers: what is measured of a world while it runs, each value with its standard error.
///
/// They stream: each keeps sums only (Correlations a few earlier moments), so that a run of any length needs no
/// trajectory. Two kinds of input: ImpactStatistics and Energies look at the world after each step; all others look at
/// a Sample, the world's bodies read once for all of them, as often as the caller likes. Samples nearer than about one
/// collision per body tell little new: with one every 20th step, and pairs of bodies (RadialDistribution, Coordination)
/// every 100th, all observers together cost less than a tenth of the steps (tests/observe/cost_test.cpp). The same
/// world and the same calls give the same bits. SI units; temperatures are kT, in joules. Static bodies are left out
/// unless it says otherwise. Formulas: Allen & Tildesley, Computer Simulation of Liquids (2nd edition 2017), chapters 2
/// and 8. Bins, axes and the like that there are not are refused with Error{out_of_range}.
///
/// Each has a function `transfer(archive, self)` for whoever saves and restores it: it calls `archive.settings(...)`
/// with what it was made with, `archive(...)` with what it has gathered, and `archive.elements(list)` with lists whose
/// length the settings give. These are numbers, Vec3, arrays, optionals and lists of them, and classes with such a
/// function.
#pragma once

#include <carom/base.hpp>
#include <carom/body.hpp>
#include <carom/region.hpp>
#include <carom/world.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace carom {

namespace detail {

/// Throws Error{out_of_range} naming the index.
[[noreturn]] void refuse_index(const char* name, std::size_t index, std::size_t size);

/// An element of a list, or Error{out_of_range}.
template <class List>
const auto& element(const List& list, std::size_t index, const char* name) {
    if (index >= list.size()) refuse_index(name, index, list.size());
    return list[index];
}

} // namespace detail

/// A measured value and its standard error, in the same unit: infinite where nothing says how sure the value is.
struct Estimate {
    double value = 0;
    double standard_error = std::numeric_limits<double>::infinity();
};

/// Weighted mean of a series whose neighbours depend on each other. The standard error is that of the means of 32 to
/// 64 blocks of equally many samples; blocks grow with the series (Flyvbjerg & Petersen, J. Chem. Phys. 91, 461
/// (1989)): it is right once a block lasts longer than the correlation does.
class BlockAverage {
public:
    /// `weight` >= 0: for ratios of sums (say per body, in bins that hold a varying number of them).
    void add(double value, double weight = 1);
    [[nodiscard]] Estimate estimate() const;
    [[nodiscard]] std::uint64_t samples() const noexcept { return samples_; }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive(self.blocks_, self.block_size_, self.in_last_, self.samples_);
    }

private:
    struct Block {
        double weight = 0;
        double sum = 0; ///< of weight times value

        template <class Archive, class Self>
        static void transfer(Archive& archive, Self& self) {
            archive(self.weight, self.sum);
        }
    };
    void merge_pairs();

    std::vector<Block> blocks_; ///< the last one may be unfinished
    std::uint64_t block_size_ = 1;
    std::uint64_t in_last_ = 0;
    std::uint64_t samples_ = 0;
};

/// The bodies of a world at one moment, in the order of their ids, static ones included.
struct Sample {
    double time = 0; ///< s
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    std::vector<double> mass;
    std::vector<double> radius;
    std::optional<Box> box; ///< the world's region, where it is a box

    /// Reads the world as it is now; keeps the columns' memory from call to call.
    void read(const World& world);
};

/// Energies (J) and momentum (kg m/s) of all bodies together.
class Energies {
public:
    void observe(const World& world);
    [[nodiscard]] Estimate kinetic() const { return kinetic_.estimate(); }
    [[nodiscard]] Estimate potential() const { return potential_.estimate(); }
    [[nodiscard]] Estimate total() const { return total_.estimate(); }
    /// `axis` 0 to 2.
    [[nodiscard]] Estimate momentum(std::size_t axis) const {
        return detail::element(momentum_, axis, "axis").estimate();
    }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive(self.kinetic_, self.potential_, self.total_, self.momentum_);
    }

private:
    BlockAverage kinetic_;
    BlockAverage potential_;
    BlockAverage total_;
    std::array<BlockAverage, 3> momentum_;
};

/// Collision rate, pressure and what the walls bear, from the impacts and contacts of every step.
class ImpactStatistics {
public:
    /// Reads the radii of the world's bodies: make a new one when bodies are added or their radii change. The world
    /// must record all its impacts: Error{not_available} naming `record_impacts` or `least_recorded_impulse`.
    explicit ImpactStatistics(const World& world);

    /// To be called after each step. Error{out_of_range} naming `body` for one that came later.
    void observe(const World& world);

    /// 1/s, impacts with other bodies per body: 2 n / (N t). Its inverse is the mean free time.
    [[nodiscard]] Estimate collision_rate() const { return rate_.estimate(); }
    /// J/s, the sum of impulse times contact distance (the sum of the radii) times the square of the normal's component
    /// along `axis` (0 to 2), over all impacts between bodies, by time.
    [[nodiscard]] Estimate virial_rate(std::size_t axis) const {
        return detail::element(virial_, axis, "axis").estimate();
    }
    /// Pa, by the virial theorem: (2 K + sum over impacts of impulse times contact distance / t) / (3 V), K being the
    /// kinetic energy at the end of every 8th step and V the volume of the box. Error{not_available} naming `region`
    /// where the world is not bounded by a box.
    [[nodiscard]] Estimate pressure() const;
    /// Whether a pressure can be said: the world is bounded by a box.
    [[nodiscard]] bool has_volume() const noexcept { return volume_.has_value(); }
    /// N along the normal, the mean force on a face of the region or an obstacle (`face` as in Impact::face): by the
    /// momentum that bodies leave there in impacts, and by those that rest on it, with the force at each step's end.
    [[nodiscard]] Estimate face_force(std::size_t face) const;
    /// Faces of the region and obstacles.
    [[nodiscard]] std::size_t faces() const noexcept { return face_force_.size(); }
    /// s observed.
    [[nodiscard]] double duration() const noexcept { return duration_; }
    /// Impacts between bodies that were observed.
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive.elements(self.radius_);
        archive(self.volume_, self.bodies_, self.duration_, self.count_, self.kinetic_, self.rate_, self.pressure_,
                self.virial_);
        archive.elements(self.face_force_);
        archive.elements(self.impulse_);
    }

private:
    std::vector<double> radius_; ///< m, by slot
    std::optional<double> volume_;
    double bodies_ = 0;
    double duration_ = 0;
    std::uint64_t count_ = 0;
    double kinetic_ = 0; ///< J, when last asked for
    BlockAverage rate_;
    BlockAverage pressure_;
    std::array<BlockAverage, 3> virial_;
    std::vector<BlockAverage> face_force_;
    std::vector<double> impulse_; ///< N s, of the step in hand, by face
};

/// Speeds: histogram, moments, and how far they are from Maxwell's distribution.
class Speeds {
public:
    /// Bins of equal width from 0 to `most` m/s (> 0), at least one; faster bodies count in the moments alone.
    Speeds(double most, std::size_t bins);

    void observe(const Sample& sample);

    [[nodiscard]] std::size_t bins() const noexcept { return histogram_.size(); }
    /// m/s, the middle of a bin.
    [[nodiscard]] double speed(std::size_t bin) const;
    /// s/m, probability density of a bin.
    [[nodiscard]] Estimate density(std::size_t bin) const { return detail::element(histogram_, bin, "bin").estimate(); }
    /// (m/s)^power, the mean of |v|^power for `power` 1 to 4.
    [[nodiscard]] Estimate moment(std::size_t power) const;
    /// J, mean kinetic energy per degree of freedom, twice: the mean of m v^2 / 3.
    [[nodiscard]] Estimate temperature() const { return temperature_.estimate(); }
    /// Second Sonine coefficient (3/5) <v^4> / <v^2>^2 - 1, the mean over samples; 0 for Maxwell's distribution of
    /// equal masses (of N bodies with a given energy -2 / (3 N), to first order).
    [[nodiscard]] Estimate a2() const { return a2_.estimate(); }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive.settings(self.width_);
        archive(self.moments_, self.temperature_, self.a2_);
        archive.elements(self.histogram_);
    }

private:
    double width_;
    std::vector<BlockAverage> histogram_;
    std::vector<double> counts_;
    std::array<BlockAverage, 4> moments_;
    BlockAverage temperature_;
    BlockAverage a2_;
};

/// m: the mean distance between two impacts of a body, mean speed by collision rate.
[[nodiscard]] Estimate mean_free_path(const Speeds& speeds, const ImpactStatistics& impacts);

/// Density, temperature and mean velocity along an axis.
class Profile {
public:
    /// Slices of equal width between `low` and `high` (m) along `axis` (0 to 2), each of `area` m^2 > 0.
    Profile(std::size_t axis, double low, double high, std::size_t slices, double area);

    void observe(const Sample& sample);

    [[nodiscard]] std::size_t slices() const noexcept { return density_.size(); }
    /// m, the middle of a slice.
    [[nodiscard]] double position(std::size_t slice) const;
    /// 1/m^3, centres of bodies.
    [[nodiscard]] Estimate density(std::size_t slice) const {
        return detail::element(density_, slice, "slice").estimate();
    }
    /// J: (<m v^2> - <m> |u|^2) / 3 with the mean velocity u of the slice.
    [[nodiscard]] Estimate temperature(std::size_t slice) const;
    /// m/s along `component` (0 to 2), weighted by mass.
    [[nodiscard]] Estimate velocity(std::size_t slice, std::size_t component) const;
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive.settings(self.axis_, self.low_, self.width_, self.area_);
        for (auto* list :
             {&self.density_, &self.energy_, &self.mass_, &self.velocity_[0], &self.velocity_[1], &self.velocity_[2]})
            archive.elements(*list);
    }

private:
    struct Sums {
        double bodies = 0;
        double mass = 0;
        double energy = 0; ///< m v^2
        Vec3 momentum{};
    };

    std::size_t axis_;
    double low_;
    double width_;
    double area_;
    std::vector<Sums> sums_;
    std::vector<BlockAverage> density_;
    std::vector<BlockAverage> energy_; ///< per body
    std::vector<BlockAverage> mass_;   ///< per body
    std::array<std::vector<BlockAverage>, 3> velocity_;
};

/// Radial distribution function g(r): how many neighbours there are at a distance, by how many there would be in an
/// ideal gas of the same density. The world must be a box; across its periodic faces distances go the short way. Bodies
/// nearer than the largest distance to another face are only neighbours, so that no shell is cut off.
class RadialDistribution {
public:
    /// Shells of equal width up to `most` m (> 0).
    RadialDistribution(double most, std::size_t shells);

    /// Error{not_available} naming `region`; Error{out_of_range} naming `most` where it exceeds half a periodic side.
    void observe(const Sample& sample);

    [[nodiscard]] std::size_t shells() const noexcept { return g_.size(); }
    /// m, the middle of a shell.
    [[nodiscard]] double distance(std::size_t shell) const;
    [[nodiscard]] Estimate g(std::size_t shell) const { return detail::element(g_, shell, "shell").estimate(); }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive.settings(self.most_);
        archive.elements(self.g_);
    }

private:
    double most_;
    std::vector<double> counts_;
    std::vector<BlockAverage> g_;
};

/// Coordination number: how many others each body touches. Static bodies count as neighbours, faces do not.
class Coordination {
public:
    static constexpr std::size_t most_contacts = 16;

    /// Bodies touch whose gap is at most `gap` (>= 0) times their contact distance.
    explicit Coordination(double gap);

    void observe(const Sample& sample);

    /// Contacts per body.
    [[nodiscard]] Estimate mean() const { return mean_.estimate(); }
    /// The same without rattlers: bodies with fewer than 4 contacts.
    [[nodiscard]] Estimate mean_without_rattlers() const { return without_rattlers_.estimate(); }
    /// Share of the bodies with so many contacts (the last: or more).
    [[nodiscard]] Estimate share(std::size_t contacts) const {
        return detail::element(shares_, contacts, "contacts").estimate();
    }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive.settings(self.gap_);
        archive(self.mean_, self.without_rattlers_, self.shares_);
    }

private:
    double gap_;
    std::vector<std::uint32_t> contacts_;
    BlockAverage mean_;
    BlockAverage without_rattlers_;
    std::array<BlockAverage, most_contacts + 1> shares_;
};

/// Share of the volume of a slab that bodies fill, static ones included; a body that is partly inside counts with that
/// part of its volume.
class SlabPacking {
public:
    /// Between `low` and `high` (m) along `axis` (0 to 2), `area` m^2 > 0.
    SlabPacking(std::size_t axis, double low, double high, double area);

    void observe(const Sample& sample);
    [[nodiscard]] Estimate fraction() const { return fraction_.estimate(); }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive.settings(self.axis_, self.low_, self.high_, self.area_);
        archive(self.fraction_);
    }

private:
    std::size_t axis_;
    double low_;
    double high_;
    double area_;
    BlockAverage fraction_;
};

/// Mean squared displacement <|x(t) - x(0)|^2> and velocity autocorrelation <v(t).v(0)>, over all bodies and many
/// origins of time. Samples come at equal intervals; between two of them no body may move by half a periodic side.
class Correlations {
public:
    /// Lags of 0 to `most_lag` samples (>= 1); a new origin of time each `origin_every` samples (>= 1). Keeps
    /// most_lag / origin_every + 1 moments, 48 bytes a body each.
    Correlations(std::size_t most_lag, std::size_t origin_every);

    /// Error{size_mismatch} naming `sample` where the number of bodies has changed.
    void observe(const Sample& sample);

    [[nodiscard]] std::size_t lags() const noexcept { return displacement_.size(); }
    /// s
    [[nodiscard]] double time(std::size_t lag) const { return detail::element(time_, lag, "lag").estimate().value; }
    /// m^2
    [[nodiscard]] Estimate squared_displacement(std::size_t lag) const {
        return detail::element(displacement_, lag, "lag").estimate();
    }
    /// m^2/s^2
    [[nodiscard]] Estimate velocity_correlation(std::size_t lag) const {
        return detail::element(velocity_, lag, "lag").estimate();
    }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive.settings(self.origin_every_, self.most_origins_);
        archive(self.seen_, self.last_, self.unwrapped_, self.origins_);
        for (auto* list : {&self.time_, &self.displacement_, &self.velocity_}) archive.elements(*list);
    }

private:
    struct Origin {
        std::uint64_t sample = 0;
        double time = 0;
        std::vector<Vec3> position; ///< m, unwrapped
        std::vector<Vec3> velocity;

        template <class Archive, class Self>
        static void transfer(Archive& archive, Self& self) {
            archive(self.sample, self.time, self.position, self.velocity);
        }
    };

    void follow(const Sample& sample);
    void compare(const Origin& origin, const Sample& sample);

    std::size_t origin_every_;
    std::size_t most_origins_;
    std::uint64_t seen_ = 0;
    std::vector<Vec3> last_;      ///< m, positions of the last sample
    std::vector<Vec3> unwrapped_; ///< m
    std::vector<Origin> origins_; ///< a ring
    std::vector<BlockAverage> time_;
    std::vector<BlockAverage> displacement_;
    std::vector<BlockAverage> velocity_;
};

} // namespace carom
