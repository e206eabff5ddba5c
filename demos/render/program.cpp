#include "program.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace render {

namespace {

GLuint compile(GLenum stage, std::initializer_list<const char*> parts) {
    std::vector<const char*> sources = {"#version 330 core\n"};
    sources.insert(sources.end(), parts);
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, static_cast<GLsizei>(sources.size()), sources.data(), nullptr);
    glCompileShader(shader);
    GLint ok = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    std::vector<char> log(4096, '\0');
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    glDeleteShader(shader);
    throw std::runtime_error(std::string("the GL driver refused a shader: ") + log.data());
}

void check_complete(const char* what) {
    if (GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER); status != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error(std::string("the GL driver refused the ") + what + " framebuffer, status " +
                                 std::to_string(status));
}

}  // namespace

Program::Program(std::initializer_list<const char*> vertex, std::initializer_list<const char*> fragment) {
    GLuint stages[2] = {compile(GL_VERTEX_SHADER, vertex), compile(GL_FRAGMENT_SHADER, fragment)};
    name_ = glCreateProgram();
    for (GLuint stage : stages) glAttachShader(name_, stage);
    glLinkProgram(name_);
    for (GLuint stage : stages) glDeleteShader(stage);
    GLint ok = GL_FALSE;
    glGetProgramiv(name_, GL_LINK_STATUS, &ok);
    if (!ok) throw std::runtime_error("the GL driver could not link a program");
}

Program::~Program() { glDeleteProgram(name_); }

GLint Program::location(const char* uniform) {
    auto [entry, is_new] = locations_.try_emplace(uniform, -1);
    if (is_new) entry->second = glGetUniformLocation(name_, uniform);
    return entry->second;
}

DepthMap::DepthMap(int size_in_texels) : size(size_in_texels) {
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
    for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    check_complete("shadow");
}

DepthMap::~DepthMap() {
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
}

void DepthMap::fit(Vec3 direction, Vec3 low, Vec3 high) {
    axes = view_axes(direction);
    Vec3 view_low = {1e9f, 1e9f, 1e9f}, view_high = view_low * -1.0f;
    for (int corner = 0; corner < 8; ++corner) {
        Vec3 p = {corner & 1 ? low.x : high.x, corner & 2 ? low.y : high.y, corner & 4 ? low.z : high.z};
        Vec3 v = {dot(axes.right, p), dot(axes.up, p), dot(axes.back, p)};
        view_low = {std::min(view_low.x, v.x), std::min(view_low.y, v.y), std::min(view_low.z, v.z)};
        view_high = {std::max(view_high.x, v.x), std::max(view_high.y, v.y), std::max(view_high.z, v.z)};
    }
    // Room for things that leave the box on the side of the light.
    view_high.z += 10.0f;
    clip_from_world = orthographic(view_low, view_high) * view_matrix({0, 0, 0}, axes);
    texel = std::max(view_high.x - view_low.x, view_high.y - view_low.y) / static_cast<float>(size);
    scale_x = 1 / (view_high.x - view_low.x);
    scale_y = 1 / (view_high.y - view_low.y);
    depth = view_high.z - view_low.z;
}

namespace {

GLuint texture_in(GLuint framebuffer, GLenum attachment, GLint format, GLenum channels, int width, int height) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, channels, GL_FLOAT, nullptr);
    for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
    return texture;
}

}  // namespace

AroundMap::AroundMap(int picture_width, int picture_height)
    : width((picture_width + 1) / 2), height((picture_height + 1) / 2) {
    for (GLuint* framebuffer : {&depth_framebuffer, &found_framebuffer, &blurred_framebuffer})
        glGenFramebuffers(1, framebuffer);
    depths =
        texture_in(depth_framebuffer, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, width, height);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    check_complete("depth");
    found = texture_in(found_framebuffer, GL_COLOR_ATTACHMENT0, GL_RG32F, GL_RG, width, height);
    check_complete("obscurance");
    blurred = texture_in(blurred_framebuffer, GL_COLOR_ATTACHMENT0, GL_RG32F, GL_RG, width, height);
    check_complete("blurred");
}

AroundMap::~AroundMap() {
    for (GLuint* framebuffer : {&depth_framebuffer, &found_framebuffer, &blurred_framebuffer})
        glDeleteFramebuffers(1, framebuffer);
    for (GLuint* texture : {&depths, &found, &blurred}) glDeleteTextures(1, texture);
}

PictureTarget::PictureTarget(int width, int height, int wanted_samples) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    samples = std::min<int>(wanted_samples, most);
    glGenFramebuffers(1, &drawn);
    glGenFramebuffers(1, &resolved);
    glGenRenderbuffers(3, buffers_);
    allocate(width, height);
}

void PictureTarget::allocate(int width, int height) {
    glBindFramebuffer(GL_FRAMEBUFFER, drawn);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers_[0]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_SRGB8_ALPHA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers_[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers_[1]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers_[1]);
    check_complete("picture");
    glBindFramebuffer(GL_FRAMEBUFFER, resolved);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers_[2]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers_[2]);
    check_complete("read-back");
}

PictureTarget::~PictureTarget() {
    glDeleteFramebuffers(1, &drawn);
    glDeleteFramebuffers(1, &resolved);
    glDeleteRenderbuffers(3, buffers_);
}

}  // namespace render
