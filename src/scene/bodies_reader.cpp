#include "scene/bodies_reader.hpp"

#include "scene/csv.hpp"
#include "scene/entry_places.hpp"
#include "scene/entry_values.hpp"
#include "scene/entry_velocities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace carom::scene {

namespace {

class BodiesReader {
public:
    BodiesReader(const std::vector<Material>& materials, std::uint64_t max_bodies, Scene& scene)
        : materials_(materials), max_bodies_(max_bodies), scene_(scene) {}

    void read(TableReader& top) {
        for (const TableReader& table : top.tables("bodies")) begin_entry(table);
        for (const TableReader& table : top.tables("attractor")) read_attractor(table);
        place_at_random(entries_, attractors_, scene_.options.region, scene_.seed);
        for (Entry& entry : entries_) read_velocities(entry, attractors_, entries_, scene_.seed);
        for (const Entry& entry : entries_) finish_entry(entry);
        for (const NamedAttractor& attractor : attractors_) scene_.attractors.push_back(attractor.spec);
    }

private:
    /// Makes everything of an entry but random places and velocities.
    void begin_entry(const TableReader& table) {
        Entry& entry = entries_.emplace_back(Entry{.table = table, .number = entries_.size()});
        read_name(entry);
        if (const auto value = entry.table.find("generator")) {
            entry.generator = static_cast<Generator>(value->choice(generator_names));
        }
        read_count_and_radii(entry);
        read_surfaces(entry, materials_);
        read_masses(entry);
        total_ += entry.count;
    }

    void read_name(Entry& entry) {
        const auto value = entry.table.find("name");
        if (!value) return;
        entry.name = value->text();
        const auto same = [&](const Entry& other) { return &other != &entry && other.name == entry.name; };
        if (std::any_of(entries_.begin(), entries_.end(), same)) value->fail("is the name of an earlier entry");
    }

    /// Also the places, where they depend on no other entry.
    void read_count_and_radii(Entry& entry) {
        switch (entry.generator) {
        case Generator::listed:
            read_listed(entry);
            break;
        case Generator::csv:
            read_csv_file(entry);
            break;
        case Generator::lattice:
        case Generator::jittered_lattice: {
            const Cuboid box = read_cuboid(entry.table, scene_.options.region);
            const Sites sites = read_sites(entry, box);
            read_radii(entry, scene_.seed);
            return place_on_lattice(entry, box, sites, scene_.seed);
        }
        case Generator::fcc:
            read_count(entry);
            read_radii(entry, scene_.seed);
            return place_on_fcc(entry, read_cuboid(entry.table, scene_.options.region));
        default:
            read_count(entry);
            break;
        }
        read_radii(entry, scene_.seed);
    }

    void set_count(Entry& entry, std::uint64_t count) {
        if (count > max_bodies_ - total_) {
            entry.table.fail(fmt::format("makes {} bodies; together with the entries before, a scene may have {}",
                                         count, max_bodies_));
        }
        entry.count = count;
        entry.bodies = BodyTable::of(count);
    }

    void read_count(Entry& entry) { set_count(entry, entry.table.need("count").count(1, max_bodies_ - total_)); }

    void read_listed(Entry& entry) {
        const ValueReader position = entry.table.need("position");
        if (!position.is_list_of_arrays()) {
            const Vec3 one = position.vec3(coordinate_range);
            set_count(entry, 1);
            entry.bodies.position[0] = one;
            return;
        }
        const std::vector<ValueReader> list = position.elements();
        set_count(entry, list.size());
        for (std::size_t i = 0; i < list.size(); ++i) entry.bodies.position[i] = list[i].vec3(coordinate_range);
    }

    void read_csv_file(Entry& entry) {
        const ValueReader value = entry.table.need("file");
        const std::filesystem::path named = value.text();
        const std::filesystem::path file = std::filesystem::path(scene_.file).parent_path() / named;
        CsvBodies bodies = read_csv(file, max_bodies_ - total_);
        entry.count = bodies.table.size();
        entry.bodies = std::move(bodies.table);
        entry.csv_columns = std::move(bodies.given);
    }

    /// Either the number of bodies, or the sites along each axis.
    Sites read_sites(Entry& entry, const Cuboid& box) {
        const auto value = entry.table.find("sites");
        if (!value) {
            read_count(entry);
            return lattice_sites(box, entry.count);
        }
        if (entry.table.find("count")) value->fail("must not stand beside count: give one of them");
        const std::vector<ValueReader> parts = value->elements(3, "three integers [nx, ny, nz]");
        constexpr std::uint64_t most = 1'000'000; // the product of three of them fits 64 bits
        const Sites sites{parts[0].count(1, most), parts[1].count(1, most), parts[2].count(1, most)};
        set_count(entry, sites.x * sites.y * sites.z);
        return sites;
    }

    void read_attractor(TableReader table) {
        NamedAttractor attractor;
        attractor.spec.line = table.line();
        attractor.spec.strength = table.need("strength").number(any_number);
        table.read("softening", attractor.spec.softening, radius_range);
        table.read("name", attractor.name);
        const auto position = table.find("position");
        const auto body = table.find("body");
        if (body) {
            if (position) position->fail("must not stand beside body: the attractor moves with its body");
            tie(attractor, *body);
        } else if (position) {
            attractor.spec.position = position->vec3(coordinate_range);
        } else {
            table.fail("position", "is missing: give a position, or the body that carries the attractor");
        }
        table.finish();
        attractors_.push_back(std::move(attractor));
    }

    /// Ties an attractor to the only body of the named entry, and calls it like that one.
    void tie(NamedAttractor& attractor, const ValueReader& value) const {
        std::vector<std::string_view> names;
        for (const Entry& entry : entries_) {
            if (!entry.name.empty()) names.push_back(entry.name);
        }
        if (names.empty()) value.fail("must be the name of an entry [[bodies]], but none has a name");
        const std::string_view name = names[value.choice(names)];
        const auto entry =
            std::find_if(entries_.begin(), entries_.end(), [name](const Entry& e) { return e.name == name; });
        if (entry->count != 1 || is_placed_at_random(entry->generator)) {
            value.fail("must name an entry with exactly one body, at a given place");
        }
        attractor.entry = entry->number;
        attractor.spec.position = entry->bodies.position[0];
        attractor.spec.body = first_body_of(*entry);
        if (attractor.name.empty()) attractor.name = name;
    }

    [[nodiscard]] std::size_t first_body_of(const Entry& wanted) const {
        std::size_t first = 0;
        for (std::size_t i = 0; i < wanted.number; ++i) first += entries_[i].count;
        return first;
    }

    void finish_entry(const Entry& entry) {
        entry.table.finish();
        scene_.sources.push_back({.key = entry.table.path(),
                                  .line = entry.table.line(),
                                  .first = scene_.bodies.size(),
                                  .count = entry.count});
        scene_.bodies.append(entry.bodies);
    }

    const std::vector<Material>& materials_;
    std::uint64_t max_bodies_;
    Scene& scene_;
    std::vector<Entry> entries_;
    std::uint64_t total_ = 0;
    std::vector<NamedAttractor> attractors_;
};

} // namespace

void read_bodies(TableReader& top, const std::vector<Material>& materials, std::uint64_t max_bodies, Scene& scene) {
    BodiesReader(materials, max_bodies, scene).read(top);
}

} // namespace carom::scene
