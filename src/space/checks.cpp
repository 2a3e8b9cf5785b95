#include "space/checks.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace carom::core {

std::string shown(double value) {
    std::array<char, 32> text{};
    const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), value);
    return std::string(text.data(), end);
}

void check_law(const RestitutionLaw& law, const std::string& field, std::size_t index) {
    if (const auto* power = std::get_if<PowerLaw>(&law)) {
        check_positive(power->restitution, field + ".restitution", index);
        check_fraction(power->restitution, field + ".restitution", index);
        check_positive(power->speed, field + ".speed", index);
        check_not_negative(power->exponent, field + ".exponent", index);
    } else {
        const auto& viscoelastic = std::get<Viscoelastic>(law);
        check_not_negative(viscoelastic.dissipation, field + ".dissipation", index);
        check_not_negative(viscoelastic.modulus, field + ".modulus", index);
    }
}

std::string remedy_for(double metres) {
    if (!(metres < std::ldexp(static_cast<double>(world_edge), largest_resolution_exponent))) {
        return "no resolution reaches that far";
    }
    int exponent = 0;
    std::frexp(metres / static_cast<double>(world_edge), &exponent);
    return "set the resolution to " + shown(std::ldexp(1.0, exponent)) + " m or more";
}

Int3 position_units(const Vec3& metres, const Resolution& resolution, const Int3& origin, const std::string& field,
                    std::size_t index) {
    check_finite(metres, field, index);
    constexpr auto edge = static_cast<double>(world_edge);
    const double half_size = edge * resolution.metres;
    const Vec3 from_zero = metres + to_metres(origin, resolution);
    for (int axis = 0; axis < 3; ++axis) {
        const double distance = std::max(std::abs(component(from_zero, axis)), std::abs(component(metres, axis)));
        if (distance < half_size) continue;
        throw Error(ErrorCode::out_of_world, field,
                    "outside the world of +-" + shown(half_size) + " m; " + remedy_for(distance), index);
    }
    return round_to_units(metres, resolution) + origin;
}

} // namespace carom::core
