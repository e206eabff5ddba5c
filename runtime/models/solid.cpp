#include "models/solid.h"

#include <algorithm>
#include <array>

#include "constraints/shape_functions.h"

namespace taut {
namespace {

// Yield of neo-Hookean rows up to which sweeps hold them, and beyond which they shake, at rest too: of 60 random blocks
// of tetrahedra none at 1.3, a quarter at 1.5. That of a tetrahedron at rest is some 2 q, q = E h^2 / (rho dx^2) of
// substeps h and edges dx; a beam of 1 MPa swings as it should at q = 3/4, and twice as far at 1.
constexpr double kSweptYield = 1.25;

// Faces of a cell, counterclockwise as seen from outside; a triangle ends with kNone.
constexpr uint32_t kTetFaces[4][4] = {{1, 2, 3, kNone}, {0, 3, 2, kNone}, {0, 1, 3, kNone}, {0, 2, 1, kNone}};
constexpr uint32_t kHexFaces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                      {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

struct MaterialType {
    const ElementType *tet4, *hex8;
    // D^-1 of a unit of volume, and alpha where its elements have one more number.
    bool (*compliance)(const Solid& of, double* compliance, double& alpha);
};

template <size_t N, bool (*make)(const Isotropic&, double (&)[N])>
bool compliance_of(const Solid& of, double* out, double&) {
    double block[N];
    if (!make(of.elastic, block)) return false;
    std::copy_n(block, N, out);
    return true;
}
bool neo_hookean_compliance(const Solid& of, double* out, double& alpha) {
    double block[4];
    if (!neo_hookean(of.elastic, block, alpha)) return false;
    std::copy_n(block, 4, out);
    return true;
}
bool orthotropic_compliance(const Solid& of, double* out, double&) {
    double block[36];
    if (!orthotropic_solid(of.axial, block)) return false;
    std::copy_n(block, 36, out);
    return true;
}

const MaterialType kMaterials[] = {
    {&kNeoHookeanTet4, &kNeoHookeanHex8, neo_hookean_compliance},
    {&kGreenTet4, &kGreenHex8, compliance_of<36, hooke_solid>},
    {&kStretchTet4, &kStretchHex8, compliance_of<9, hooke_stretches>},
    {&kStretchVolumeTet4, &kStretchVolumeHex8, compliance_of<16, fixed_corotated>},
    {&kGreenTet4, &kGreenHex8, orthotropic_compliance},
};

// What cells have in common.
struct CellTraits {
    double alpha, density;
};

// Elements of a cell, an element a Gauss point; false: it is inverted or flat. Strain is along the material's axes: of
// rest shapes turned back by these.
template <int Nodes, size_t Points, class Find>
bool add_cell(const Vec3 (&x)[Nodes], const uint32_t* vertex, const Quat& axes, const CellTraits& traits, Find&& find,
              ElementPlan& plan, Array<double>& mass) {
    GaussPoint<Nodes, 3> point[Points];
    if (!find(x, point)) return false;
    const auto numbers = static_cast<size_t>(plan.type->numbers);
    const Mat3 back = axes.conjugate().toRotationMatrix();
    const double density = traits.density;
    for (const GaussPoint<Nodes, 3>& at : point) {
        double data[3 * Nodes + 1];
        for (int n = 0; n < Nodes; ++n) Vec3::Map(data + 3 * n) = back * Vec3::Map(at.g[n]);
        data[3 * Nodes] = traits.alpha;
        plan.add({vertex, size_t{Nodes}}, {data, numbers}, 1 / at.weight);
        for (int n = 0; n < Nodes; ++n) mass[vertex[n]] += density * at.weight / Nodes;
    }
    return true;
}

bool add_tet(const Vec3* rest, const uint32_t* vertex, const Quat& axes, const CellTraits& traits, ElementPlan& plan,
             Array<double>& mass) {
    Vec3 x[4];
    for (int n = 0; n < 4; ++n) x[n] = rest[vertex[n]];
    const auto find = [](const Vec3(&at)[4], GaussPoint<4, 3>(&out)[1]) { return tet4_point(at, out[0]); };
    return add_cell<4, 1>(x, vertex, axes, traits, find, plan, mass);
}

bool add_hex(const Vec3* rest, const uint32_t* vertex, const Quat& axes, const CellTraits& traits, ElementPlan& plan,
             Array<double>& mass) {
    Vec3 x[8];
    for (int n = 0; n < 8; ++n) x[n] = rest[vertex[n]];
    const auto find = [](const Vec3(&at)[8], GaussPoint<8, 3>(&out)[8]) { return hex8_points(at, out); };
    return add_cell<8, 8>(x, vertex, axes, traits, find, plan, mass);
}

const char* add_cells(const SolidMesh& mesh, const CellTraits& traits, ElementPlan& element, Array<double>& mass,
                      uint32_t& cell) {
    const auto cells = static_cast<uint32_t>(mesh.cell.size() / mesh.corners);
    for (uint32_t c = 0; c < cells; ++c) {
        const uint32_t* vertex = &mesh.cell[size_t{c} * mesh.corners];
        const auto add = mesh.corners == 4 ? add_tet : add_hex;
        const Quat axes = mesh.axes.empty() ? Quat::Identity() : mesh.axes[mesh.axes.size() > 1 ? c : 0];
        if (add(mesh.rest.data(), vertex, axes, traits, element, mass)) continue;
        cell = c;
        return "is flat or inverted at rest";
    }
    return nullptr;
}

// An element a sample; a vertex bears of its mass by its weight.
bool add_sample(const SolidMesh& mesh, const Neighbours& neighbours, double radius, const Sample& sample,
                const CellTraits& traits, ElementPlan& element, Array<double>& mass) {
    const SampleNodes nodes = nodes_of_sample(neighbours, sample.at, std::min(radius, sample.reach));
    Vec3 x[kSampleNodes];
    double sum = 0;
    for (uint32_t n = 0; n < kSampleNodes; ++n) {
        x[n] = mesh.rest[nodes.vertex[n]];
        sum += nodes.weight[n];
    }
    GaussPoint<8, 3> at;
    if (!meshless_point(x, nodes.weight, sample.volume, at)) return false;
    const Mat3 back = (mesh.axes.empty() ? Quat::Identity() : mesh.axes[0]).conjugate().toRotationMatrix();
    double data[3 * kSampleNodes + 1];
    for (uint32_t n = 0; n < kSampleNodes; ++n) {
        Vec3::Map(data + 3 * n) = back * Vec3::Map(at.g[n]);
        mass[nodes.vertex[n]] += traits.density * sample.volume * nodes.weight[n] / sum;
    }
    data[3 * kSampleNodes] = traits.alpha;
    element.add(nodes.vertex, {data, static_cast<size_t>(element.type->numbers)}, 1 / sample.volume);
    return true;
}

const char* add_samples(const SolidMesh& mesh, const CellTraits& traits, ElementPlan& element, Array<double>& mass,
                        uint32_t& cell) {
    Memory& memory = *mass.get_allocator().memory;
    const Neighbours neighbours(mesh.rest, memory);
    const double radius = mesh.radius > 0 ? mesh.radius : usual_radius(mesh.rest, neighbours);
    Array<Sample> made(memory);
    if (mesh.sample.empty()) make_samples(mesh.rest, neighbours, radius, made);
    const std::span<const Sample> samples = mesh.sample.empty() ? std::span<const Sample>(made) : mesh.sample;
    for (uint32_t s = 0; s < samples.size(); ++s) {
        if (add_sample(mesh, neighbours, radius, samples[s], traits, element, mass)) continue;
        if (mesh.sample.empty()) continue;
        cell = s;
        return "has fewer than four neighbours, or they lie in a plane";
    }
    return element.softness.empty() ? "points: none has neighbours that do not lie in a plane with it" : nullptr;
}

}  // namespace

const char* plan_solid(const SolidMesh& mesh, const Solid& solid, JointSolve solve, SoftPlan& plan, uint32_t& cell) {
    const bool tets = mesh.corners == 4, meshless = mesh.corners == 0;
    const MaterialType& material = kMaterials[static_cast<size_t>(solid.material)];
    ElementPlan& element = plan.element.emplace_back(*plan.position.get_allocator().memory,
                                                     tets ? *material.tet4 : *material.hex8, SoftPart::stretch);
    CellTraits traits{0, solid.density};
    cell = kNone;
    if (!material.compliance(solid, element.compliance, traits.alpha))
        return solid.material == SolidMaterial::orthotropic ? "orthotropic: no stable material"
                                                            : "young_modulus, poisson_ratio: no stable material";
    element.form = ElementForm::energy;
    // Rows that have no fused sweep are swept along J of a substep's beginning: such as balance each other at rest, or
    // are stiff, gain energy so.
    element.solve = element.type->sweep ? solve : JointSolve::direct;
    element.tolerance = kSweptYield;
    element.relaxation = solid.damping;
    element.rayleigh = solid.rayleigh;
    plan.soft.kind = SoftKind::solid;
    plan.soft.cell_points = tets || meshless ? 1 : 8;
    plan.position.assign(mesh.position.begin(), mesh.position.end());
    plan.soft.mass.assign(mesh.rest.size(), 0.0);
    const auto add = meshless ? add_samples : add_cells;
    if (const char* fault = add(mesh, traits, element, plan.soft.mass, cell)) return fault;
    if (meshless)
        plan.soft.triangle.assign(mesh.triangle.begin(), mesh.triangle.end());
    else
        find_boundary(mesh.cell, mesh.corners, plan.soft.triangle);
    if (solid.yield_stress < std::numeric_limits<double>::infinity()) {
        plan.soft.law = solid.law;
        plan.soft.law.yield = yield_of_stress(solid.yield_stress, solid.elastic);
        plan.soft.law.hardening = hardening_of_modulus(solid.hardening, solid.elastic);
        plan.soft.flowed.assign(element.softness.size(), 0.0);
        plan.soft.flows.assign(element.softness.size(), uint8_t{0});
        plan.soft.plastic.assign(9 * element.softness.size(), 0.0);
        for (size_t i = 0; i < plan.soft.plastic.size(); ++i) plan.soft.plastic[i] = i % 9 % 4 == 0 ? 1 : 0;
    }
    return nullptr;
}

void find_boundary(std::span<const uint32_t> cells, uint32_t corners, Array<uint32_t>& out) {
    struct Face {
        std::array<uint32_t, 4> sorted;
        uint32_t vertex[4];
    };
    Array<Face> faces(out.get_allocator());
    const auto* list = corners == 4 ? kTetFaces : kHexFaces;
    const uint32_t sides = corners == 4 ? 4 : 6;
    for (size_t c = 0; c < cells.size(); c += corners)
        for (uint32_t f = 0; f < sides; ++f) {
            Face face{};
            for (size_t k = 0; k < 4; ++k)
                face.sorted[k] = face.vertex[k] = list[f][k] == kNone ? kNone : cells[c + list[f][k]];
            std::ranges::sort(face.sorted);
            faces.push_back(face);
        }
    // Of those that share their vertices, which are two cells' or a fault of the mesh, none is at the boundary.
    Array<uint32_t> order(out.get_allocator());
    order.resize(faces.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, [&](uint32_t a, uint32_t b) {
        return faces[a].sorted != faces[b].sorted ? faces[a].sorted < faces[b].sorted : a < b;
    });
    Array<uint8_t> inner(faces.size(), 0, out.get_allocator());
    for (size_t i = 1; i < order.size(); ++i)
        if (faces[order[i]].sorted == faces[order[i - 1]].sorted) inner[order[i]] = inner[order[i - 1]] = 1;
    out.clear();
    for (size_t f = 0; f < faces.size(); ++f) {
        if (inner[f]) continue;
        const auto& v = faces[f].vertex;
        out.insert(out.end(), {v[0], v[1], v[2]});
        if (v[3] != kNone) out.insert(out.end(), {v[0], v[2], v[3]});
    }
}

}  // namespace taut
