#include "validate/page.hpp"
namespace carom::validate {
std::string page(const Report&, Extent) { return {}; }
}
