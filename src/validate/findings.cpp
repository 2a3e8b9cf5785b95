#include "validate/findings.hpp"

#include <cmath>
#include <utility>

namespace carom::validate {

namespace {

constexpr double most_sigmas = 4;

} // namespace

std::optional<double> Row::percent() const {
    if (reference == 0) return std::nullopt;
    return 100 * (measured - reference) / std::abs(reference);
}

Row exact_row(Claim claim, double reference, double measured, double admitted) {
    Row row{.claim = std::move(claim), .reference = reference, .measured = measured, .admitted = admitted};
    row.passed = std::abs(measured - reference) <= admitted;
    return row;
}

Row statistical_row(Claim claim, const Estimate& reference, const Estimate& measured, double admitted) {
    Row row{.claim = std::move(claim), .reference = reference.value, .measured = measured.value, .admitted = admitted};
    row.standard_error = std::sqrt(reference.standard_error * reference.standard_error +
                                   measured.standard_error * measured.standard_error);
    const double deviation = measured.value - reference.value;
    row.sigmas = deviation / row.standard_error;
    row.passed =
        std::abs(*row.sigmas) <= most_sigmas && std::abs(deviation) <= admitted && measured.standard_error <= admitted;
    return row;
}

Estimate mean_of(std::span<const double> values) {
    const auto count = static_cast<double>(values.size());
    double sum = 0;
    for (const double value : values) sum += value;
    const double mean = sum / count;
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return {mean, std::sqrt(squares / (count * (count - 1)))};
}

} // namespace carom::validate
