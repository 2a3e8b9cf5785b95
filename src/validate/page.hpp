/// \file
/// The report as a web page.
#pragma once

#include "validate/report.hpp"

#include <string>

namespace carom::validate {

/// One HTML document that needs nothing else: plots as inline SVG, and the table. The same report gives the same bytes.
std::string page(const Report& report, Extent extent);

} // namespace carom::validate
