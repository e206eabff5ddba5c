// GLSL of the renderer.
#pragma once

namespace render::shaders {

extern const char* const kLight;          // functions that the lit fragment shaders begin with
extern const char* const kSolidVertex;    // instanced meshes
extern const char* const kSolidFragment;  // sun with shadow map, sky light, fog
extern const char* const kDepthFragment;  // shadow maps
extern const char* const kGroundVertex;
extern const char* const kGroundFragment;
extern const char* const kSkyVertex;
extern const char* const kSkyFragment;
extern const char* const kHudVertex;
extern const char* const kHudFragment;

}  // namespace render::shaders
