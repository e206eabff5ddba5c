// Writes pictures.
#pragma once

#include <string>

#include "render/renderer.h"

namespace demo {

// Writes a PNG with settings for speed. Throws std::runtime_error naming the file.
void write_png(const std::string& path, const render::Picture& picture);

}  // namespace demo
