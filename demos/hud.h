// Figures and legends over the picture.
#pragma once

#include <string>
#include <vector>

#include "render/draw_list.h"
#include "scene_view.h"

namespace demo {

// What the panel shows.
struct HudFigures {
    std::string scene, description;
    uint32_t frame = 0, frames = 0;  // of frames; 0: nobody knows of how many, nor the time
    double time = 0;                 // simulated [s]
    double step_ms = 0, budget_ms = 0;
    double joint_error = 0, worst_joint_error = 0;  // now, and so far [m]
    bool has_joints = false;                        // rigid ones
    uint32_t bodies = 0, joints = 0, pairs = 0, points = 0, asleep = 0;
    size_t broken = 0;  // joints so far
};

void add_hud(render::DrawList& list, const HudFigures& figures);

// A figure over time, a value a step. Its axis goes from the least value, or 0, to the largest.
struct HudCurve {
    std::string label;  // with its unit
    std::vector<float> values;
    bool from_zero = true;
};
// Panels at the upper right; the axis of time is that of all steps of the film.
void add_curves(render::DrawList& list, const std::vector<HudCurve>& curves, uint32_t steps,
                const render::HudCanvas& canvas);

// What one side of a picture shows, and its joint error [m] now and so far.
struct Caption {
    std::string text;
    double joint_error = 0, worst = 0;
};
void add_caption(render::DrawList& list, const Caption& caption, float centre, const render::HudCanvas& canvas);
void add_tension_legend(render::DrawList& list, const TensionScale& scale, const render::HudCanvas& canvas);
// What the colours of cloths and solids tell, at the right: scales of strain and stress, and names of plain colours.
void add_soft_legend(render::DrawList& list, const scenes::Scene& scene, const render::HudCanvas& canvas);

}  // namespace demo
