// Stands in for the viewer where its packages are not installed.
#include "viewer/film/render.hpp"
#include "viewer/window/view.hpp"

#include <carom/base.hpp>

namespace carom::viewer {

namespace {

[[noreturn]] void fail() {
    throw Error(ErrorCode::not_available, "viewer",
                "this carom was built without it; install libepoxy-dev, libglfw3-dev, libimgui-dev and libpng-dev, "
                "and build again");
}

} // namespace

bool is_film(const std::filesystem::path& file) { return file.extension() == ".mp4"; }

// NOLINTNEXTLINE(performance-unnecessary-value-param): the viewer that this stands in for takes it over
bool render(scene::Subject /*subject*/, const RenderOptions& /*options*/,
            const std::function<bool(const RenderProgress&)>& /*go_on*/) {
    fail();
}

std::vector<std::future<void>> view(const ViewOptions& /*options*/, const std::function<bool()>& /*stop*/) { fail(); }

} // namespace carom::viewer
