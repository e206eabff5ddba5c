#include "film.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "png_file.h"

namespace demo {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

}  // namespace

Film::Film(const Options& options, const std::string& name, double frames_per_second) : options_(options), name_(name) {
    if (!options.video.empty())
        video_ = std::make_unique<Video>(options.video, options.width, options.height, frames_per_second);
    if (!options.out.empty()) std::filesystem::create_directories(options.out);
    renderer_ = std::make_unique<render::Renderer>(render::RendererOptions{options.width, options.height, 4, 2048});
    std::fprintf(stderr, "%s\n", renderer_->description().c_str());
}

void Film::add(const render::DrawList& list, uint32_t frame) {
    auto begin = Clock::now();
    const render::Picture& picture = renderer_->draw(list);
    draw_sum_ms_ += ms_since(begin);
    begin = Clock::now();
    if (!options_.out.empty()) write_png(frame_path(frame), picture);
    if (video_) video_->add(picture);
    write_sum_ms_ += ms_since(begin);
    if (drawn_++ == 0) first_ = frame;
    last_ = frame;
}

void Film::finish() {
    if (video_) video_->finish();
}

std::string Film::frame_path(uint32_t frame) const {
    char number[16];
    std::snprintf(number, sizeof number, "_%05u.png", frame);
    return (std::filesystem::path(options_.out) / (name_ + number)).string();
}

void Film::describe(nlohmann::ordered_json& json) const {
    json["size"] = std::to_string(options_.width) + "x" + std::to_string(options_.height);
    json["gl_renderer"] = renderer_->gl_renderer();
    json["software"] = renderer_->software();
    json["samples"] = renderer_->samples();
    json["drawn"] = drawn_;
    json["mean_draw_ms"] = draw_sum_ms_ / std::max(1u, drawn_);
    json["mean_write_ms"] = write_sum_ms_ / std::max(1u, drawn_);
    if (!options_.out.empty()) json["out"] = options_.out;
    if (!options_.video.empty()) json["video"] = options_.video;
}

void Film::print_summary() const {
    const auto file = [this](uint32_t frame) { return std::filesystem::path(frame_path(frame)).filename().string(); };
    if (!options_.out.empty() && drawn_ > 0)
        std::fprintf(stderr, "frames: %u PNG in %s, %s to %s\n", drawn_, options_.out.c_str(), file(first_).c_str(),
                     file(last_).c_str());
    if (video_) std::fprintf(stderr, "video: %u frames in %s\n", drawn_, options_.video.c_str());
}

}  // namespace demo
