#include <carom/base.hpp>

#include <utility>

namespace carom {

namespace {

std::string message(const std::string& field, const std::string& reason, std::size_t index) {
    if (index == Error::no_index) return field + ": " + reason;
    return field + "[" + std::to_string(index) + "]: " + reason;
}

} // namespace

const char* to_string(ErrorCode code) noexcept {
    switch (code) {
    case ErrorCode::not_finite:
        return "not_finite";
    case ErrorCode::out_of_range:
        return "out_of_range";
    case ErrorCode::overlap:
        return "overlap";
    case ErrorCode::unknown_body:
        return "unknown_body";
    case ErrorCode::size_mismatch:
        return "size_mismatch";
    case ErrorCode::out_of_world:
        return "out_of_world";
    case ErrorCode::bad_data:
        return "bad_data";
    case ErrorCode::not_available:
        return "not_available";
    case ErrorCode::input_output:
        return "input_output";
    }
    return "unknown";
}

Error::Error(ErrorCode code, std::string field, const std::string& reason, std::size_t index)
    : std::runtime_error(message(field, reason, index)), code_(code), field_(std::move(field)), index_(index) {}

} // namespace carom
