#include "scene/picture.hpp"

#include "collision/portable_math.hpp"
#include "scene/digit_groups.hpp"

#include <algorithm>
#include <cmath>

namespace carom::scene {

namespace {

/// About how wide a text in UTF-8 is.
double text_width(std::string_view text) {
    const auto is_first_byte = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
    return 7.6 * static_cast<double>(std::count_if(text.begin(), text.end(), is_first_byte));
}

/// Digits behind the point that tell neighbouring lines of the grid apart.
int decimals_of(double tick) { return std::max(0, -static_cast<int>(std::floor(std::log10(tick) + 1e-9))); }

/// A number at a line of the grid: plain, or as a power of ten.
std::string tick_text(const Scale& scale, double value) {
    if (!scale.logarithmic)
        return number_text(std::abs(value) < 1e-6 * scale.tick ? 0 : value, decimals_of(scale.tick));
    const auto power = static_cast<int>(std::lround(std::log10(value)));
    if (power == 0) return "1";
    return fmt::format(R"(10<tspan dy="-5" style="font-size:10px">{}</tspan>)", number_text(power, 0));
}

} // namespace

double round_up(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double digit : {1.0, 2.0, 5.0}) {
        if (value <= digit * power * (1 + 1e-9)) return digit * power;
    }
    return 10 * power;
}

double Scale::at(double value) const {
    const double part = logarithmic ? detail::log(value / low) / detail::log(high / low) : (value - low) / (high - low);
    return from + part * (to - from);
}

std::vector<double> Scale::ticks() const {
    std::vector<double> values;
    if (logarithmic) {
        const auto last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
        for (auto power = static_cast<int>(std::ceil(std::log10(low) - 1e-9)); power <= last; ++power) {
            values.push_back(std::pow(10.0, power));
        }
        return values;
    }
    const auto last = static_cast<int>(std::floor(high / tick + 1e-9));
    for (auto i = static_cast<int>(std::ceil(low / tick - 1e-9)); i <= last; ++i) values.push_back(i * tick);
    return values;
}

Scale round_scale(double low, double high, int ticks, double from, double to) {
    if (!(high > low)) high = low + 1;
    const double tick = round_up((high - low) / ticks);
    return {std::floor(low / tick + 1e-9) * tick, std::ceil(high / tick - 1e-9) * tick, tick, from, to, false};
}

Scale logarithmic_scale(double low, double high, double from, double to) {
    const double first = std::floor(std::log10(low) + 1e-9);
    const double last = std::ceil(std::log10(high) - 1e-9);
    return {std::pow(10.0, first), std::pow(10.0, std::max(last, first + 1)), 1, from, to, true};
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '&')
            result += "&amp;";
        else if (static_cast<unsigned char>(c) >= 0x20)
            result += c;
    }
    return result;
}

std::string number_text(double value, int decimals) {
    const std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
    const std::size_t point = std::min(text.find('.'), text.size());
    return fmt::format("{}{}{}", value < 0 ? "\u2212" : "", group_digits(text.substr(0, point), "\u202f"),
                       text.substr(point));
}

Picture::Picture(double width, double height, std::string_view style) {
    add(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}">)", width, height);
    text_ += '\n';
    text_ += style;
    add(R"(<rect class="paper" width="{}" height="{}"/>)", width, height);
    text_ += '\n';
}

void Picture::text(double x, double y, std::string_view classes, std::string_view markup) {
    add("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", classes, x, y, markup);
}

void Picture::line(std::string_view classes, double x1, double y1, double x2, double y2) {
    add("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", classes, x1, y1, x2, y2);
}

void Picture::bar(std::string_view classes, double x, double y, double bar_width, double bar_height) {
    add("<rect class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>\n", classes, x, y, bar_width,
        bar_height);
}

void Picture::dot(std::string_view classes, double x, double y, double radius) {
    add("<circle class=\"{}\" cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.1f}\"/>\n", classes, x, y, radius);
}

void Picture::curve(std::string_view classes, const std::vector<std::array<double, 2>>& points) {
    add("<path class=\"line {}\" d=\"", classes);
    for (std::size_t i = 0; i < points.size(); ++i) {
        add("{}{:.2f},{:.2f}", i == 0 ? "M" : i == 1 ? "L" : " ", points[i][0], points[i][1]);
    }
    text_ += "\"/>\n";
}

double Picture::legend(double end, double y, std::string_view classes, std::string_view name, bool is_bar) {
    const double sample = is_bar ? 13 : 26;
    const double start = end - text_width(name) - sample - 7;
    if (is_bar)
        bar(classes, start, y - 11, sample, 13);
    else
        line(fmt::format("line {}", classes), start, y - 4.5, start + sample, y - 4.5);
    text(start + sample + 7, y, "left", name);
    return start - 22;
}

std::string Picture::take() {
    text_ += "</svg>\n";
    return std::move(text_);
}

void draw_y_axis(Picture& picture, const Scale& y, double left, double right) {
    for (const double value : y.ticks()) {
        const bool is_zero = !y.logarithmic && std::abs(value) < 1e-6 * y.tick;
        picture.line(is_zero ? "axis" : "rule", left, y.at(value), right, y.at(value));
        picture.text(left - 8, y.at(value) + 4.5, "right", tick_text(y, value));
    }
}

void draw_x_axis(Picture& picture, const Scale& x, double top, double bottom, bool with_numbers) {
    for (const double value : x.ticks()) {
        picture.line("rule", x.at(value), top, x.at(value), bottom);
        if (with_numbers) picture.text(x.at(value), bottom + 20, "middle", tick_text(x, value));
    }
}

} // namespace carom::scene
