// Films through ffmpeg.
#pragma once

#include <sys/types.h>

#include <string>

#include "render/renderer.h"

namespace demo {

class Video {
public:
    // Starts ffmpeg. Throws std::runtime_error if it isn't on PATH or can't be started.
    Video(const std::string& path, int width, int height, double frames_per_second);
    ~Video();
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;

    void add(const render::Picture& picture);  // throws std::runtime_error when ffmpeg is gone
    void finish();                             // throws std::runtime_error when ffmpeg failed

private:
    std::string path_;
    int pipe_ = -1;
    pid_t process_ = -1;
};

}  // namespace demo
