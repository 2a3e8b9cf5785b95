/// \file
/// The table of two-body cases that is compiled in.
#pragma once

#include <string_view>

namespace carom::validate {

/// tests/data/two_body.json as it was when this was built: cases in exact rational arithmetic.
std::string_view two_body_cases();

} // namespace carom::validate
