#include "video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace demo {

namespace {

std::string find_on_path(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        std::string file = folder + "/" + program;
        if (!folder.empty() && access(file.c_str(), X_OK) == 0) return file;
    }
    return {};
}

}  // namespace

Video::Video(const std::string& path, int width, int height, double frames_per_second) : path_(path) {
    std::string ffmpeg = find_on_path("ffmpeg");
    if (ffmpeg.empty())
        throw std::runtime_error(
            "--video needs ffmpeg, which is not on PATH (Debian: apt-get install ffmpeg); "
            "--out writes PNG frames without it");
    std::string size = std::to_string(width) + "x" + std::to_string(height);
    char rate[32];
    std::snprintf(rate, sizeof rate, "%.6g", frames_per_second);
    std::vector<std::string> words = {
        ffmpeg,       "-loglevel", "error", "-y", "-f",       "rawvideo", "-pixel_format", "rgb24", "-video_size", size,
        "-framerate", rate,        "-i",    "-",  "-pix_fmt", "yuv420p",  "-crf",          "18",    "file:" + path};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    // ffmpeg's words are not our figures.
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    int error = posix_spawn(&process_, ffmpeg.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    pipe_ = ends[1];
    if (error != 0) {
        close(pipe_);
        throw std::runtime_error("cannot start " + ffmpeg + ": " + std::strerror(error));
    }
    std::signal(SIGPIPE, SIG_IGN);  // a dead ffmpeg shows as a failed write
}

Video::~Video() {
    if (pipe_ >= 0) close(pipe_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
}

void Video::add(const render::Picture& picture) {
    const uint8_t* at = picture.rgb.data();
    size_t left = picture.rgb.size();
    while (left > 0) {
        ssize_t count = write(pipe_, at, left);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) throw std::runtime_error("ffmpeg stopped taking frames of " + path_);
        at += count;
        left -= static_cast<size_t>(count);
    }
}

void Video::finish() {
    close(pipe_);
    pipe_ = -1;
    int status = 0;
    pid_t done = waitpid(process_, &status, 0);
    process_ = -1;
    if (done < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("ffmpeg failed on " + path_);
}

}  // namespace demo
