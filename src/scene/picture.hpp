/// \file
/// Pictures as SVG documents: what plots share.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom::scene {

/// The round number (1, 2 or 5 times a power of ten) next above `value` > 0.
double round_up(double value);

/// Maps values of one axis, in its unit, to the picture.
struct Scale {
    double low = 0;
    double high = 1;
    double tick = 1; ///< between two lines of the grid; on a logarithmic axis they stand at powers of ten
    double from = 0; ///< where `low` lies
    double to = 1;   ///< where `high` lies
    bool logarithmic = false;

    [[nodiscard]] double at(double value) const;
    /// The values at lines of the grid.
    [[nodiscard]] std::vector<double> ticks() const;
};

/// A scale with round ends that holds `low` to `high` and has about `ticks` of them.
Scale round_scale(double low, double high, int ticks, double from, double to);
/// The same by powers of ten; `low` > 0.
Scale logarithmic_scale(double low, double high, double from, double to);

/// Text as XML has it.
std::string escaped(std::string_view text);

/// "31 415" with narrow spaces; `decimals` behind the point.
std::string number_text(double value, int decimals);

/// An SVG document that grows element by element.
class Picture {
public:
    /// `style`: an SVG style element, or nothing where the page has one.
    Picture(double width, double height, std::string_view style);

    void text(double x, double y, std::string_view classes, std::string_view markup);
    void line(std::string_view classes, double x1, double y1, double x2, double y2);
    void bar(std::string_view classes, double x, double y, double bar_width, double bar_height);
    void dot(std::string_view classes, double x, double y, double radius);
    void curve(std::string_view classes, const std::vector<std::array<double, 2>>& points);
    /// Names a curve or bar in a row that grows to the left; returns where the next entry ends.
    double legend(double end, double y, std::string_view classes, std::string_view name, bool is_bar);
    std::string take();

private:
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }

    std::string text_;
};

/// Lines of the grid and numbers, left of `left`.
void draw_y_axis(Picture& picture, const Scale& y, double left, double right);
void draw_x_axis(Picture& picture, const Scale& x, double top, double bottom, bool with_numbers);

} // namespace carom::scene
