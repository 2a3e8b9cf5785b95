#include "scene/observation.hpp"

#include "scene/archive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace carom::scene {

namespace {

constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

/// Lines of one observer.
class Table {
public:
    Table(fmt::memory_buffer& text, std::string_view name) : text_(text), name_(name) {}

    void add(std::string_view quantity, std::string_view unit, const Estimate& estimate) {
        add_line(quantity, unit, "", estimate);
    }
    void add_at(double at, std::string_view quantity, std::string_view unit, const Estimate& estimate) {
        add_line(quantity, unit, fmt::format("{}", at), estimate);
    }

private:
    void add_line(std::string_view quantity, std::string_view unit, std::string_view at, const Estimate& estimate) {
        const auto out = std::back_inserter(text_);
        fmt::format_to(out, "{},{},{},{},{},", name_, quantity, unit, at, estimate.value);
        if (std::isfinite(estimate.standard_error)) fmt::format_to(out, "{}", estimate.standard_error);
        text_.push_back('\n');
    }

    fmt::memory_buffer& text_;
    std::string_view name_;
};

void write(Table& table, const Energies& energies) {
    table.add("kinetic", "J", energies.kinetic());
    table.add("potential", "J", energies.potential());
    table.add("total", "J", energies.total());
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        table.add(fmt::format("momentum_{}", axes[axis]), "kg m/s", energies.momentum(axis));
    }
}

void write(Table& table, const ImpactObserver& observer) {
    const ImpactStatistics& impacts = *observer.impacts;
    table.add("collision_rate", "1/s", impacts.collision_rate());
    if (impacts.count() > 0) table.add("mean_free_path", "m", mean_free_path(observer.speeds, impacts));
    if (impacts.has_volume()) table.add("pressure", "Pa", impacts.pressure());
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        table.add(fmt::format("virial_rate_{}", axes[axis]), "J/s", impacts.virial_rate(axis));
    }
    for (std::size_t face = 0; face < impacts.faces(); ++face) {
        table.add_at(static_cast<double>(face), "face_force", "N", impacts.face_force(face));
    }
}

void write(Table& table, const Speeds& speeds) {
    for (std::size_t power = 1; power <= 4; ++power) {
        table.add(fmt::format("speed_moment_{}", power), power == 1 ? "m/s" : fmt::format("(m/s)^{}", power),
                  speeds.moment(power));
    }
    table.add("temperature", "J", speeds.temperature());
    table.add("a2", "1", speeds.a2());
    for (std::size_t bin = 0; bin < speeds.bins(); ++bin) {
        table.add_at(speeds.speed(bin), "speed_density", "s/m", speeds.density(bin));
    }
}

void write(Table& table, const Profile& profile) {
    for (std::size_t slice = 0; slice < profile.slices(); ++slice) {
        const double at = profile.position(slice);
        table.add_at(at, "density", "1/m^3", profile.density(slice));
        table.add_at(at, "temperature", "J", profile.temperature(slice));
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            table.add_at(at, fmt::format("velocity_{}", axes[axis]), "m/s", profile.velocity(slice, axis));
        }
    }
}

void write(Table& table, const RadialDistribution& radial) {
    for (std::size_t shell = 0; shell < radial.shells(); ++shell) {
        table.add_at(radial.distance(shell), "g", "1", radial.g(shell));
    }
}

void write(Table& table, const Coordination& coordination) {
    table.add("coordination", "1", coordination.mean());
    table.add("coordination_without_rattlers", "1", coordination.mean_without_rattlers());
    for (std::size_t contacts = 0; contacts <= Coordination::most_contacts; ++contacts) {
        table.add_at(static_cast<double>(contacts), "share", "1", coordination.share(contacts));
    }
}

void write(Table& table, const SlabPacking& slab) { table.add("packing", "1", slab.fraction()); }

void write(Table& table, const Correlations& correlations) {
    for (std::size_t lag = 0; lag < correlations.lags(); ++lag) {
        const double at = correlations.time(lag);
        // A run may be shorter than the longest lag.
        if (lag > 0 && at == 0) break;
        table.add_at(at, "squared_displacement", "m^2", correlations.squared_displacement(lag));
        table.add_at(at, "velocity_correlation", "m^2/s^2", correlations.velocity_correlation(lag));
    }
}

/// Shows observers the world, and reads its bodies at most once.
class Look {
public:
    explicit Look(const World& world) : world_(world) {}

    void take(Energies& energies, bool is_due) {
        if (is_due) energies.observe(world_);
    }
    void take(ImpactObserver& observer, bool is_due) {
        if (!observer.impacts) observer.impacts.emplace(world_);
        observer.impacts->observe(world_);
        if (is_due) observer.speeds.observe(sample());
    }
    template <class OfSamples>
    void take(OfSamples& observer, bool is_due) {
        if (is_due) observer.observe(sample());
    }

private:
    const Sample& sample() {
        if (!sample_) sample_.emplace().read(world_);
        return *sample_;
    }

    const World& world_;
    std::optional<Sample> sample_;
};

/// Whether an observer has what is only made once it looks.
bool is_begun(const Observer& observer) {
    const auto* const impacts = std::get_if<ImpactObserver>(&observer);
    return impacts != nullptr && impacts->impacts.has_value();
}

} // namespace

void observe(std::span<Observation> observations, const World& world, std::uint64_t step) {
    Look look(world);
    for (Observation& observation : observations) {
        if (world.time() < observation.from) continue;
        const bool is_due = step % observation.every == 0;
        observation.samples += is_due ? 1 : 0;
        std::visit([&](auto& observer) { look.take(observer, is_due); }, observation.observer);
    }
}

std::vector<std::byte> save_observations(std::span<const Observation> observations) {
    Writer writer;
    for (const Observation& observation : observations) {
        writer.settings(observation.name, observation.from, observation.every,
                        std::uint64_t{observation.observer.index()});
        writer(observation.samples, is_begun(observation.observer));
        std::visit([&](const auto& observer) { writer(observer); }, observation.observer);
    }
    return writer.take();
}

void restore_observations(std::span<Observation> observations, std::span<const std::byte> bytes, const World& world) {
    Reader reader(bytes);
    for (Observation& observation : observations) {
        bool begun = false;
        reader.settings(observation.name, observation.from, observation.every,
                        std::uint64_t{observation.observer.index()});
        reader(observation.samples, begun);
        auto* const impacts = std::get_if<ImpactObserver>(&observation.observer);
        if (begun && impacts != nullptr) impacts->impacts.emplace(world);
        std::visit([&](auto& observer) { reader(observer); }, observation.observer);
    }
}

std::string to_csv(std::span<const Observation> observations) {
    fmt::memory_buffer text;
    text.append(std::string_view("observer,quantity,unit,at,value,standard_error\n"));
    for (const Observation& observation : observations) {
        Table table(text, observation.name);
        table.add("samples", "1", {.value = static_cast<double>(observation.samples)});
        if (observation.samples == 0) continue;
        std::visit([&](const auto& observer) { write(table, observer); }, observation.observer);
    }
    return fmt::to_string(text);
}

} // namespace carom::scene
