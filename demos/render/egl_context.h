// An OpenGL 3.3 core context without window, screen or X server.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace render {

// No platform gave a context; what() lists each one tried and why it failed.
class NoEglDevice : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class EglContext {
public:
    // Tries Mesa's surfaceless platform, then every EGL device in turn. Throws NoEglDevice.
    EglContext();
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    const std::string& platform() const { return platform_; }
    const std::string& renderer() const { return renderer_; }
    const std::string& version() const { return version_; }
    bool software() const { return software_; }

private:
    bool open(void* display, const std::string& platform);
    bool open_surfaceless();
    bool open_devices();

    void* display_ = nullptr;
    void* context_ = nullptr;
    std::string platform_, renderer_, version_;
    bool software_ = false;
    std::vector<std::string> tried_;  // one line a failed attempt
};

}  // namespace render
