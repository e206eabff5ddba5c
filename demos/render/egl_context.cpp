#include "egl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdio>

namespace render {

namespace {

std::string egl_error() {
    switch (EGLint code = eglGetError(); code) {
        case EGL_SUCCESS:
            return "no EGL error given";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED: no driver could start";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER: platform not known to the driver";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS: no permission";
        default: {
            std::array<char, 16> text{};
            std::snprintf(text.data(), text.size(), "0x%x", static_cast<unsigned>(code));
            return text.data();
        }
    }
}

// EGL's own stub returns a pointer for any name, so extensions decide what may be called.
bool client_has(const char* extension) { return epoxy_has_egl_extension(EGL_NO_DISPLAY, extension); }

bool is_software(const std::string& renderer) {
    return renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos ||
           renderer.find("swrast") != std::string::npos || renderer.find("SWR") != std::string::npos;
}

std::string gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text ? reinterpret_cast<const char*>(text) : "unknown";
}

}  // namespace

EglContext::EglContext() {
    // epoxy aborts the program when the library is missing, so look first.
    if (void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
        if (open_surfaceless() || open_devices()) return;
        dlclose(library);
    } else {
        tried_.emplace_back("libEGL.so.1: not installed");
    }
    std::string text = "no usable EGL device for OpenGL 3.3; tried:";
    for (const std::string& line : tried_) text += "\n  " + line;
    text += "\nInstall a driver (Debian: libegl1 libgl1-mesa-dri), or run with --no-render.";
    throw NoEglDevice(text);
}

EglContext::~EglContext() {
    if (!display_) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
}

bool EglContext::open_surfaceless() {
    if (!client_has("EGL_MESA_platform_surfaceless") || !client_has("EGL_EXT_platform_base")) {
        tried_.emplace_back("surfaceless platform: not offered by this EGL library");
        return false;
    }
    return open(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                "surfaceless platform");
}

bool EglContext::open_devices() {
    if (!client_has("EGL_EXT_platform_device") || !client_has("EGL_EXT_device_enumeration")) {
        tried_.emplace_back("device platform: not offered by this EGL library");
        return false;
    }
    std::array<EGLDeviceEXT, 32> devices{};
    EGLint count = 0;
    if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) || count == 0) {
        tried_.emplace_back("device platform: no devices listed (" + egl_error() + ")");
        return false;
    }
    for (EGLint i = 0; i < count; ++i) {
        const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        std::string name = "device " + std::to_string(i) + " (" + (extensions ? extensions : "no extensions") + ")";
        if (open(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr), name)) return true;
    }
    return false;
}

bool EglContext::open(void* display, const std::string& platform) {
    auto fail = [&](const std::string& why) {
        tried_.emplace_back(platform + ": " + why);
        return false;
    };
    if (display == EGL_NO_DISPLAY) return fail("no display (" + egl_error() + ")");
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display, &major, &minor)) return fail("eglInitialize failed (" + egl_error() + ")");
    auto abandon = [&](const std::string& why) {
        eglTerminate(display);
        return fail(why);
    };
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context"))
        return abandon("EGL_KHR_surfaceless_context is missing");
    if (!eglBindAPI(EGL_OPENGL_API)) return abandon("desktop OpenGL is not supported (" + egl_error() + ")");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint config_count = 0;
    eglChooseConfig(display, wanted, &config, 1, &config_count);
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLContext context =
        eglCreateContext(display, config_count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) return abandon("no OpenGL 3.3 core context (" + egl_error() + ")");
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        std::string why = "context without surface refused (" + egl_error() + ")";
        eglDestroyContext(display, context);
        return abandon(why);
    }
    display_ = display;
    context_ = context;
    platform_ = platform;
    renderer_ = gl_string(GL_RENDERER);
    version_ = gl_string(GL_VERSION);
    software_ = is_software(renderer_);
    return true;
}

}  // namespace render
