/// \file
/// Long numbers for people.
#pragma once

#include <string>
#include <string_view>

namespace carom::scene {

/// Puts `separator` between groups of three digits, counted from the right: "1 234 567".
inline std::string group_digits(std::string_view digits, std::string_view separator) {
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text.append(separator);
        text.push_back(digits[i]);
    }
    return text;
}

} // namespace carom::scene
