/// \file
/// The checks at the door: bad input becomes an Error that names the field.
#pragma once

#include "space/motion.hpp"

#include <carom/base.hpp>
#include <carom/body.hpp>

#include <cmath>
#include <string>

namespace carom::core {

/// A number as an error message shows it: short, and the same in every locale.
std::string shown(double value);

inline void check_finite(double value, const std::string& field, std::size_t index = Error::no_index) {
    if (!std::isfinite(value)) throw Error(ErrorCode::not_finite, field, "must be finite, got " + shown(value), index);
}

inline void check_finite(const Vec3& value, const std::string& field, std::size_t index = Error::no_index) {
    check_finite(value.x, field, index);
    check_finite(value.y, field, index);
    check_finite(value.z, field, index);
}

inline void check_not_negative(double value, const std::string& field, std::size_t index = Error::no_index) {
    check_finite(value, field, index);
    if (value < 0) throw Error(ErrorCode::out_of_range, field, "must be >= 0, got " + shown(value), index);
}

inline void check_positive(double value, const std::string& field, std::size_t index = Error::no_index) {
    check_finite(value, field, index);
    if (!(value > 0)) throw Error(ErrorCode::out_of_range, field, "must be > 0, got " + shown(value), index);
}

inline void check_fraction(double value, const std::string& field, std::size_t index = Error::no_index) {
    check_finite(value, field, index);
    if (value < 0 || value > 1) {
        throw Error(ErrorCode::out_of_range, field, "must lie in [0, 1], got " + shown(value), index);
    }
}

void check_law(const RestitutionLaw& law, const std::string& field, std::size_t index);

/// A position of the API (m, relative to `origin`) in units. Throws Error{out_of_world} naming the resolution that
/// would do.
Int3 position_units(const Vec3& metres, const Resolution& resolution, const Int3& origin, const std::string& field,
                    std::size_t index = Error::no_index);

/// What to do about a distance of `metres` from the zero of the world that its resolution cannot represent: the
/// resolution to set, if there is one.
std::string remedy_for(double metres);

} // namespace carom::core
