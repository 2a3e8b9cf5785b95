/// \file
/// The one exception type that carom throws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace carom {

/// What kind of mistake an Error reports.
enum class ErrorCode : std::uint8_t {
    not_finite,    ///< NaN or infinity where a finite number is needed
    out_of_range,  ///< a finite number outside the domain of its field
    overlap,       ///< a body would overlap another body, or reach through a face of the region
    unknown_body,  ///< an id that is stale, was never given out or belongs to another world
    size_mismatch, ///< arrays of one call have different lengths
    out_of_world,  ///< a body leaves the range that the world's resolution can represent
    bad_data,      ///< a snapshot that is truncated, altered, foreign or of another version
    not_available, ///< the call needs something that the world was not created with
    input_output,  ///< a file could not be read or written
};

/// The name of a code, as it stands in this header ("out_of_range").
const char* to_string(ErrorCode code) noexcept;

/// Thrown by every public function on bad input, before any state has changed.
class Error : public std::runtime_error {
public:
    /// `index` value of an error that is about no element of an array.
    static constexpr std::size_t no_index = static_cast<std::size_t>(-1);

    /// The message of what() reads "field[index]: reason", or "field: reason" without an index.
    Error(ErrorCode code, std::string field, const std::string& reason, std::size_t index = no_index);

    [[nodiscard]] ErrorCode code() const noexcept { return code_; }
    /// The name of the argument or member that was refused, for example "radius".
    [[nodiscard]] const std::string& field() const noexcept { return field_; }
    /// Position in the caller's array, or no_index.
    [[nodiscard]] std::size_t index() const noexcept { return index_; }

private:
    ErrorCode code_;
    std::string field_;
    std::size_t index_;
};

} // namespace carom
