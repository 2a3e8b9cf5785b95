#include "viewer/render/gl/program.hpp"

#include <carom/base.hpp>

#include <array>

namespace carom::viewer::gl {

namespace {

ShaderHandle make_shader(const std::string& name, GLenum kind, const ShaderText& text) {
    std::vector<const char*> parts;
    std::vector<GLint> sizes;
    for (const std::string_view part : text) {
        parts.push_back(part.data());
        sizes.push_back(static_cast<GLint>(part.size()));
    }
    ShaderHandle shader(glCreateShader(kind));
    glShaderSource(shader.get(), static_cast<GLsizei>(parts.size()), parts.data(), sizes.data());
    glCompileShader(shader.get());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return shader;
    std::array<char, 2000> log{};
    glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw Error(ErrorCode::not_available, "OpenGL",
                std::string("the driver does not compile the ") + (kind == GL_VERTEX_SHADER ? "vertex" : "fragment") +
                    " shader '" + name + "':\n" + log.data());
}

} // namespace

ProgramHandle make_program(const std::string& name, const ShaderText& vertex, const ShaderText& fragment) {
    const ShaderHandle first = make_shader(name, GL_VERTEX_SHADER, vertex);
    const ShaderHandle second = make_shader(name, GL_FRAGMENT_SHADER, fragment);
    ProgramHandle program(glCreateProgram());
    glAttachShader(program.get(), first.get());
    glAttachShader(program.get(), second.get());
    glLinkProgram(program.get());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) return program;
    std::array<char, 2000> log{};
    glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw Error(ErrorCode::not_available, "OpenGL",
                "the driver does not link the shader '" + name + "':\n" + log.data());
}

} // namespace carom::viewer::gl
