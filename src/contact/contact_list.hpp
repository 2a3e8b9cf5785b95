/// \file
/// What the bodies of a pile touch, or soon may: found, put into the order in which it is solved, and into groups.
#pragma once

#include "contact/contact_groups.hpp"
#include "space/line_vector.hpp"
#include "space/neighbours.hpp"
#include "space/state.hpp"
#include "space/ticks.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace carom::core {

/// Who touches whom, and how the two meet.
struct ContactName {
    std::uint32_t slot = 0;  ///< of a leaner; of two, the lower one
    std::uint32_t code = 0;  ///< as in ContactForce
    std::uint32_t place = 0; ///< its lane, counted over all groups
    double restitution = 0;  ///< what the rest rule takes
    bool is_driven = false;  ///< with what moves as prescribed, or of a body that grows with what does not move

    [[nodiscard]] bool is_wall() const { return (code & Support::wall_bit) != 0; }
    [[nodiscard]] std::uint32_t wall() const { return code & ~Support::wall_bit; }
    [[nodiscard]] std::size_t group() const { return place / group_size; }
    [[nodiscard]] std::size_t lane() const { return place % group_size; }
};

/// The contacts of *leaners*, the piled bodies, numbered as Bodies::listed. They are solved column by column of cells,
/// upwards against gravity: so that one pass carries a load through a whole heap. Columns are coloured 2 x 2; those of
/// one colour have no bodies in common. Groups take up contacts as far as that changes nothing: each comes after all
/// earlier ones of its bodies. The order is a function of the state alone.
template <class Real>
class ContactList {
public:
    explicit ContactList(State<Real>& state) : state_(state) {}

    /// Lists all that the leaners, all at `time` (s since the start of the step), are nearer to than `margin` (m),
    /// bodies that are asleep among it.
    void find(Executor& executor, double margin, double time);
    /// Lists what Bodies::contacts names.
    void recall(Executor& executor);
    /// Bodies::list_edge for those that lean at `time` (s since the start of the step): no contact is longer.
    [[nodiscard]] std::uint64_t wanted_edge(double time) const;

    [[nodiscard]] std::span<const ContactName> names() const { return names_; }
    [[nodiscard]] ContactGroup<Real>& group_of(const ContactName& name) { return groups_[name.group()]; }
    [[nodiscard]] const ContactGroup<Real>& group_of(const ContactName& name) const { return groups_[name.group()]; }
    [[nodiscard]] std::span<ContactGroup<Real>> groups() { return groups_; }
    /// The contact between two bodies is one of balls again, as large as they are at `time`; but a driven one has its
    /// normal and gap given.
    void open(const ContactName& name, double time);
    /// Of the contacts with walls, their numbers in names().
    [[nodiscard]] std::span<const std::uint32_t> at_walls() const { return at_walls_; }
    /// Of the driven contacts.
    [[nodiscard]] std::span<const std::uint32_t> driven() const { return driven_; }
    /// Leaners, and behind them an anchor for each contact with what cannot be moved, and one for each bundle.
    [[nodiscard]] std::size_t movers() const { return movers_; }
    [[nodiscard]] bool rubs() const { return rubs_; }
    [[nodiscard]] double largest_restitution() const { return largest_restitution_; }
    void clear();

    /// Calls f(bundle, groups) for all bundles of groups, colour by colour: those of one colour at the same time.
    template <class F>
    void for_each_bundle(Executor& executor, F&& f) {
        for_each_coloured(executor, [&](std::size_t /*part*/, std::size_t k) {
            const Bundle& bundle = bundles_[k];
            f(k, std::span(groups_).subspan(bundle.begin, bundle.end - bundle.begin));
        });
    }
    [[nodiscard]] std::size_t bundles() const { return bundles_.size(); }

    static constexpr std::uint32_t nobody = 0xffffffffU;

private:
    static constexpr std::size_t leaner_grain = 1024;
    static constexpr std::size_t colours = 4;

    struct Found {
        std::uint32_t a = 0;      ///< leaner
        std::uint32_t b = nobody; ///< the other leaner, or nobody
        std::uint32_t slot = 0;   ///< of a
        std::uint32_t code = 0;   ///< as in ContactForce
    };
    /// Where a leaner was when the contacts were listed, in cells that no contact is longer than.
    struct Cell {
        std::array<std::uint32_t, 2> across{};
        std::uint32_t height = 0; ///< against gravity
    };
    struct CellAxis {
        static constexpr std::uint32_t most = 1U << 29U; ///< cells
        int axis = 0;
        std::int64_t start = 0; ///< units
        std::uint64_t edge = 1; ///< units
        std::uint32_t turn = 0; ///< cells around a periodic axis, else 0
        [[nodiscard]] std::uint32_t cell_of(const Int3& x) const {
            const std::uint64_t offset =
                static_cast<std::uint64_t>(component(x, axis)) - static_cast<std::uint64_t>(start);
            const auto cell = static_cast<std::uint32_t>(offset / edge);
            return turn == 0 ? cell : std::min(cell, turn - 1);
        }
    };
    struct Order {
        static constexpr unsigned column_bits = 30; ///< along either axis
        std::uint64_t column = 0;                   ///< its colour first
        std::uint32_t height = 0;
        std::uint32_t contact = 0;
        std::uint64_t ids = 0;
        friend bool operator<(const Order& x, const Order& y) {
            return std::tie(x.column, x.height, x.ids) < std::tie(y.column, y.height, y.ids);
        }
    };
    /// Some columns of one colour: their contacts, and what is made of them. Begins count those of all bundles before.
    struct Bundle {
        std::uint32_t first = 0; ///< contact, in orders_
        std::uint32_t last = 0;  ///< behind the last one
        std::uint32_t begin = 0; ///< group
        std::uint32_t end = 0;
        std::uint32_t mover = 0; ///< its idle anchor, and behind it an anchor for each contact that needs one
        std::uint32_t wall = 0;  ///< in at_walls_
        std::uint32_t drive = 0; ///< in driven_
    };
    /// How many of them a bundle needs.
    struct Needs {
        std::uint32_t groups = 0;
        std::uint32_t anchors = 0;
        std::uint32_t walls = 0;
        std::uint32_t driven = 0;
    };
    /// What is found while a bundle is filled.
    struct Kinds {
        bool rubs = false;
        double largest_restitution = 0;
    };
    /// Room to make groups in.
    struct Fillings {
        std::vector<std::uint32_t> contacts;  ///< per group
        std::vector<std::uint32_t> open_from; ///< per group: it is full up to this one, or further
    };

    /// Calls f(part, bundle) in the same way.
    template <class F>
    void for_each_coloured(Executor& executor, F&& f) {
        std::uint32_t begin = 0;
        for (const std::uint32_t end : colour_ends_) {
            if (end == begin) continue;
            for_each_in_parts(executor, end - begin, 1, [&](std::size_t part, std::size_t k) { f(part, begin + k); });
            begin = end;
        }
    }
    void number_leaners();
    void look_around(Executor& executor, double margin, double time);
    void add_pair(std::vector<Found>& found, Index a, Index b, double margin, double time) const;
    void add_walls(std::vector<Found>& found, std::uint32_t a, double margin, double time) const;
    [[nodiscard]] Vec3 apart(std::uint32_t a, Index other) const;
    void arrange(Executor& executor);
    void assign_cells();
    [[nodiscard]] CellAxis cell_axis(int axis, const Census& census, std::uint64_t edge) const;
    [[nodiscard]] Order order_of(std::uint32_t number) const;
    void sort(Executor& executor);
    void make_groups(Executor& executor);
    void plan_bundles();
    [[nodiscard]] Needs assign_groups(const Bundle& bundle, Fillings& fillings);
    void give_room();
    [[nodiscard]] Kinds fill(const Bundle& bundle);
    [[nodiscard]] bool is_driven(const Found& found) const;
    [[nodiscard]] Encounter fill(const ContactName& name, const Found& found, std::uint32_t anchor);

    State<Real>& state_;
    std::vector<ContactName> names_; ///< in the order in which they are solved
    std::vector<std::uint32_t> at_walls_;
    std::vector<std::uint32_t> driven_;
    LineVector<ContactGroup<Real>> groups_;
    std::vector<Bundle> bundles_;
    std::array<std::uint32_t, colours> colour_ends_{}; ///< in bundles_
    std::size_t movers_ = 0;
    bool rubs_ = false;
    double largest_restitution_ = 0;

    // Room to make the list in.
    std::vector<std::uint32_t> places_; ///< per body: in Bodies::listed, or nobody
    std::vector<Index> statics_;        ///< and bodies that are asleep
    Ticks ticks_;
    Neighbours neighbours_;
    std::array<std::vector<Found>, most_parts> found_in_part_;
    std::vector<Found> found_;
    std::vector<Cell> cells_; ///< per leaner
    std::array<std::uint32_t, 2> turns_{};
    std::vector<Order> unsorted_;
    std::vector<Order> orders_;
    std::vector<std::uint32_t> bucket_ends_; ///< in orders_
    std::vector<std::uint32_t>
        next_group_;           ///< per leaner, the first group of the bundle that its next contact may join
    std::vector<Needs> needs_; ///< per bundle
    std::vector<Kinds> kinds_; ///< per bundle
    std::array<Fillings, most_parts> fillings_;
};

} // namespace carom::core
