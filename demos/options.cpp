#include "options.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>

#include "scenes/catalogue.h"

namespace demo {

namespace {

constexpr int kBadArguments = 2;
constexpr int kLeastSide = 64, kMostSide = 8192;  // [pixels]

void print_scenes() {
    for (const scenes::Family& family : scenes::families())
        std::printf("%-22s %s (as in %s)\n", family.pattern, family.description, family.example);
}

// "1280x720", both even because videos need it.
bool read_size(const std::string& text, Options& options) {
    int width = 0, height = 0, used = 0;
    if (std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &used) != 2) return false;
    if (static_cast<size_t>(used) != text.size() || width < kLeastSide || height < kLeastSide) return false;
    if (width > kMostSide || height > kMostSide || width % 2 != 0 || height % 2 != 0) return false;
    options.width = width;
    options.height = height;
    return true;
}

}  // namespace

std::optional<Options> read_options(int argc, char** argv, int* exit_code) {
    Options options;
    std::string size = "1280x720";
    uint32_t frames = 0, substeps = 0;
    std::string solver;
    bool list = false, no_render = false, no_hud = false, tension = true;
    CLI::App app{
        "Runs a scene of Taut and renders it without a window.\n"
        "Exit codes: 0 fine, 1 the run failed, 2 bad arguments, 3 no usable EGL device."};
    CLI::Option* scene_flag = app.add_option("--scene", options.scene, "scene by name, see --list (default: main)");
    app.add_flag("--list", list, "print all scenes");
    CLI::Option* frames_flag = app.add_option("--frames", frames, "frames, one step each (default: the scene's)")
                                   ->check(CLI::Range(1, 1000000));
    app.add_option("--every", options.every, "draw one frame of so many")->check(CLI::Range(1, 1000000));
    app.add_option("--from", options.from, "draw none of the frames before this one")->check(CLI::Range(1, 1000000));
    app.add_option("--out", options.out, "folder for PNG frames (default: out; none with --video alone)");
    app.add_option("--size", size, "picture size, WxH (default: 1280x720)");
    app.add_option("--video", options.video, "film, made by ffmpeg");
    app.add_option("--json", options.json, "also write the figures to this file");
    CLI::Option* gltf_flag =
        app.add_option("--gltf", options.gltf,
                       "animated glTF 2.0 file (.glb) of the drawn frames; draws none without --out or --video");
    CLI::Option* csv_flag =
        app.add_option("--csv", options.csv, "table of the poses of bodies and vertices in those frames");
    CLI::Option* record_flag = app.add_option("--record", options.record, "recording of the run, for taut-replay");
    app.add_option("--threads", options.threads, "threads of a step")->check(CLI::Range(1, 64));
    CLI::Option* seed_flag =
        app.add_option("--seed", options.seed, "above 0: a random start, the same for the same seed");
    CLI::Option* swept_flag =
        app.add_flag("--swept", options.swept, "cloths and solids are swept, not solved directly");
    app.add_flag("--from-point", options.from_point, "what begins tangled has all its vertices in one point");
    app.add_flag("!--no-line-search", options.line_search, "minimisation takes each of Newton's steps as it comes");
    CLI::Option* mesh_flag =
        app.add_option("--mesh", options.mesh, "mesh file of the scene; without a scene an OBJ file for mesh_drop");
    CLI::Option* cloth_flag =
        app.add_option("--cloth", options.mesh, "OBJ file that becomes a cloth (scene cloth_file)")
            ->excludes(mesh_flag);
    CLI::Option* solid_flag = app.add_option("--solid", options.mesh,
                                             "file that becomes a solid (scene solid_file): .msh (Gmsh), .node and "
                                             ".ele (TetGen), or a closed surface as .obj")
                                  ->excludes(mesh_flag)
                                  ->excludes(cloth_flag);
    CLI::Option* urdf_flag = app.add_option("--urdf", options.mesh, "URDF file of a robot (scene robot)")
                                 ->excludes(mesh_flag)
                                 ->excludes(cloth_flag)
                                 ->excludes(solid_flag);
    CLI::Option* substeps_flag =
        app.add_option("--substeps", substeps, "least substeps of a step")->check(CLI::Range(1, 64));
    CLI::Option* solver_flag =
        app.add_option("--solver", solver, "one of taut_solver: block_ldlt, projected_gauss_seidel ...");
    app.add_flag("--no-render", no_render, "simulate only");
    app.add_flag("--no-hud", no_hud, "leave out the figures in the picture");
    CLI::Option* sleep_flag = app.add_flag("--sleep", options.sleep, "let what came to rest sleep; it is drawn darker");
    CLI::Option* contacts_flag =
        app.add_flag("--contacts", options.contacts, "draw contact points, with needles as long as their forces");
    CLI::Option* curves_flag =
        app.add_flag("--curves", options.curves, "draw curves of energy, joint error and step time");
    CLI::Option* compare_flag =
        app.add_flag("--compare", options.compare, "draw the same scene without geometric stiffness beside it");
    app.add_flag("--follow", options.follow, "the camera keeps all that moves in its frame")->excludes(compare_flag);
    CLI::Option* tension_flag = app.add_flag("--tension,!--no-tension", tension,
                                             "colour joints by their force (default: on in scenes with joints)");
    CLI::Option* replay_flag = app.add_option(
        "--replay", options.replay,
        "draw a recording (of --record or of any program) in place of a scene, and tell whether it comes out the same");
    for (CLI::Option* of_scenes :
         {scene_flag, mesh_flag, cloth_flag, solid_flag, urdf_flag, gltf_flag, csv_flag, record_flag, seed_flag,
          swept_flag, substeps_flag, solver_flag, sleep_flag, contacts_flag, curves_flag, compare_flag, tension_flag})
        replay_flag->excludes(of_scenes);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        *exit_code = app.exit(error, std::cout, std::cerr) == 0 ? 0 : kBadArguments;
        return std::nullopt;
    }
    if (list) {
        print_scenes();
        *exit_code = 0;
        return std::nullopt;
    }
    if (!read_size(size, options)) {
        std::fprintf(stderr, "--size: '%s' is not WxH with even numbers from %d to %d\n", size.c_str(), kLeastSide,
                     kMostSide);
        *exit_code = kBadArguments;
        return std::nullopt;
    }
    if (frames_flag->count() > 0) options.frames = frames;
    if (substeps_flag->count() > 0) options.substeps = substeps;
    if (solver_flag->count() > 0) options.solver = solver;
    if (tension_flag->count() > 0) options.tension = tension;
    if (!options.mesh.empty() && scene_flag->count() == 0)
        options.scene = cloth_flag->count() > 0   ? "cloth_file"
                        : solid_flag->count() > 0 ? "solid_file"
                        : urdf_flag->count() > 0  ? "robot"
                                                  : "mesh_drop";
    const bool pictures = !options.out.empty() || !options.video.empty();
    options.render = !no_render && (pictures || (options.gltf.empty() && options.csv.empty()));
    options.hud = !no_hud;
    if (!pictures) options.out = "out";
    return options;
}

}  // namespace demo
