/// \file
/// Piles: bodies that lean on others that move, and the forces that keep them apart.
///
/// A step with piled bodies is cut into *pieces*. At the start of each, gravity and the contacts set the velocities of
/// all piled bodies, which then move straight, and impacts run over the piece. Contacts are soft constraints, solved
/// once a piece with the forces of the piece before as a start: temporal Gauss-Seidel, Macklin et al., "Small Steps in
/// Physics Simulation", Symposium on Computer Animation 2019. A pass without softness at the end of each piece takes
/// out of the velocities what the soft one put in to push overlapping bodies apart: Catto, "Solver2D" (box2d.org,
/// 2024).
#pragma once

#include "contact/rest.hpp"
#include "space/neighbours.hpp"
#include "space/state.hpp"
#include "space/ticks.hpp"
#include "space/window.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace carom::core {

template <class Real>
class Pile {
public:
    explicit Pile(State<Real>& state) : state_(state) {}

    void use(Executor& executor) { executor_ = &executor; }

    /// How a step of `duration` (s) is cut as long as bodies are piled: by the forces of their contacts.
    [[nodiscard]] Pieces cut(double duration);
    /// Start of a step: bodies may have come, gone, or changed places in memory.
    void begin_step();
    /// Whether bodies are piled: to be asked between pieces.
    [[nodiscard]] bool is_active() const { return !leaners_.empty() || state_.bodies.newly_piled; }
    /// Bodies, after end_step().
    [[nodiscard]] std::size_t size() const;
    /// Start of a piece [from, to] (s since the start of the step): sets the velocities of the piled bodies.
    void begin_piece(double from, double to);
    /// End of it, or of what a step that ends early did of it. Bodies that nothing supports any more are free again.
    void end_piece(double at);
    /// End of a step that got to `reached`: brings all piled bodies there, and leaves the forces in the state.
    void end_step(double reached);

    /// Calls f(a, b) for every pair that may strike each other in the piece, and f(a, no_index) for a body that may
    /// strike a wall, as far as bodies are told of (see Load) and no faster than told_speed().
    template <class F>
    void for_each_strike(F&& f) const {
        if (2 * top_speed_ <= least_strike_) return;
        for (std::uint32_t k = 0; k < contacts_.size(); ++k) {
            if (!may_strike(k)) continue;
            const bool is_wall = (names_[k].code & Support::wall_bit) != 0;
            f(leaners_[contacts_[k].a].body, is_wall ? no_index : state_.bodies.slots[names_[k].code]);
        }
    }
    /// m/s
    [[nodiscard]] double told_speed() const { return 0.5 * striking_speed(0, 0, state_.laws); }
    /// Calls f(body) for the piled bodies that are not told of.
    template <class F>
    void for_each_untold(F&& f) const {
        for (const Leaner& l : leaners_) {
            if (!l.is_gone && !state_.bodies.loads[l.body].is_told) f(l.body);
        }
    }

    /// Bodies that the last end_piece() let go.
    [[nodiscard]] std::span<const Index> released() const { return released_; }

private:
    static constexpr std::uint32_t nobody = 0xffffffffU;
    static constexpr std::size_t leaner_grain = 1024;
    static constexpr std::size_t contact_grain = 1024;
    static constexpr std::size_t column_grain = 4;
    static constexpr std::size_t colours = 4;

    /// Pieces a second.
    struct Rates {
        double load = 0;       ///< that the loads ask for
        double mass_ratio = 0; ///< that bodies on lighter ones ask for
    };
    /// A piled body while it is worked on.
    struct Leaner {
        Index body = no_index;
        bool is_gone = false;      ///< it was let go
        bool is_supported = false; ///< by a contact with a body that moves, in this piece
        double inverse_mass = 0;   ///< 1/kg
        Vec3 v{};                  ///< m/s
        Vec3 before{};             ///< m/s, when the passes began
        Vec3 moved{};              ///< m, since it was listed
        double pressing = 0;       ///< m/s^2, as in Load
        double way = 0;            ///< m that it came at most since it was listed
        Int3 listed{};             ///< units
    };
    /// What is not in the books yet.
    struct Account {
        Vec3 momentum{};            ///< N s
        double lost = 0;            ///< J
        double prescribed_work = 0; ///< J
        double held_mass_time = 0;  ///< kg s
    };
    /// What a leaner touches, or may while the list lasts. Two cache lines: the passes stream through them.
    struct Contact {
        std::uint32_t a = 0;       ///< a leaner; of two, the one with the lower slot
        std::uint32_t b = nobody;  ///< the other leaner, or nobody
        Vec3 apart{};              ///< m, from a to another body when they were listed
        double touching = 0;       ///< m, the distance at which they touch
        Vec3 normal{};             ///< unit vector from a to the other
        double gap = 0;            ///< m
        double impulse = 0;        ///< N s in a piece, pushes them apart
        double mass = 0;           ///< kg, reduced
        double friction = 0;       ///< Coulomb's mu
        Vec3 friction_impulse{};   ///< N s in a piece, on the other
        bool is_open = false;      ///< left to the impacts: the two approach too fast
        std::uint32_t surface = 0; ///< in surfaces_: how the other moves if that is prescribed
    };
    /// What is seldom asked of a contact.
    struct ContactName {
        std::uint32_t slot = 0; ///< of a
        std::uint32_t code = 0; ///< as in ContactForce
        double restitution = 0;
    };
    struct Found {
        ContactName name{};
        Contact contact{};
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
    /// The order in which contacts are solved: a function of the state alone.
    struct Order {
        std::uint64_t column = 0; ///< its colour first
        std::uint32_t height = 0;
        std::uint32_t contact = 0;
        std::uint64_t ids = 0;
        friend bool operator<(const Order& x, const Order& y) {
            return std::tie(x.column, x.height, x.ids) < std::tie(y.column, y.height, y.ids);
        }
    };
    /// Contacts above each other: solved one after the other, upwards. Those of one colour have no bodies in common.
    struct Column {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };
    /// How a pass turns overlap and approach into impulses; all of the approach and none of the overlap by default.
    struct Softness {
        double rate = 0;    ///< 1/s, at which overlap is undone
        double mass = 1;    ///< part of the effective mass
        double impulse = 0; ///< part of the impulse so far that is taken back
    };

    [[nodiscard]] Rates wanted_rates() const;
    void start_list(double from);
    void gather();
    bool take_back(double from);
    void advance_all(double at);
    void add_to_account(std::uint32_t leaner, const Entry& entry);
    void find_contacts();
    void add_pair(std::vector<Found>& found, Index a, Index b) const;
    void add_walls(std::vector<Found>& found, std::uint32_t a) const;
    [[nodiscard]] double reduced_mass(Index a, Index b) const;
    [[nodiscard]] bool grows(Index a, Index b) const;
    [[nodiscard]] double distance_now(std::uint32_t number) const;
    void assign_cells();
    [[nodiscard]] CellAxis cell_axis(int axis, const Census& census, std::uint64_t edge) const;
    [[nodiscard]] Order order_of(std::uint32_t number) const;
    void sort_contacts();
    void recall_forces();
    void keep_forces();

    void measure_all();
    void measure(std::uint32_t number);
    void look_at_kinematic(std::uint32_t number);
    [[nodiscard]] Vec3 mean_velocity(const Bounds::Wall& wall, const Int3& x) const;
    [[nodiscard]] Vec3 velocity_of_other(const Contact& contact) const {
        return contact.b == nobody ? surfaces_[contact.surface] : leaners_[contact.b].v;
    }
    [[nodiscard]] double approach_of(const Contact& contact) const;
    [[nodiscard]] double strike_of(std::uint32_t number) const;
    [[nodiscard]] bool may_strike(std::uint32_t number) const;
    void take_velocities(const Vec3& change);
    void put_velocities();
    void settle_accounts();
    template <class F>
    void for_each_leaner(F&& f);
    template <class F>
    void for_each_contact(F&& f);
    void warm_up();
    template <class F>
    void pass(F&& f);
    [[nodiscard]] double solve(Contact& contact, const Softness& softness);
    [[nodiscard]] double rub(Contact& contact, const Vec3& sliding);
    void push(const Contact& contact, const Vec3& impulse);
    void enter_loads();
    void release_unsupported();

    State<Real>& state_;
    Executor* executor_ = nullptr;

    // The list, which lasts for some pieces.
    std::vector<Leaner> leaners_;
    std::vector<std::uint32_t> places_; ///< per body: in leaners_, or nobody
    std::vector<Index> statics_;
    std::vector<Account> accounts_; ///< per leaner
    std::vector<ContactName> names_;
    std::vector<Contact> contacts_;      ///< in the order in which they are solved
    std::vector<Vec3> surfaces_{Vec3{}}; ///< m/s, the first of what rests, the others of one contact each
    std::vector<Column> columns_;
    std::array<std::uint32_t, colours> colour_ends_{}; ///< in columns_
    double listed_until_ = 0;                          ///< s since the start of the step
    double margin_ = 0;                                ///< m, gaps up to this are listed

    // The piece.
    double now_ = 0;           ///< s since the start of the step, when all were brought up to date
    double piece_ = 0;         ///< s
    double friction_loss_ = 0; ///< J, not in the books yet
    double top_speed_ = 0;     ///< m/s, of the leaners
    double least_strike_ = 0;  ///< m/s: what is slower strikes nothing
    std::vector<Index> released_;

    // Room to make the list in.
    Ticks ticks_;
    Neighbours neighbours_;
    std::array<std::vector<Found>, most_parts> found_;
    std::vector<Found> all_found_;
    std::vector<Cell> cells_; ///< per leaner
    std::array<std::uint32_t, 2> turns_{};
    std::vector<Order> orders_;
    std::vector<std::uint32_t> first_forces_;
    std::vector<std::uint32_t> force_order_;
};

} // namespace carom::core
