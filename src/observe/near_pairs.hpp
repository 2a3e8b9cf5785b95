/// \file
/// Pairs of bodies that are near each other, by cells.
#pragma once

#include <carom/observers.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom::observe {

/// Cuts the space that the centres of a sample are in into cells at least `reach` wide, and knows who is in each.
class NearPairs {
public:
    /// `reach` in m, > 0; across periodic faces of the sample's box distances go the short way.
    NearPairs(const Sample& sample, double reach);

    /// Calls visit(i, j, distance squared) once for each pair with centres nearer than the reach, in an order that
    /// depends on positions alone.
    template <class Visit>
    void visit(const Visit& visit) const {
        for (std::size_t z = 0; z < axes_[2].cells; ++z) {
            for (std::size_t y = 0; y < axes_[1].cells; ++y) {
                for (std::size_t x = 0; x < axes_[0].cells; ++x) visit_around({x, y, z}, visit);
            }
        }
    }

private:
    using Cell = std::array<std::size_t, 3>;

    struct Axis {
        double low = 0;
        double size = 1;
        std::size_t cells = 1;
        bool is_periodic = false;
        std::vector<std::vector<std::size_t>> beside; ///< of each place: those beside it and itself, each once
    };

    void lay_axis(const Sample& sample, std::size_t k);
    void sort_bodies(const Sample& sample);
    [[nodiscard]] std::size_t place(const Axis& axis, double x) const;
    [[nodiscard]] std::size_t number_of(const Cell& cell) const {
        return (cell[2] * axes_[1].cells + cell[1]) * axes_[0].cells + cell[0];
    }
    /// Whether the short way from cell to cell may lead across a periodic face.
    [[nodiscard]] bool may_wrap(const Cell& a, const Cell& b) const;
    [[nodiscard]] Vec3 short_way(Vec3 d) const;

    /// A cell with those of its neighbours that come after it.
    template <class Visit>
    void visit_around(const Cell& cell, const Visit& visit) const {
        const std::size_t here = number_of(cell);
        const std::size_t end = first_[here + 1];
        if (first_[here] == end) return;
        for (const std::size_t z : axes_[2].beside[cell[2]]) {
            for (const std::size_t y : axes_[1].beside[cell[1]]) {
                for (const std::size_t x : axes_[0].beside[cell[0]]) {
                    const std::size_t there = number_of({x, y, z});
                    if (there < here || first_[there] == first_[there + 1]) continue;
                    const bool wraps = may_wrap(cell, {x, y, z});
                    for (std::size_t k = first_[here]; k < end; ++k) {
                        visit_row(k, there == here ? k + 1 : first_[there], first_[there + 1], wraps, visit);
                    }
                }
            }
        }
    }

    template <class Visit>
    void visit_row(std::size_t k, std::size_t begin, std::size_t end, bool wraps, const Visit& visit) const {
        const Vec3 centre = places_[k];
        for (std::size_t l = begin; l < end; ++l) {
            const Vec3 d = places_[l] - centre;
            const double square = length_squared(wraps ? short_way(d) : d);
            if (square < reach_ * reach_) visit(bodies_[k], bodies_[l], square);
        }
    }

    double reach_;
    std::array<Axis, 3> axes_;
    std::vector<std::size_t> first_;    ///< of each cell, in bodies_
    std::vector<std::uint32_t> bodies_; ///< by cell
    std::vector<Vec3> places_;          ///< of bodies_
};

} // namespace carom::observe
