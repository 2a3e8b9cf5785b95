#include "scene/observation_reader.hpp"

#include "collision/component.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace carom::scene {

namespace {

using detail::component;

constexpr std::uint64_t most_bins = 1'000'000;
constexpr std::array<std::string_view, 3> axis_names{"x", "y", "z"};

/// Steps from sample to sample where the scene does not say it: nearer ones tell little new, and pairs of bodies cost
/// more.
constexpr std::uint64_t usual_interval = 50;
constexpr std::uint64_t usual_interval_of_pairs = 200;

class ObservationReader {
public:
    ObservationReader(TableReader& table, const Scene& scene)
        : table_(table), scene_(scene), box_(std::get_if<Box>(&scene.options.region)) {}

    Observation read() {
        const std::size_t kind = table_.need("kind").choice(observer_names);
        Observation observation{.name = std::string(observer_names.at(kind)), .observer = observer_of(kind)};
        read_name(observation);
        table_.read("from", observation.from, not_negative);
        const bool of_pairs = std::holds_alternative<RadialDistribution>(observation.observer) ||
                              std::holds_alternative<Coordination>(observation.observer);
        observation.every = of_pairs ? usual_interval_of_pairs : usual_interval;
        if (const auto every = table_.find("every")) observation.every = steps_of(*every);
        table_.finish();
        return observation;
    }

private:
    Observer observer_of(std::size_t kind) {
        switch (kind) {
        case 0:
            return Energies{};
        case 1:
            check_impacts();
            return ImpactObserver{};
        case 2:
            return Speeds{table_.need("most").number(positive), count("bins", 50)};
        case 3: {
            const std::size_t axis = read_axis();
            const auto [low, high] = read_interval(axis);
            return Profile{axis, low, high, count("slices", 20), read_area(axis)};
        }
        case 4:
            return RadialDistribution{read_reach(), count("shells", 100)};
        case 5: {
            double gap = 1e-4;
            table_.read("gap", gap, not_negative);
            return Coordination{gap};
        }
        case 6: {
            const std::size_t axis = read_axis();
            const auto [low, high] = read_interval(axis);
            return SlabPacking{axis, low, high, read_area(axis)};
        }
        default:
            return Correlations{count("lags", 100), count("origin_every", 10)};
        }
    }

    void check_impacts() const {
        if (scene_.options.least_recorded_impulse > 0) {
            table_.fail("kind", "needs all impacts, and output.least_recorded_impulse leaves out weak ones");
        }
        const std::vector<double>& growth = scene_.bodies.growth;
        if (std::any_of(growth.begin(), growth.end(), [](double rate) { return rate != 0; })) {
            table_.fail("kind", "must not be impacts where bodies grow");
        }
    }

    std::size_t count(std::string_view key, std::size_t usual) {
        const auto value = table_.find(key);
        return value ? static_cast<std::size_t>(value->count(1, most_bins)) : usual;
    }

    std::size_t read_axis() { return table_.need("axis").choice(axis_names); }

    struct Interval {
        double low;
        double high;
    };
    /// From face to face where the region is a box, if the file does not say it.
    Interval read_interval(std::size_t axis) {
        const auto low = table_.find("low");
        const auto high = table_.find("high");
        if (box_ == nullptr && !low) fail_without_box("low");
        if (box_ == nullptr && !high) fail_without_box("high");
        const Interval interval{low ? low->number(coordinate_range) : component(box_->min, axis),
                                high ? high->number(coordinate_range) : component(box_->max, axis)};
        if (interval.low < interval.high) return interval;
        table_.fail(high ? "high" : "low",
                    fmt::format("low must be less than high, got {} and {}", interval.low, interval.high));
    }

    /// m^2, the cross-section of the box if the file does not say it.
    double read_area(std::size_t axis) {
        if (const auto area = table_.find("area")) return area->number(positive);
        if (box_ == nullptr) fail_without_box("area");
        const Vec3 size = box_->max - box_->min;
        return component(size, (axis + 1) % 3) * component(size, (axis + 2) % 3);
    }

    /// m, up to half of a periodic side.
    double read_reach() {
        const ValueReader value = table_.need("most");
        const double most = value.number(positive);
        if (box_ == nullptr) table_.fail("kind", R"(needs a region of kind "box")");
        for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
            const double half = 0.5 * component(box_->max - box_->min, axis);
            if (box_->faces.at(2 * axis).kind != FaceKind::periodic || most <= half) continue;
            value.fail(fmt::format("must be at most half of a periodic side, {}, got {}", half, most));
        }
        return most;
    }

    [[noreturn]] void fail_without_box(std::string_view key) const {
        table_.fail(key, R"(is missing: without a region of kind "box" it must be given)");
    }

    /// Names are a column of a CSV file.
    void read_name(Observation& observation) {
        if (const auto value = table_.find("name")) {
            observation.name = value->text();
            constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
            const bool is_plain = observation.name.find_first_not_of(plain) == std::string::npos;
            if (observation.name.empty() || !is_plain) value->fail("must be of letters, digits, _ and -");
        }
        const auto has_it = [&](const Observation& other) { return other.name == observation.name; };
        if (std::any_of(scene_.observations.begin(), scene_.observations.end(), has_it)) {
            table_.fail("name", fmt::format("must differ from those of earlier observers, got '{}'", observation.name));
        }
    }

    /// The whole number of steps next to an interval in seconds, at least one.
    [[nodiscard]] std::uint64_t steps_of(const ValueReader& every) const {
        constexpr double most_steps = 0x1p53;
        const double steps = std::round(every.number(not_negative) / scene_.run.dt);
        if (!(steps <= most_steps)) every.fail("must be at most 2^53 steps");
        return static_cast<std::uint64_t>(std::max(steps, 1.0));
    }

    TableReader& table_;
    const Scene& scene_;
    const Box* box_; ///< null where the region is none
};

} // namespace

void read_observations(TableReader& top, Scene& scene) {
    for (TableReader& table : top.tables("observe")) {
        Observation observation = ObservationReader(table, scene).read();
        if (std::holds_alternative<ImpactObserver>(observation.observer)) scene.options.record_impacts = true;
        scene.observations.push_back(std::move(observation));
    }
}

} // namespace carom::scene
