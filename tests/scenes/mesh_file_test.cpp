// Meshes of users: what is read from files, what is refused, and how a surface is filled.
#include <gmock/gmock.h>

#include <numbers>

#include "scenes/lattice.h"
#include "scenes/running_scene.h"
#include "scenes/soft_files.h"
#include "scenes/soft_meshes.h"
#include "scenes/tet_file.h"

namespace {

using namespace lab;

// Files of this process, gone with it.
class Files {
public:
    ~Files() {
        for (const std::string& path : made_) std::remove(path.c_str());
    }
    std::string operator()(const std::string& ending, const std::string& text) {
        made_.push_back(stem() + ending);
        std::ofstream(made_.back(), std::ios::binary) << text;
        return made_.back();
    }
    static std::string stem() { return testing::TempDir() + "taut_mesh_" + std::to_string(getpid()); }

private:
    std::vector<std::string> made_;
};

Vec at(const std::vector<taut_pos>& points, uint32_t i) { return {points[i].x, points[i].y, points[i].z}; }

double volume(const std::vector<taut_pos>& points, const uint32_t* v) {
    const Vec o = at(points, v[0]);
    return dot(at(points, v[1]) - o, cross(at(points, v[2]) - o, at(points, v[3]) - o)) / 6;
}

// Of tetrahedra, all of which must be the right way round.
double volume(const std::vector<taut_pos>& points, const std::vector<uint32_t>& cells) {
    double sum = 0;
    for (size_t c = 0; c < cells.size(); c += 4) {
        EXPECT_GT(volume(points, &cells[c]), 0) << "cell " << c / 4;
        sum += volume(points, &cells[c]);
    }
    return sum;
}

std::string refusal(const std::string& path) {
    try {
        const scenes::Solid solid = scenes::solid_from_file(path, 100);
        return "accepted, " + std::to_string(solid.points.size()) + " points";
    } catch (const scenes::BadFile& error) {
        return error.what();
    }
}

// ---------------------------------------------------------------- TetGen

// A pyramid of two tetrahedra, the second inside out, beside a point that nothing uses.
constexpr const char* kNodes =
    "# pyramid\n6 3 1 0\n\n1 0 0 0 7\n2 1 0 0 7\n3 1 1 0 7\n4 0 1 0 7 # corner\n5 9 9 9 7\n"
    "6 .5 .5 1 7\n";

TEST(TetGen, IsReadFromEitherOfItsFiles) {
    Files files;
    const std::string node = files(".node", kNodes), ele = files(".ele", "2 4 0\n0 1 2 3 6\n1 1 4 3 6\n");
    for (const std::string& path : {node, ele}) {
        const scenes::CellMesh mesh = scenes::read_tetgen(path);
        ASSERT_EQ(mesh.points.size(), 5u);
        EXPECT_EQ(mesh.corners, 4u);
        EXPECT_EQ(mesh.points[4].z, 1);
        EXPECT_NEAR(volume(mesh.points, mesh.cells), 1.0 / 3, 1e-12);
    }
}

struct Bad {
    const char* name;
    const char* node;
    const char* ele;
    const char* says;
};

class BadTetGen : public testing::TestWithParam<Bad> {};
INSTANTIATE_TEST_SUITE_P(
    File, BadTetGen,
    testing::Values(
        Bad{"NoTetrahedra", kNodes, "0 4 0\n", ".ele:1: there are no tetrahedra"},
        Bad{"UnknownPoint", kNodes, "1 4 0\n0 1 2 3 77\n", ".ele:2: no point has the number 77"},
        Bad{"TooFewNodes", kNodes, "1 3 0\n0 1 2 3\n", ".ele:1: a tetrahedron needs four nodes"},
        Bad{"LineCutShort", kNodes, "1 4 0\n0 1 2 3\n", ".ele:2: node of a tetrahedron is missing"},
        Bad{"FileCutShort", kNodes, "3 4 0\n0 1 2 3 6\n", ".ele:2: the file ends before all tetrahedra"},
        Bad{"CountTooLarge", "99999999999999999999 3 0 0\n", "1 4 0\n", ".node:1: number of points is not a whole"},
        Bad{"CountBeyondMemory", "4000000000 3 0 0\n", "1 4 0\n", ".node:1: number of points is not a whole"},
        Bad{"NegativeCount", "-4 3 0 0\n", "1 4 0\n", ".node:1: number of points is not a whole"},
        Bad{"Flat", "4 2 0 0\n", "1 4 0\n", ".node:1: points must have three coordinates"},
        Bad{"NotANumber", "1 3 0 0\n0 a 0 0\n", "1 4 0\n", ".node:2: x is not a number: 'a'"},
        Bad{"NotFinite", "1 3 0 0\n0 0 nan 0\n", "1 4 0\n", ".node:2: y is not within 1e6: 'nan'"},
        Bad{"Infinite", "1 3 0 0\n0 0 0 1e999\n", "1 4 0\n", ".node:2: z is not within 1e6"},
        Bad{"TwiceTheSame", "2 3 0 0\n0 0 0 0\n0 1 0 0\n", "1 4 0\n", ".node:3: a second point with the number 0"},
        Bad{"Empty", "", "1 4 0\n", ".node:1: the file is empty"},
        Bad{"OnlyComments", "# nothing\n", "1 4 0\n", ".node:1: the file ends before the number of points"}),
    [](const auto& each) { return std::string(each.param.name); });

TEST_P(BadTetGen, IsRefusedWithFileAndLine) {
    Files files;
    const std::string path = files(".node", GetParam().node);
    files(".ele", GetParam().ele);
    EXPECT_THAT(refusal(path), testing::HasSubstr(GetParam().says));
}

TEST(TetGen, WithoutItsOtherFileIsRefused) {
    Files files;
    EXPECT_THAT(refusal(files(".node", kNodes)), testing::HasSubstr(".ele:1: cannot be read"));
}

// ---------------------------------------------------------------- Gmsh

constexpr const char* kGmsh2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"rock\"\n$EndPhysicalNames\n$Nodes\n5\n10 0 0 0\n"
    "20 1 0 0\n30 1 1 0\n40 0 1 0\n60 .5 .5 1\n$EndNodes\n$Elements\n3\n1 2 2 1 1 10 20 30\n2 4 2 1 1 10 20 30 60\n"
    "3 4 2 1 1 10 40 30 60\n$EndElements\n";
constexpr const char* kGmsh4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n$Nodes\n2 5 10 60\n"
    "2 1 0 2\n10\n20\n0 0 0\n1 0 0\n3 1 0 3\n30\n40\n60\n1 1 0\n0 1 0\n.5 .5 1\n$EndNodes\n$Elements\n2 3 1 3\n"
    "2 1 2 1\n1 10 20 30\n3 1 4 2\n2 10 20 30 60\n3 10 40 30 60\n$EndElements\n";

TEST(Gmsh, IsReadInBothVersions) {
    Files files;
    const scenes::CellMesh old = scenes::read_gmsh(files(".msh", kGmsh2));
    const scenes::CellMesh mesh = scenes::read_gmsh(files(".msh", kGmsh4));
    EXPECT_EQ(mesh.cells, old.cells);
    ASSERT_EQ(mesh.points.size(), 5u);
    EXPECT_NEAR(volume(mesh.points, mesh.cells), 1.0 / 3, 1e-12);
    EXPECT_NEAR(volume(old.points, old.cells), 1.0 / 3, 1e-12);
}

TEST(Gmsh, OfHexahedraIsSimulatedAsItIs) {
    Files files;
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n";
    const char* corners[] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"};
    for (int i = 0; i < 8; ++i) text += std::to_string(i + 1) + " " + corners[i] + "\n";
    text += "$EndNodes\n$Elements\n1\n1 5 0 1 2 3 4 5 6 7 8\n$EndElements\n";
    scenes::Options options;
    options.mesh = files(".msh", text);
    RunningScene run(scenes::make_scene("solid_file", options));
    EXPECT_EQ(run.scene.solids[0].def.corners, 8u);
    for (int i = 0; i < 30; ++i) run.step();
    EXPECT_TRUE(run.sound());
}

struct BadText {
    const char* name;
    std::string text;
    const char* says;
};

// The text with one part of it replaced.
std::string with(std::string text, const std::string& part, const std::string& other) {
    const size_t found = text.find(part);
    EXPECT_NE(found, std::string::npos) << part;
    return text.replace(found, part.size(), other);
}

class BadGmsh : public testing::TestWithParam<BadText> {};
INSTANTIATE_TEST_SUITE_P(
    File, BadGmsh,
    testing::Values(
        BadText{"Binary", with(kGmsh4, "4.1 0 8", "4.1 1 8"), ":2: a binary file; save it as ASCII"},
        BadText{"BinaryBytes", std::string("$MeshFormat\n\0\1\2", 15), ":2: binary data"},
        BadText{"OldVersion", with(kGmsh2, "2.2 0", "1.0 0"), ":2: version 1.0, not 2 or 4.1"},
        BadText{"OtherVersion", with(kGmsh4, "4.1 0", "4.0 0"), ":2: version 4.0, not 2 or 4.1"},
        BadText{"NoFormat", "$Nodes\n0\n$EndNodes\n", ":1: not a Gmsh file"},
        BadText{"Prose", "Once upon a time", ":1: a section was expected, not 'Once'"},
        BadText{"NoEnd", with(kGmsh2, "$EndElements\n", ""), "the file ends before $EndElements"},
        BadText{"TooManyNodes", with(kGmsh2, "$Nodes\n5", "$Nodes\n4"), "more lines than $Nodes tells"},
        BadText{"TooFewNodes", with(kGmsh2, "$Nodes\n5", "$Nodes\n6"), "number of a node is not a whole number"},
        BadText{"BlocksDoNotAddUp", with(kGmsh4, "2 5 10 60", "2 6 10 60"), "there are 5 nodes, not 6"},
        BadText{"HugeBlock", with(kGmsh4, "2 1 0 2", "2 1 0 999999999999"), "size of a block is not a whole number"},
        BadText{"HugeCount", with(kGmsh2, "$Elements\n3", "$Elements\n18446744073709551615"),
                "number of elements is not a whole number"},
        BadText{"UnknownNode", with(kGmsh2, "10 20 30 60", "10 20 30 61"), "no point has the number 61"},
        BadText{"ManyTags", with(kGmsh2, "2 4 2 1", "2 4 99999999999 1"), "number of an element's tags is not"},
        BadText{"SurfaceOnly", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n",
                "there are neither tetrahedra nor hexahedra"},
        BadText{"BothKinds", with(kGmsh2, "1 2 2 1 1 10 20 30", "1 5 0 10 20 30 40 10 20 30 40"),
                "both tetrahedra and hexahedra"}),
    [](const auto& each) { return std::string(each.param.name); });

TEST_P(BadGmsh, IsRefusedWithFileAndLine) {
    Files files;
    EXPECT_THAT(refusal(files(".msh", GetParam().text)), testing::HasSubstr(GetParam().says));
}

// Cells without volume pass the reader; the library refuses them, and the message names the file.
TEST(Gmsh, OfFlatCellsIsRefusedByName) {
    Files files;
    scenes::Options options;
    options.mesh = files(".msh", with(kGmsh2, ".5 .5 1", ".5 .5 0"));
    try {
        const scenes::Scene scene = scenes::make_scene("solid_file", options);
        scenes::TautWorld world(scene);
        FAIL() << "accepted";
    } catch (const std::exception& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(options.mesh));
    }
}

TEST(SolidFile, OfAnotherKindIsRefused) {
    EXPECT_THAT(refusal("rock.stl"), testing::HasSubstr("a solid is read from .obj, .node and .ele, or .msh"));
    EXPECT_THAT(refusal("no_such_file.msh"), testing::HasSubstr("cannot be read"));
}

// ---------------------------------------------------------------- surfaces

TEST(Surface, JoinsVerticesInOnePlaceAndCutsFaces) {
    Files files;
    const scenes::Surface surface = scenes::read_surface(files(
        ".obj",
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 1 0 0\nv 2 0 0\nv 1 0 1\nvt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1 0\n"
        "g one\nf 1/1 2/2 3/3 4/4\ng two\nf 5/2 6/5 7/3\n"));
    EXPECT_EQ(surface.points.size(), 5u);
    EXPECT_EQ(surface.triangles, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3, 1, 4, 2}));
    ASSERT_EQ(surface.uv.size(), 10u);
    EXPECT_EQ(surface.uv[8], 1);
}

TEST(Surface, WithoutFacesIsRefused) {
    Files files;
    EXPECT_THROW(scenes::read_surface(files(".obj", "v 0 0 0\nv 1 0 0\n")), scenes::BadFile);
    EXPECT_THROW(scenes::read_surface(files(".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")), scenes::BadFile);
    EXPECT_THROW(scenes::read_surface(files(".obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), scenes::BadFile);
}

// The cloth's own rules hold for files as well, and the message names the file.
TEST(ClothFile, OfThreeFacesOnAnEdgeIsRefusedByName) {
    Files files;
    scenes::Options options;
    options.mesh = files(".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
    try {
        const scenes::Scene scene = scenes::make_scene("cloth_file", options);
        scenes::TautWorld world(scene);
        FAIL() << "accepted";
    } catch (const scenes::TautError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(options.mesh));
    }
}

// ---------------------------------------------------------------- filling

// Adds a ball of rings; inward: seen from inside, as the wall of a cavity.
void add_ball(scenes::Surface& surface, const Vec& centre, double radius, bool inward) {
    constexpr int kRings = 24, kSides = 48;
    const auto first = static_cast<uint32_t>(surface.points.size());
    const auto add = [&](double angle, double turn) {
        surface.points.push_back({centre.x + radius * std::sin(angle) * std::cos(turn),
                                  centre.y + radius * std::cos(angle),
                                  centre.z + radius * std::sin(angle) * std::sin(turn)});
    };
    add(0, 0);
    for (int ring = 1; ring < kRings; ++ring)
        for (int side = 0; side < kSides; ++side)
            add(std::numbers::pi * ring / kRings, 2 * std::numbers::pi * side / kSides);
    add(std::numbers::pi, 0);
    const auto point = [&](int ring, int side) {
        if (ring == 0) return first;
        if (ring == kRings) return static_cast<uint32_t>(surface.points.size() - 1);
        return first + 1 + static_cast<uint32_t>((ring - 1) * kSides + side % kSides);
    };
    const auto face = [&](uint32_t a, uint32_t b, uint32_t c) {
        if (inward) std::swap(b, c);
        surface.triangles.insert(surface.triangles.end(), {a, b, c});
    };
    for (int ring = 0; ring < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            if (ring > 0) face(point(ring, side), point(ring, side + 1), point(ring + 1, side));
            if (ring + 1 < kRings) face(point(ring + 1, side), point(ring, side + 1), point(ring + 1, side + 1));
        }
}

constexpr double kBall = 4 * std::numbers::pi / 3;  // volume over radius cubed

// Points of the skin, as the vertices are.
std::vector<Vec> skin_points(const scenes::Solid& solid) {
    std::vector<Vec> points(solid.skin.corners.size() / 4);
    for (size_t i = 0; i < solid.skin.corners.size(); ++i)
        points[i / 4] =
            points[i / 4] + static_cast<double>(solid.skin.weights[i]) * at(solid.points, solid.skin.corners[i]);
    return points;
}

TEST(FilledSurface, HasTheVolumeOfABallAndWearsIt) {
    scenes::Surface surface;
    add_ball(surface, {0.3, 1, -2}, 0.5, false);
    for (const int cubes : {200, 1000}) {
        scenes::Solid solid = scenes::fill_surface(surface, cubes, "ball");
        EXPECT_NEAR(static_cast<double>(solid.cells.size()) / 20, cubes, 0.12 * cubes);
        EXPECT_NEAR(volume(solid.points, solid.cells), kBall * 0.125, (cubes == 200 ? 0.08 : 0.04) * kBall * 0.125);
        const std::vector<Vec> worn = skin_points(solid);
        ASSERT_EQ(worn.size(), surface.points.size());
        for (uint32_t i = 0; i < worn.size(); ++i) EXPECT_LT(norm(worn[i] - at(surface.points, i)), 1e-6) << i;
        // It goes where an affine motion of the vertices takes it.
        const auto moved = [](const Vec& p) { return Vec(2 * p.x + p.y, p.y - 0.5 * p.z + 1, 3 * p.z - p.x); };
        for (taut_pos& p : solid.points) p = moved(p).pos();
        const std::vector<Vec> carried = skin_points(solid);
        for (uint32_t i = 0; i < carried.size(); ++i)
            EXPECT_LT(norm(carried[i] - moved(at(surface.points, i))), 1e-5) << i;
    }
}

TEST(FilledSurface, KeepsCavitiesEmptyAndPiecesApart) {
    scenes::Surface hollow;
    add_ball(hollow, {0, 0, 0}, 1, false);
    add_ball(hollow, {0, 0, 0}, 0.6, true);
    const scenes::Solid shell = scenes::fill_surface(hollow, 2000, "shell");
    EXPECT_NEAR(volume(shell.points, shell.cells), kBall * (1 - 0.216), 0.06 * kBall);
    scenes::Surface two;
    add_ball(two, {0, 0, 0}, 1, false);
    add_ball(two, {3, 0, 0}, 1, false);
    const scenes::Solid both = scenes::fill_surface(two, 800, "two");
    EXPECT_NEAR(volume(both.points, both.cells), 2 * kBall, 0.08 * 2 * kBall);
    for (size_t c = 0; c < both.cells.size(); c += 4) {
        bool left = false, right = false;
        for (size_t k = 0; k < 4; ++k) (both.points[both.cells[c + k]].x < 1.5 ? left : right) = true;
        EXPECT_NE(left, right);
    }
}

// Turned inside out it is the same.
TEST(FilledSurface, DoesNotMindWhichSideIsOut) {
    scenes::Surface out, in;
    add_ball(out, {0, 0, 0}, 1, false);
    add_ball(in, {0, 0, 0}, 1, true);
    EXPECT_EQ(scenes::fill_surface(out, 300, "").cells, scenes::fill_surface(in, 300, "").cells);
}

TEST(FilledSurface, OfAnOpenOrFlatSurfaceIsRefused) {
    scenes::Surface surface;
    add_ball(surface, {0, 0, 0}, 1, false);
    surface.triangles.resize(surface.triangles.size() - 3);
    EXPECT_THROW(scenes::fill_surface(surface, 300, "open"), scenes::BadFile);
    scenes::Surface flat;
    flat.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    flat.triangles = {0, 1, 2, 2, 1, 0};
    EXPECT_THROW(scenes::fill_surface(flat, 300, "flat"), scenes::BadFile);
}

TEST(Figure, MadeHereIsOneClosedPieceOfAboutTwelveHundredVertices) {
    const scenes::Solid solid = scenes::figure("");
    EXPECT_GT(solid.points.size(), 1000u);
    EXPECT_LT(solid.points.size(), 1500u);
    EXPECT_GT(volume(solid.points, solid.cells), 0);
    std::vector<uint32_t> root(solid.points.size());
    for (uint32_t i = 0; i < root.size(); ++i) root[i] = i;
    const auto find = [&](uint32_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (size_t c = 0; c < solid.cells.size(); ++c) root[find(solid.cells[c])] = find(solid.cells[c - c % 4]);
    for (uint32_t i = 0; i < root.size(); ++i) EXPECT_EQ(find(i), find(0));
}

}  // namespace
