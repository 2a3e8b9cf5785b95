#include "viewer/render/gl/context.hpp"

#include <carom/base.hpp>

#include <dlfcn.h>
#include <epoxy/egl.h>

#include <array>
#include <string>

namespace carom::viewer::gl {

namespace {

[[noreturn]] void fail(const std::string& reason) { throw Error(ErrorCode::not_available, "OpenGL", reason); }

/// epoxy ends the program where a library is missing, so it is asked for only if it is there.
void need_library(const char* name) {
    void* library = ::dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) fail(std::string(name) + " is missing: install libegl1 and libgl1-mesa-dri");
    ::dlclose(library);
}

class SurfacelessContext final : public Context {
public:
    SurfacelessContext() {
        need_library("libEGL.so.1");
        need_library("libGL.so.1");
        if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") ||
            !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
            fail("this EGL cannot draw without a display (EGL_MESA_platform_surfaceless)");
        }
        display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE) {
            fail("EGL finds no driver: install libgl1-mesa-dri");
        }
        eglBindAPI(EGL_OPENGL_API);
        constexpr std::array<EGLint, 7> wanted{
            EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
        if (context_ == EGL_NO_CONTEXT ||
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
            close();
            fail("the driver has no OpenGL 4.5 core, which drawing needs");
        }
    }
    ~SurfacelessContext() override { close(); }
    SurfacelessContext(const SurfacelessContext&) = delete;
    SurfacelessContext& operator=(const SurfacelessContext&) = delete;

private:
    void close() {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

} // namespace

std::unique_ptr<Context> make_surfaceless_context() { return std::make_unique<SurfacelessContext>(); }

} // namespace carom::viewer::gl
