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

    /// Calls visit(i, j, distance squared) once for each pair i < j with centres nearer than the reach, in an order that
    /// depends on positions alone.
    template <class Visit>
    void visit(const Visit& visit) const {
        for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) {
            for (const std::size_t other : neighbours(cell)) visit_cells(cell, other, visit);
        }
    }

private:
    struct Axis {
        double low = 0;
        double size = 1;
        std::size_t cells = 1;
        bool is_periodic = false;
    };

    [[nodiscard]] std::size_t place(const Axis& axis, double x) const;
    [[nodiscard]] std::size_t cell_of(const Vec3& x) const;
    [[nodiscard]] std::vector<std::size_t> neighbours(std::size_t cell) const;
    [[nodiscard]] Vec3 short_way(Vec3 d) const;

    template <class Visit>
    void visit_cells(std::size_t cell, std::size_t other, const Visit& visit) const {
        for (std::size_t k = first_[cell]; k < first_[cell + 1]; ++k) {
            for (std::size_t l = first_[other]; l < first_[other + 1]; ++l) {
                const std::uint32_t i = bodies_[k];
                const std::uint32_t j = bodies_[l];
                if (i >= j) continue;
                const double square = length_squared(short_way(places_[l] - places_[k]));
                if (square < reach_ * reach_) visit(i, j, square);
            }
        }
    }

    double reach_;
    std::array<Axis, 3> axes_;
    std::vector<std::size_t> first_;    ///< of each cell, in bodies_
    std::vector<std::uint32_t> bodies_; ///< by cell
    std::vector<Vec3> places_;          ///< of bodies_
};

} // namespace carom::observe
