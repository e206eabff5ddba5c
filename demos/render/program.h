// GL programs, buffers and framebuffers that free themselves.
#pragma once

#include <epoxy/gl.h>

#include <initializer_list>
#include <map>
#include <string>

#include "matrix.h"

namespace render {

class Program {
public:
    // Sources of one stage are joined after the version line. Throws std::runtime_error with the compiler's log.
    Program(std::initializer_list<const char*> vertex, std::initializer_list<const char*> fragment);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void use() const { glUseProgram(name_); }
    // Values for the program in use; a uniform that the compiler dropped is ignored.
    void set(const char* uniform, int value) { glUniform1i(location(uniform), value); }
    void set(const char* uniform, float value) { glUniform1f(location(uniform), value); }
    void set(const char* uniform, float x, float y) { glUniform2f(location(uniform), x, y); }
    void set(const char* uniform, Vec3 v) { glUniform3f(location(uniform), v.x, v.y, v.z); }
    void set(const char* uniform, const Mat4& m) { glUniformMatrix4fv(location(uniform), 1, GL_FALSE, m.m.data()); }

private:
    GLint location(const char* uniform);

    GLuint name_ = 0;
    std::map<std::string, GLint> locations_;
};

// Depth of the world from far away along one direction, compared by the sampler.
struct DepthMap {
    DepthMap(int size_in_texels);
    ~DepthMap();
    DepthMap(const DepthMap&) = delete;
    DepthMap& operator=(const DepthMap&) = delete;

    // Fits the map around the box low..high, seen along direction.
    void fit(Vec3 direction, Vec3 low, Vec3 high);

    int size;
    GLuint texture = 0, framebuffer = 0;
    Mat4 clip_from_world;
    ViewAxes axes;
    float texel = 0, scale_x = 0, scale_y = 0;  // size of a texel in the world [m]; of the map along its axes [1/m]
    float depth = 0;                            // of its box [m]
};

// A picture of half the size that says of each place how far away it is, and how much light things near by keep off.
struct AroundMap {
    AroundMap(int picture_width, int picture_height);
    ~AroundMap();
    AroundMap(const AroundMap&) = delete;
    AroundMap& operator=(const AroundMap&) = delete;

    int width, height;
    GLuint depths = 0, found = 0, blurred = 0;  // textures
    GLuint depth_framebuffer = 0, found_framebuffer = 0, blurred_framebuffer = 0;
};

// Multisampled colour and depth with a plain colour target that they are resolved to.
struct PictureTarget {
    PictureTarget(int width, int height, int wanted_samples);
    ~PictureTarget();
    PictureTarget(const PictureTarget&) = delete;
    PictureTarget& operator=(const PictureTarget&) = delete;

    GLuint drawn = 0, resolved = 0;  // framebuffers
    int samples = 0;

private:
    void allocate(int width, int height);

    GLuint buffers_[3] = {};
};

}  // namespace render
