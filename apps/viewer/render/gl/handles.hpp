/// \file
/// Objects of OpenGL that end with their scope.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace carom::viewer::gl {

/// The number of an object, and what deletes it.
template <auto Delete>
class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint number) : number_(number) {}
    ~Handle() { reset(); }
    Handle(Handle&& other) noexcept : number_(std::exchange(other.number_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        if (this != &other) {
            reset();
            number_ = std::exchange(other.number_, 0);
        }
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    [[nodiscard]] GLuint get() const { return number_; }

private:
    void reset() {
        if (number_ != 0) Delete(number_);
        number_ = 0;
    }

    GLuint number_ = 0;
};

inline void delete_buffer(GLuint number) { glDeleteBuffers(1, &number); }
inline void delete_texture(GLuint number) { glDeleteTextures(1, &number); }
inline void delete_framebuffer(GLuint number) { glDeleteFramebuffers(1, &number); }
inline void delete_vertex_array(GLuint number) { glDeleteVertexArrays(1, &number); }
inline void delete_program(GLuint number) { glDeleteProgram(number); }
inline void delete_shader(GLuint number) { glDeleteShader(number); }

using BufferHandle = Handle<delete_buffer>;
using TextureHandle = Handle<delete_texture>;
using FramebufferHandle = Handle<delete_framebuffer>;
using VertexArrayHandle = Handle<delete_vertex_array>;
using ProgramHandle = Handle<delete_program>;
using ShaderHandle = Handle<delete_shader>;

inline BufferHandle make_buffer() {
    GLuint number = 0;
    glCreateBuffers(1, &number);
    return BufferHandle(number);
}

inline VertexArrayHandle make_vertex_array() {
    GLuint number = 0;
    glCreateVertexArrays(1, &number);
    return VertexArrayHandle(number);
}

inline FramebufferHandle make_framebuffer() {
    GLuint number = 0;
    glCreateFramebuffers(1, &number);
    return FramebufferHandle(number);
}

/// A texture without smaller copies of itself.
inline TextureHandle make_texture(GLenum format, int width, int height, GLint filter) {
    GLuint number = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &number);
    glTextureStorage2D(number, 1, format, width, height);
    glTextureParameteri(number, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(number, GL_TEXTURE_MAG_FILTER, filter);
    glTextureParameteri(number, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(number, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return TextureHandle(number);
}

} // namespace carom::viewer::gl
