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

#include "contact/contact_list.hpp"
#include "contact/disjoint_sets.hpp"
#include "contact/rest.hpp"
#include "space/window.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace carom::core {

template <class Real>
class Pile {
public:
    explicit Pile(State<Real>& state) : state_(state), list_(state) {}

    void use(Executor& executor) { executor_ = &executor; }

    /// How a step of `duration` (s) is cut as long as bodies are piled: by the forces of their contacts.
    [[nodiscard]] Pieces cut(double duration);
    /// Start of a step: bodies may have come, gone, or changed places in memory.
    void begin_step();
    /// Whether bodies are piled: to be asked between pieces.
    [[nodiscard]] bool is_active() const { return !state_.bodies.listed.empty() || state_.bodies.newly_piled; }
    /// Bodies, those that are asleep among them.
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] std::size_t asleep() const;
    /// Contacts that bear something, after end_step().
    [[nodiscard]] std::size_t contacts() const { return bearing_; }
    /// Start of a piece [from, to] (s since the start of the step): sets the velocities of the piled bodies.
    void begin_piece(double from, double to);
    /// End of it, or of what a step that ends early did of it. Bodies that nothing supports any more are free again.
    void end_piece(double at);
    /// End of a step that got to `reached`: brings all piled bodies there, and leaves the forces in the state.
    void end_step(double reached);

    /// Calls f(a, b) for every pair that may strike each other in the piece, and f(a, no_index) for a body that may
    /// strike a wall, as far as bodies are told of (see Load).
    template <class F>
    void for_each_strike(F&& f) {
        const auto tell = [&](const ContactName& name) {
            f(state_.bodies.slots[name.slot], name.is_wall() ? no_index : state_.bodies.slots[name.code]);
        };
        for (const Closed& closed : closed_) {
            if (may_strike(list_.names()[closed.number], closed.gap)) tell(list_.names()[closed.number]);
        }
        const auto may_so = [this](const ContactName& name) {
            return may_strike(name, static_cast<double>(list_.group_of(name).gap[name.lane()]));
        };
        for (const std::uint32_t number : find_marked(fast, may_so)) tell(list_.names()[number]);
        for_each_facet([&](std::uint32_t number) {
            if (may_sink(list_.names()[number])) tell(list_.names()[number]);
        });
    }
    /// m/s
    [[nodiscard]] double told_speed() const { return told_speed_; }
    /// Piled bodies that are not told of in the piece.
    [[nodiscard]] std::span<const Index> untold() const { return untold_; }
    /// Bodies that the last end_piece() let go.
    [[nodiscard]] std::span<const Index> released() const { return released_; }

private:
    /// s that contacts are listed for, at least: a body that moves too far meanwhile looks for impacts itself, and
    /// meets no contacts that it does not have.
    static constexpr double list_life = 1.0 / 60;
    static constexpr std::size_t leaner_grain = 1024;
    static constexpr std::size_t contact_grain = 1024;

    using Vector = Vector3<Real>;

    /// Pieces a second.
    struct Rates {
        double load = 0;       ///< that the loads ask for
        double mass_ratio = 0; ///< that bodies on lighter ones ask for
    };
    /// What is not in the books yet.
    struct Account {
        Vec3 momentum{};            ///< N s
        double lost = 0;            ///< J
        double prescribed_work = 0; ///< J
        double held_mass_time = 0;  ///< kg s
    };
    /// A contact that is left to the impacts, or whose body was let go.
    struct Closed {
        std::uint32_t number = 0; ///< in the list
        double gap = 0;           ///< m
    };
    /// How the normal of a contact with a facet has turned.
    struct Turn {
        std::uint32_t number = 0; ///< in the list
        Vector way{};
        Real deflection = 0; ///< m/s, what takes the body round the bend changes its velocity by
    };
    // What is particular about a mover.
    static constexpr std::uint8_t fast = 1; ///< its speed could make a strike
    static constexpr std::uint8_t gone = 2; ///< it was let go
    /// What a part of a loop over the leaners comes to.
    struct Findings {
        bool has_fast = false;
        bool has_far = false; ///< someone has moved too far for the list
        std::vector<Index> bodies;
    };

    [[nodiscard]] Rates wanted_rates() const;
    [[nodiscard]] Softness<Real> softness() const;

    // The list.
    void start_list(double from);
    [[nodiscard]] bool is_driven() const;
    [[nodiscard]] double wanted_margin() const;
    [[nodiscard]] double unlisted_approach() const;
    void gather();
    void resume_list();
    bool take_back(double from);
    void advance_leaner(std::size_t leaner, double at);
    void start_values();
    void stiffen();
    void recall_forces();
    void keep_forces();
    void note_pressings();
    void advance_newcomers(double at);

    // Sleep.
    void fall_asleep(double reached);
    void leave_sleepers();
    void wake_islands();
    bool wake_neighbours();
    [[nodiscard]] double asleep_mass();

    // Contacts.
    [[nodiscard]] ContactRun<Real> run_of(std::span<ContactGroup<Real>> groups);
    void measure_walls();
    void measure_driven();
    [[nodiscard]] Vector surface_velocity(const ContactName& name, const Vec3& normal) const;
    [[nodiscard]] Touch touch_of(const ContactName& name, Index body) const;
    void book_driven(double sign);
    /// Calls f(number) for the contacts with obstacles.
    template <class F>
    void for_each_facet(F&& f) const {
        if (state_.bounds.obstacles() == nullptr) return;
        for (const std::uint32_t number : list_.at_walls()) {
            if (state_.bounds.is_facet(list_.names()[number].wall())) f(number);
        }
    }
    void leave_facets();
    void note_carried();
    void note_turns();
    void turn_back();
    void close_contacts();
    void close(std::uint32_t number, double gap);
    void reopen_contacts();
    [[nodiscard]] double gap_of(const ContactName& name) const;
    [[nodiscard]] double approach_of(const ContactName& name) const;
    [[nodiscard]] bool is_closing(const ContactName& name) const;
    [[nodiscard]] double strike_of(const ContactName& name) const;
    [[nodiscard]] bool may_strike(const ContactName& name, double gap) const;
    [[nodiscard]] bool may_sink(const ContactName& name) const;
    /// The numbers of the contacts of marked movers that are accepted, in their order.
    template <class Accepts>
    std::span<const std::uint32_t> find_marked(std::uint8_t marks, Accepts&& accepts) {
        clear_for_reuse(found_);
        if ((all_marks_ & marks) == 0) return found_;
        const std::span<const ContactName> names = list_.names();
        for_parts(*executor_, names.size(), contact_grain, [&](std::size_t part, std::size_t begin, std::size_t end) {
            const ContactGroup<Real>* const groups = list_.groups().data();
            const std::uint8_t* const marks_of = marks_.data();
            for (std::size_t k = begin; k < end; ++k) {
                const ContactGroup<Real>& group = groups[names[k].group()];
                const std::size_t lane = names[k].lane();
                if (((marks_of[group.a[lane]] | marks_of[group.b[lane]]) & marks) == 0 || !accepts(names[k])) continue;
                found_in_part_[part].push_back(static_cast<std::uint32_t>(k));
            }
        });
        for (std::vector<std::uint32_t>& found : found_in_part_) {
            found_.insert(found_.end(), found.begin(), found.end());
            clear_for_reuse(found);
        }
        return found_;
    }

    // Leaners.
    /// Calls f(findings, k) for all bodies that have not been let go.
    template <class F>
    void for_each_leaner(F&& f) {
        for_each_in_parts(*executor_, bodies_.size(), leaner_grain, [&](std::size_t part, std::size_t k) {
            if ((marks_[k] & gone) == 0) f(findings_[part], k);
        });
    }
    void collect(std::vector<Index>& bodies);
    void set_out();
    void go();
    void arrive(double at);
    void come_to_rest();
    void place(std::size_t leaner);
    [[nodiscard]] bool is_far(std::size_t leaner) const;
    bool mark(std::size_t leaner);
    void enter(std::size_t leaner, const Vector& v);
    void settle_accounts();

    State<Real>& state_;
    Executor* executor_ = nullptr;
    const GroupSolver<Real>* solver_ = nullptr;

    ContactList<Real> list_;
    bool is_listed_ = false;  ///< list_ is the one that the state tells of
    bool has_values_ = false; ///< impulses and the like are those of the step
    bool has_far_ = false;    ///< someone has moved too far for the list
    std::size_t bearing_ = 0;
    std::optional<double> asleep_mass_; ///< kg
    std::size_t asleep_ = 0;            ///< bodies that make it up

    // Per leaner.
    std::vector<Index> bodies_;
    std::vector<Vector> entered_; ///< m/s, the velocity up to which changes are in the accounts
    std::vector<Vector> shares_;  ///< m/s, what the contacts gave it in the piece
    std::vector<Account> accounts_;
    // Per mover.
    LineVector<Mover<Real>> movers_;
    LineVector<Place<Real>> places_;
    std::vector<std::uint8_t> marks_;
    std::vector<std::uint8_t> carried_;

    std::vector<Closed> closed_;
    std::vector<Turn> turns_;
    std::uint8_t all_marks_ = 0;

    // The step.
    double still_speed_ = 0; ///< m/s, what is slower lies still
    double told_speed_ = 0;  ///< m/s
    double stiffening_ = 1;  ///< of contacts, by this step's rate of pieces: the factor, until it is done
    double far_ = 0;         ///< m, that a body may move until the list does no longer for it

    // The piece.
    double piece_ = 0;         ///< s
    double now_ = 0;           ///< s since the start of the step, up to which the bodies have come
    Vector fall_{};            ///< m/s, what gravity gives in it
    double friction_loss_ = 0; ///< J, not in the books yet
    double least_strike_ = 0;  ///< m/s: what is slower strikes nothing
    std::vector<Index> untold_;
    std::vector<Index> released_;

    // Room to work in.
    std::array<Findings, most_parts> findings_;
    std::array<std::vector<std::uint32_t>, most_parts> found_in_part_;
    std::vector<std::uint32_t> found_;
    std::vector<std::uint32_t> returned_;
    std::vector<double> still_; ///< s, per slot
    std::vector<bool> borne_;   ///< per slot
    DisjointSets islands_;
    std::vector<bool> wakeful_;  ///< per root of an island
    std::vector<double> losses_; ///< J, per bundle
    std::vector<std::uint32_t> first_forces_;
    std::vector<std::uint32_t> force_order_;
};

} // namespace carom::core
