// A longbow of wood that shoots an arrow, in slow motion (Tournier et al. 2015, figure 7).
#include <cmath>

#include "builders.h"
#include "parts.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr int kStaveNodes[3] = {85, 3, 3};        // along the stave, thickness, breadth
constexpr double kStave[3] = {1.5, 0.024, 0.03};  // [m]
constexpr double kMiddle = 1.3;                   // height of the arrow [m]
constexpr double kDraw = 0.55;                    // [m]
constexpr double kDrawTime = 0.5;                 // [s]

// Along y from the lower tip, thickness along x. Tips are thinner: 0.55 of the middle.
Solid stave() {
    Solid wood = box_of_hexahedra(kStave, kStaveNodes, {-kStave[0] / 2, 0, 0});
    taut_solid_def_set_substance(&wood.def, TAUT_SUBSTANCE_WOOD);
    wood.def.young_modulus = 1e10f;
    wood.def.filter.mask = 0;
    for (taut_pos& p : wood.points) {
        const double along = p.x, thin = 1 - 0.45 * std::fabs(along) / (kStave[0] / 2);
        p = {-thin * (p.y - kStave[1] / 2), kMiddle + along, thin * (p.z - kStave[2] / 2)};
    }
    wood.look = {SoftColours::stress, 1e8, 0, ""};
    return wood;
}

}  // namespace

// The hand pulls the string's middle back and lets go. The arrow's nock rides on the string until this is straight.
Scene build_bow(double, double, const Options&) {
    constexpr double kArrow = 0.8, kArrowMass = 0.04, kStringMass = 0.012;
    constexpr int kSegments = 10;
    constexpr float kGive = 1e-5f;  // strain of the string by force [1/N]
    Scene scene = soft_hall(2);
    scene.world.time_step = 1.0f / 480;
    add_ground(scene);
    Solid wood = stave();
    const auto grip = kStaveNodes[0] / 2;
    for (int i = grip - 2; i <= grip + 2; ++i)
        for (int j = 0; j < kStaveNodes[1]; ++j)
            for (int k = 0; k < kStaveNodes[2]; ++k) wood.pinned.push_back(box_vertex(kStaveNodes, i, j, k));
    const uint32_t tips[2] = {box_vertex(kStaveNodes, 1, 0, 1), box_vertex(kStaveNodes, kStaveNodes[0] - 2, 0, 1)};
    const taut_pos ends[2] = {wood.points[tips[0]], wood.points[tips[1]]};
    scene.add_solid(std::move(wood));

    // The string in two halves, each a cable of rods, from the tips to the nocking point, a particle.
    const taut_pos nock = {(ends[0].x + ends[1].x) / 2, kMiddle, 0};
    Body point = crate(-1, nock, kStringMass / (2 * kSegments), Look::hidden);
    point.kind = TAUT_BODY_PARTICLE;
    const int nocking = scene.add_body(point);
    for (int half = 0; half < 2; ++half) {
        Cable string = cable_along(scene, TAUT_CABLE_PARTICLES, {ends[half], nock}, kWorld, nocking, 0.006,
                                   kStringMass / (ends[1].y - ends[0].y));
        string.def.segment_count = kSegments / 2;
        string.def.stretch_compliance = kGive;
        string.def.filter.mask = 0;
        string.end_vertex[0].solid = 0;
        string.end_vertex[0].vertex = tips[half];
        string.def.end[0].anchor = string.def.end[1].anchor = {0, 0, 0};
        scene.add_cable(string);
    }

    const int arrow = add_capsule(scene, nock, {nock.x - kArrow, kMiddle, 0}, 0.004, kArrowMass, Look::paint, -1);
    Joint on_string = joint_at(scene, TAUT_JOINT_BALL, arrow, nocking, nock);
    on_string.anchor_b = {0, 0, 0};
    on_string.drawn_radius = 0.007;
    Body hand = crate(sphere_shape(scene, 0.03), {nock.x + 0.012, kMiddle, 0}, 0, Look::skin);
    hand.kind = TAUT_BODY_KINEMATIC;
    hand.group = -1;
    const int pulls = scene.add_body(hand);
    Motion draw;
    draw.body = pulls;
    draw.along = {1, 0, 0};
    draw.track.keys = {{0, 0, 0}, {kDrawTime, kDraw, 0}};
    scene.motions.push_back(draw);
    Joint hold = joint_at(scene, TAUT_JOINT_BALL, pulls, nocking, nock);
    hold.anchor_b = {0, 0, 0};
    hold.until = kDrawTime + 0.1;
    hold.drawn_radius = 0;
    // A rest keeps the arrow level while it is on the string.
    Joint rest = joint_at(scene, TAUT_JOINT_SLIDER, kWorld, arrow, nock);
    // Hand, nock and rest give a little: together they hold the nocking point more often than once.
    hold.compliance = on_string.compliance = rest.compliance = 1e-7f;
    rest.angular_compliance = 1e-4f;
    on_string.until = rest.until = hold.until + 0.0225;
    for (const Joint& joint : {hold, on_string, rest}) scene.add_joint(joint);
    scene.forces = ForceScale{0, 4};

    Body target = crate(box_shape(scene, 0.2, 0.35, 0.35), {-6, 1.15, 0}, 0, Look::wood);
    target.kind = TAUT_BODY_STATIC;
    scene.add_body(target);
    scene.camera = {{-0.9, 1.45, 2.9}, {-0.45, 1.3, 0}, 38};
    scene.stage = {{-7, 0, -1}, {1.5, 2.4, 1}};
    return scene;
}

}  // namespace scenes
