#include "catalogue.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "builders.h"

namespace scenes {

namespace {

constexpr double kLeastR = 1e-3, kMostR = 1e15;
constexpr uint32_t kNewtonSteps = 100;  // of a step, where nothing makes them converge

// Matches a name against a pattern and reads the numbers in place of N and R.
bool match(const std::string& pattern, const std::string& name, double& n, double& r) {
    size_t at = 0;
    for (char c : pattern) {
        if (c != 'N' && c != 'R') {
            if (at >= name.size() || name[at++] != c) return false;
            continue;
        }
        if (at >= name.size() || !std::isdigit(static_cast<unsigned char>(name[at]))) return false;
        size_t end = at;
        if (c == 'N') {
            while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end]))) ++end;
            n = std::strtod(name.substr(at, end - at).c_str(), nullptr);
        } else {
            std::string rest = name.substr(at);
            char* stop = nullptr;
            r = std::strtod(rest.c_str(), &stop);
            if (rest.find_first_of("xXpP") != std::string::npos) return false;
            end = at + static_cast<size_t>(stop - rest.c_str());
        }
        at = end;
    }
    return at == name.size();
}

// A description with the numbers of a name in place of N and R.
std::string filled(const std::string& description, double n, double r) {
    std::string text;
    const auto in_word = [&](size_t at) {
        return at < description.size() && std::isalnum(static_cast<unsigned char>(description[at])) != 0;
    };
    for (size_t i = 0; i < description.size(); ++i) {
        const char c = description[i];
        if ((c != 'N' && c != 'R') || in_word(i + 1) || (i > 0 && in_word(i - 1))) {
            text += c;
            continue;
        }
        char number[32];
        std::snprintf(number, sizeof number, "%.6g", c == 'N' ? n : r);
        text += number;
    }
    return text;
}

void check_range(const std::string& scene, const char* what, double value, double low, double high) {
    if (value >= low && value <= high) return;
    char range[64];
    std::snprintf(range, sizeof range, "between %g and %g", low, high);
    throw BadScene("scene '" + scene + "': " + what + " must lie " + range);
}

}  // namespace

const std::vector<Family>& families() {
    static const std::vector<Family> list = {
        {"main", "main", "ten 1 kg links swing a 1000 kg ball into a brick wall", 240, false, build_main, 0},
        {"boxes2000", "boxes2000", "2000 cubes dropped into a walled bin", 600, false, build_boxes2000, 0},
        {"pyramidN", "pyramid30", "planar pyramid of cubes, N at the base", 600, false, build_pyramid, 200},
        {"stackN", "stack20", "N cubes exactly on each other", 600, false, build_stack, 1000},
        {"heavy_on_light_rR", "heavy_on_light_r1000", "R kg on a stack of ten 1 kg cubes", 600, false,
         build_heavy_on_light, 0},
        {"chainN_rR", "chain10_r1000", "N 1 kg links and R kg, released from horizontal", 600, false, build_chain,
         1000},
        {"cableN_rR", "cable50_r1000", "10 m cable of N rods hung with R tonnes (Tournier 2015, table 1)", 1000, false,
         build_cable, 2000},
        {"falling_cableN", "falling_cable100", "cable of N rods, mass ratio 1:100, falls from horizontal", 500, false,
         build_falling_cable, 2000},
        {"chain_over_edge_rR", "chain_over_edge_r1000", "twenty 1 kg links on a box pulled over its edge by R kg", 600,
         false, build_chain_over_edge, 0},
        {"wrecking_ball", "wrecking_ball", "eight 1 kg links swing a 1000 kg ball into 50 cubes", 600, false,
         build_wrecking_ball, 0},
        {"deep_start", "deep_start", "a cube made 0.2 m inside the ground", 300, false, build_deep_start, 0},
        {"swing_rR", "swing_r100", "ten 1 kg links and R kg swing freely from 30 degrees", 1800, false, build_swing, 0},
        {"crane", "crane", "a derrick lifts 5 t on 10 m and 500 kg of cable that it hauls in", 1200, false, build_crane,
         0},
        {"cable_drum", "cable_drum", "cables over a fixed drum, a driven one, and reeled round a third", 900, false,
         build_cable_drum, 0},
        {"bridge", "bridge", "a truck of 8 t drives over a suspension bridge", 720, false, build_bridge, 0},
        {"bridge_breaking", "bridge_breaking", "the same truck on a bridge that is too weak", 720, false,
         build_bridge_breaking, 0},
        {"hingesN", "hinges50", "N bodies on hinges that stop at 20 degrees", 600, false, build_hinges, 200},
        {"ragdoll_liana", "ragdoll_liana", "a ragdoll of 12 bodies on a liana of 10 links that is shaken", 720, false,
         build_ragdoll_liana, 0},
        {"ferris_wheelN", "ferris_wheel10", "a Ferris wheel of N cars turned by a motor", 720, false,
         build_ferris_wheel, 40},
        {"tensegrity", "tensegrity", "six struts held apart by 24 tight ropes, dropped", 360, false, build_tensegrity,
         0},
        {"netN", "net12", "N x N bodies tied by ball joints, hung by three corners", 300, false, build_net, 100},
        {"shapesN", "shapes200", "N bodies of all kinds of shapes poured into a bin", 600, false, build_shapes, 2000},
        {"hullsN", "hulls100", "N hulls of 12 to 16 vertices poured into a bin", 600, false, build_hulls, 5000},
        {"ragdollsN", "ragdolls6", "N ragdolls of 12 bodies dropped into a bin", 600, false, build_ragdolls, 1000},
        {"static_gridN", "static_grid100", "a hundred balls among N x N boxes that stand", 200, false,
         build_static_grid, 1000, false, true},
        {"tippingN", "tipping1", "N poles of 22 boxes tip onto hills of triangles", 400, false, build_tipping, 40,
         false, true},
        {"joint_gridN", "joint_grid40", "N x N balls tied by ball joints, hung by a side", 300, false, build_joint_grid,
         200, false, true},
        {"crowdN", "crowd60", "N boxes of 1 kg in one place", 300, false, build_crowd, 2000, false, true},
        {"rainN", "rain50", "N ragdolls fall on a grid of beams", 600, false, build_rain, 1000, false, true},
        {"washer", "washer", "8000 cubes in a drum that turns", 300, false, build_washer, 0, false, true},
        {"convex_mesh", "convex_mesh", "a thousand hulls on 20 000 triangles", 300, false, build_convex_mesh, 0, false,
         true},
        {"grainsN_rR", "grains300_r1", "N grains of friction R poured onto a rough bed", 600, false, build_grains,
         20000},
        {"grains_boxN", "grains_box300", "N grains fall as a lattice into a box", 300, false, build_grains_box, 20000},
        {"terrain", "terrain", "a hundred bodies dropped on hills and stairs of triangles", 600, false, build_terrain,
         0},
        {"cloth_hangN", "cloth_hang30", "a sheet of N x N vertices hung by two corners, released level", 240, false,
         build_cloth_hang, 200},
        {"cloth_rowN_rR", "cloth_row20_r100", "the same, the free row weighs R times the sheet more", 240, false,
         build_cloth_row, 200},
        {"cloth_load_rR", "cloth_load_r10", "a box of R times a sheet's mass falls on it", 240, false, build_cloth_load,
         0},
        {"beam_eR_nN", "beam_e1_n30", "a beam of R MPa and Poisson's ratio N/100, held at one end", 300, false,
         build_beam, 49},
        {"solidsN_eR", "solids3_e1e5", "N soft cubes of R Pa dropped beside each other", 240, false, build_solid_drop,
         50},
        {"tangled_cubeN_eR", "tangled_cube9_e1e5",
         "a cube of N^3 vertices and R Pa begins in random places (Gast and Schroeder 2014, figure 8)", 60, false,
         build_tangled_cube, 100, false, true},
        {"cube_stretchN_eR", "cube_stretch9_e1e5",
         "a cube of N^3 vertices and R Pa is stretched, then pushed back a little (ibid., figures 3 and 4)", 72, false,
         build_cube_stretch, 100, false, true},
        {"film_ballN_eR", "film_ball9_e3e5",
         "a ball of N^3 vertices falls hard, a film frame a step (ibid., figure 10)", 72, false, build_film_ball, 60,
         false, true},
        {"film_ballsN_eR", "film_balls9_e1e5", "one ball falls on another (ibid., figure 7)", 72, false,
         build_film_balls, 60, false, true},
        {"film_ringN_eR", "film_ring5_e3e4", "a ring falls and closes on itself (ibid., figure 6)", 72, false,
         build_film_ring, 30, false, true},
        {"film_holeN_eR", "film_hole5_e1e5", "a ring is pushed through a hole (ibid., figure 12)", 96, false,
         build_film_hole, 30, false, true},
        {"film_squeeze_eR", "film_squeeze_e1e5", "a figure between 32 cubes (ibid., figure 13)", 96, false,
         build_film_squeeze, 0, true, true},
        {"film_stackN_eR", "film_stack4_e1e5", "N x N boxes are struck (ibid., figure 14)", 60, false, build_film_stack,
         8, false, true},
        {"film_toriN_eR", "film_tori2_e1e5", "N^3 rings fall into a bowl (ibid., figure 1)", 480, false,
         build_film_tori, 5, false, true},
        {"armadillo_eR", "armadillo_e1e5", "a figure of R Pa falls on the ground", 240, false, build_armadillo, 0, true,
         true},
        {"cloth_loaded", "cloth_loaded", "balls of 500 vertices' mass hang on a sheet", 360, false, build_cloth_loaded,
         0},
        {"cloth_fem_beside_links", "cloth_fem_beside_links", "a sheet of links beside one of triangles", 300, false,
         build_cloth_fem_beside_links, 0},
        {"garmentN", "garment13", "a tunic of two panels sewn together, N vertices across", 480, false, build_garment,
         50, false, true},
        {"trampoline", "trampoline", "balls on a mat that hangs on springs in a frame", 480, false, build_trampoline,
         0},
        {"armadillos", "armadillos", "a figure of four materials falls on a step", 300, false, build_armadillos, 0,
         true, true},
        {"bow", "bow", "a bow of wood shoots an arrow, eight times slower", 400, false, build_bow, 0, false, true},
        {"knee", "knee", "a knee with ligaments, stretched and bent by a muscle", 420, false, build_knee, 0},
        {"quads", "quads", "patches of orthotropic quadrilaterals pulled", 300, false, build_quads, 0},
        {"tearing_flag", "tearing_flag", "a flag in a wind that tears it", 480, false, build_tearing_flag, 0},
        {"plastic_bar", "plastic_bar", "bars bent and let go, one of which yields", 300, false, build_plastic_bar, 0,
         false, true},
        {"plastic_barN", "plastic_bar7", "the same, of N vertices along", 300, false, build_plastic_bar_n, 100},
        {"meshlessN_eR", "meshless3_e1e5", "N cubes of R Pa of points without a mesh dropped", 240, false,
         build_meshless, 50, false, true},
        {"drape_sphere_rR", "drape_sphere_r1", "a sheet of 60 x 60 falls on a ball, friction R everywhere", 240, false,
         build_drape_sphere, 0, false, true},
        {"cloth_on_sphere", "cloth_on_sphere", "a sheet of 100 x 100 on a ball that begins to turn", 480, false,
         build_cloth_on_sphere, 0, false, true},
        {"cloth_twist", "cloth_twist", "both ends of a sheet are turned by two turns each", 300, false,
         build_cloth_twist, 0, false, true},
        {"cloth_fold", "cloth_fold", "a sheet falls edge on and folds into a heap", 240, false, build_cloth_fold, 0,
         false, true},
        {"flag_in_wind", "flag_in_wind", "a flag on a pole", 360, false, build_flag_in_wind, 0, false, true},
        {"bunnies_on_cloth", "bunnies_on_cloth", "rigid bunnies fall on a sheet held by its corners", 300, false,
         build_bunnies_on_cloth, 0, false, true},
        {"dragon_on_stairs", "dragon_on_stairs", "a soft dragon falls on stairs among boxes", 360, false,
         build_dragon_on_stairs, 0, true, true},
        {"cow_falls", "cow_falls", "a soft cow falls on the ground", 240, false, build_cow_falls, 0, true, true},
        {"torus_self", "torus_self", "a soft ring falls on its edge and closes on itself", 240, false, build_torus_self,
         0, false, true},
        {"soft_pile", "soft_pile", "four soft figures, a rigid one and crates fall on each other", 360, false,
         build_soft_pile, 0, true, true},
        {"soft_pileN", "soft_pile10", "N figures, each fifth rigid, and crates fall on each other", 360, false,
         build_soft_pile_n, 30, true, true},
        {"grains_on_cloth", "grains_on_cloth", "a thousand grains fall on a sheet of 20 x 20", 300, false,
         build_grains_on_cloth, 0, false, true},
        {"grains_through_mesh", "grains_through_mesh", "small grains pass a net of cables, large ones do not", 300,
         false, build_grains_through_mesh, 0, false, true},
        {"sand_on_table", "sand_on_table", "twenty thousand grains ploughed by rigid bodies", 480, false,
         build_sand_on_table, 0, false, true},
        {"garment_on_body", "garment_on_body", "a tunic on a body that steps and turns", 480, false,
         build_garment_on_body, 0, false, true},
        {"ragdoll_on_trampoline", "ragdoll_on_trampoline", "a ragdoll falls on a trampoline", 360, false,
         build_ragdoll_on_trampoline, 0, false, true},
        {"sack", "sack", "rocks in a bag of cloth that a cable lifts", 480, false, build_sack, 0, false, true},
        {"soft_car", "soft_car", "a car on tyres with gas drives over bumps", 480, false, build_soft_car, 0, false,
         true},
        {"tyre", "tyre", "a tyre with gas rolls over a plank and kerbs under its load", 480, false, build_tyre, 0,
         false, true},
        {"cloth_file", "cloth_file", "a cloth of an OBJ file falls on a ball", 360, true, build_cloth_file, 0},
        {"solid_file", "solid_file", "a solid of a mesh file falls on a step", 300, true, build_solid_file, 0, false,
         true},
        {"car", "car", "a car of wheel joints with a differential drives over hills", 480, false, build_car, 0},
        {"gearsN", "gears4", "N gears drive a rack, which lifts a crate by a rope over sheaves", 480, false,
         build_gears, 20},
        {"robot", "robot", "an arm with a gripper, or the robot of a URDF file, moves its joints", 600, false,
         build_robot, 0, true},
        {"mesh_drop", "mesh_drop", "hulls of a mesh file's pieces poured down stairs", 600, true, build_mesh_drop, 0},
    };
    return list;
}

Scene make_scene(const std::string& name, const Options& options) { return make_scene(name, options, families()); }

Scene make_scene(const std::string& name, const Options& options, const std::vector<Family>& among) {
    for (const Family& family : among) {
        double n = 1, r = 1;
        if (!match(family.pattern, name, n, r)) continue;
        if (family.largest_n > 0) check_range(name, "N", n, 1, family.largest_n);
        check_range(name, "R", r, kLeastR, kMostR);
        if (family.needs_mesh && options.mesh.empty()) throw BadScene("scene '" + name + "' needs a mesh: --mesh FILE");
        if (!family.needs_mesh && !family.takes_mesh && !options.mesh.empty())
            throw BadScene("scene '" + name + "' takes no mesh");
        Scene scene = family.build(n, r, options);
        if (!options.line_search) {
            scene.world.line_search = 0;
            scene.world.sweeps = kNewtonSteps;
        }
        if (options.swept) {
            for (Cloth& cloth : scene.cloths) cloth.def.solve = TAUT_DEFORMABLE_SWEPT;
            for (Solid& solid : scene.solids) solid.def.solve = TAUT_DEFORMABLE_SWEPT;
        }
        scene.name = name;
        scene.description = filled(family.description, n, r);
        scene.steps = family.steps;
        return scene;
    }
    std::string text = "no scene is called '" + name + "'; there are:";
    for (const Family& family : among) text += std::string(" ") + family.pattern;
    throw BadScene(text + " (N: a count, R: a number)");
}

}  // namespace scenes
