#include "space/checks.hpp"

#include <array>
#include <charconv>

namespace carom::core {

std::string shown(double value) {
    std::array<char, 32> text{};
    const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), value);
    return std::string(text.data(), end);
}

double resolution_for(double metres) {
    int exponent = 0;
    std::frexp(metres / static_cast<double>(world_edge), &exponent);
    return std::ldexp(1.0, exponent);
}

Int3 position_units(const Vec3& metres, const Resolution& resolution, const Int3& origin, const std::string& field,
                    std::size_t index) {
    check_finite(metres, field, index);
    constexpr auto edge = static_cast<double>(world_edge);
    const Vec3 from_zero = metres * resolution.per_metre + to_metres(origin, {1, 1});
    for (int axis = 0; axis < 3; ++axis) {
        const double distance = std::abs(component(from_zero, axis));
        if (distance < edge && std::abs(component(metres, axis)) * resolution.per_metre < edge) continue;
        throw Error(ErrorCode::out_of_world, field,
                    "outside the world of +-" + shown(edge * resolution.metres) + " m; set the resolution to " +
                        shown(resolution_for(distance * resolution.metres)) + " m or more",
                    index);
    }
    return round_to_units(metres, resolution) + origin;
}

} // namespace carom::core
