// The pictures of a run: drawn, and written as PNG files and as a video.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "options.h"
#include "render/renderer.h"
#include "video.h"

namespace demo {

class Film {
public:
    // name: of the files. frames_per_second: of the video. Throws render::NoEglDevice, std::runtime_error.
    Film(const Options& options, const std::string& name, double frames_per_second);

    render::Renderer& renderer() { return *renderer_; }
    void add(const render::DrawList& list, uint32_t frame);  // from 0
    void finish();
    void describe(nlohmann::ordered_json& json) const;
    void print_summary() const;

private:
    std::string frame_path(uint32_t frame) const;

    const Options& options_;
    std::string name_;
    std::unique_ptr<Video> video_;
    std::unique_ptr<render::Renderer> renderer_;
    uint32_t drawn_ = 0, first_ = 0, last_ = 0;
    double draw_sum_ms_ = 0, write_sum_ms_ = 0;
};

}  // namespace demo
