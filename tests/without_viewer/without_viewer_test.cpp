// A carom that is built without the viewer's packages says so.
#include "viewer/film/render.hpp"
#include "viewer/window/view.hpp"

#include <carom/base.hpp>

#include <gtest/gtest.h>

#include <string>
#include <tuple>

namespace carom::viewer {
namespace {

template <class Call>
void expect_not_available(const Call& call) {
    try {
        call();
        ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::not_available);
        EXPECT_NE(std::string(error.what()).find("built without it; install"), std::string::npos) << error.what();
    }
}

TEST(WithoutViewer, ViewAndRenderSaySo) {
    expect_not_available([] { render(scene::Subject(), {}, {}); });
    expect_not_available([] { std::ignore = view({}, {}); });
}

} // namespace
} // namespace carom::viewer
