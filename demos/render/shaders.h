// GLSL of the renderer.
#pragma once

namespace render::shaders {

extern const char* const kLight;          // functions that the lit fragment shaders begin with
extern const char* const kSolidVertex;    // instanced meshes
extern const char* const kSolidFragment;  // sun with soft shadows, sky light, fog
extern const char* const kDepthFragment;  // shadow maps
extern const char* const kGroundVertex;
extern const char* const kGroundFragment;
extern const char* const kSkyVertex;
extern const char* const kSkyFragment;
extern const char* const kScreenVertex;
extern const char* const kAroundFragment;  // light that things near by keep off, and
extern const char* const kAroundBlur;      // its mean over each square of the pattern
extern const char* const kHudVertex;
extern const char* const kHudFragment;

}  // namespace render::shaders
