#include "models/cloth.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "constraints/material.h"
#include "constraints/shape_functions.h"
#include "models/long_links.h"

namespace taut {
namespace {

constexpr const char* kUnstable = "stretch_stiffness, shear_stiffness, poisson_ratio: no stable material";
constexpr double kFlat = 1e-6;  // angle between two triangles that are flat at rest [rad]
// Of links by direction, with those that only pull, bends, limits, tethers and long links.
constexpr size_t kMostSets = 10 + kMostStages;

// Of a link: along warp, along weft, or neither, within an eighth of a turn.
enum class Thread : uint8_t { warp, weft, shear };

class ClothPlanner {
public:
    ClothPlanner(const ClothMesh& mesh, const Fabric& fabric, JointSolve solve, SoftPlan& plan)
        : mesh_(mesh),
          fabric_(fabric),
          solve_(solve),
          plan_(plan),
          memory_(*plan.position.get_allocator().memory),
          edges_(memory_),
          point_(memory_) {}

    const char* run(ClothKind kind) {
        const MeshFault fault = find_edges(mesh_.triangle, edges_);
        if (fault == MeshFault::not_manifold) return "triangles: more than two meet at an edge";
        if (fault == MeshFault::not_oriented)
            return "triangles: two that meet at an edge go along it in the same direction";
        if (!find_points()) return "triangles: one has no area at rest";
        if (kind == ClothKind::quads && fabric_.tear_strain > 0) return "tear_strain: quadrilaterals do not tear";
        plan_.soft.kind = SoftKind::cloth;
        plan_.position.assign(mesh_.position.begin(), mesh_.position.end());
        plan_.soft.triangle.assign(mesh_.triangle.begin(), mesh_.triangle.end());
        plan_.soft.tethers = fabric_.tethers;
        plan_.soft.tether_slack = fabric_.tether_slack;
        plan_.soft.tear_strain = fabric_.tear_strain;
        weigh();
        plan_.element.reserve(kMostSets);
        if (kind == ClothKind::links) {
            if (!may_give_way()) return "compression: below 1 it is of links that are not rigid";
            add_links();
        } else {
            if (const char* sheet = kind == ClothKind::quads ? add_quads() : add_triangles()) return sheet;
            if (fabric_.bending_stiffness > 0) add_bends();
        }
        if (std::isfinite(fabric_.strain_limit)) add_limits();
        std::erase_if(plan_.element, [](const ElementPlan& each) { return each.softness.empty(); });
        if (fabric_.tethers > 0) add_pulling(SoftPart::tether, fabric_.limit_compliance);
        return nullptr;
    }

private:
    Vec3 rest(uint32_t vertex) const { return mesh_.rest[vertex]; }
    uint32_t triangles() const { return static_cast<uint32_t>(mesh_.triangle.size() / 3); }
    const uint32_t* corners(uint32_t t) const { return &mesh_.triangle[3 * size_t{t}]; }

    // Warp of a triangle: along u; without texture coordinates the direction of the mesh's first edge.
    Vec3 warp(const Vec3 (&x)[3], uint32_t t) const {
        const uint32_t* corner = corners(t);
        if (mesh_.uv.empty()) return rest(mesh_.triangle[1]) - rest(mesh_.triangle[0]);
        double uv[3][2];
        for (int n = 0; n < 3; ++n)
            for (size_t k = 0; k < 2; ++k) uv[n][k] = static_cast<double>(mesh_.uv[2 * size_t{corner[n]} + k]);
        return warp_of(x, uv);
    }

    bool find_points() {
        point_.resize(triangles());
        plan_.soft.rest.clear();
        for (uint32_t t = 0; t < triangles(); ++t) {
            const uint32_t* corner = corners(t);
            const Vec3 x[3] = {rest(corner[0]), rest(corner[1]), rest(corner[2])};
            // Where the warp stands across it, as at a collar, an edge will do.
            if (!tri3_point(x, warp(x, t), point_[t]) && !tri3_point(x, x[1] - x[0], point_[t])) return false;
            plan_.soft.rest.insert(plan_.soft.rest.end(), &point_[t].g[0][0], &point_[t].g[0][0] + 6);
        }
        return true;
    }

    // A third of each triangle's mass to each corner.
    void weigh() {
        plan_.soft.mass.assign(mesh_.rest.size(), 0.0);
        for (uint32_t t = 0; t < triangles(); ++t)
            for (int n = 0; n < 3; ++n) plan_.soft.mass[corners(t)[n]] += fabric_.area_density * point_[t].weight / 3;
    }

    // By where an edge goes in the plane of its first triangle: across the gradient of the corner opposite to it.
    Thread thread_of(const MeshEdge& edge) const {
        constexpr double kEighth = 0.41421356237309503;  // tan(pi/8)
        const uint32_t* corner = corners(edge.triangle[0]);
        const auto opposite = std::find(corner, corner + 3, edge.across[0]) - corner;
        const auto& g = point_[edge.triangle[0]].g[opposite];
        const double warp = std::abs(g[1]), weft = std::abs(g[0]);
        return weft <= kEighth * warp ? Thread::warp : warp <= kEighth * weft ? Thread::weft : Thread::shear;
    }

    ElementPlan& add_plan(const ElementType& type, SoftPart part) {
        ElementPlan& plan = plan_.element.emplace_back(memory_, type, part);
        plan.solve = solve_;
        plan.relaxation = fabric_.damping;
        plan.rayleigh = fabric_.rayleigh;
        plan.stage = kMostStages - 1;
        plan.tolerance = fabric_.tolerance;
        plan.resolved = true;
        return plan;
    }

    // A set of links that only pull; theirs need no multipliers where a direct solve takes them.
    ElementPlan& add_pulling(SoftPart part, double compliance) {
        ElementPlan& plan = add_plan(kLinkElement, part);
        plan.pulls = true;
        plan.compliance[0] = compliance;
        plan.form = ElementForm::folded;
        return plan;
    }

    // Corner of a triangle at a vertex, as of Soft.
    uint32_t corner_at(uint32_t t, uint32_t vertex) const {
        return 3 * t + static_cast<uint32_t>(std::find(corners(t), corners(t) + 3, vertex) - corners(t));
    }
    void add_link(ElementPlan& plan, uint32_t a, uint32_t b, uint32_t triangle_a, uint32_t triangle_b,
                  double stretch = 1) {
        const uint32_t ends[2] = {a, b}, corner[2] = {corner_at(triangle_a, a), corner_at(triangle_b, b)};
        const double length = stretch * (rest(b) - rest(a)).norm();
        plan.add(ends, {&length, 1}, 1, corner);
    }
    void add_edge(ElementPlan& plan, const MeshEdge& edge, double stretch = 1) {
        add_link(plan, edge.a, edge.b, edge.triangle[0], edge.triangle[0], stretch);
    }

    bool may_give_way() const {
        return fabric_.compression == 1 ||
               (fabric_.stretch_compliance[0] > 0 && fabric_.stretch_compliance[1] > 0 && fabric_.shear_compliance > 0);
    }

    // Links of one compliance; where they give way to pressure, a part of the stiffness only pulls: sets by index.
    struct Links {
        size_t first, end;
    };
    Links add_link_sets(SoftPart part, double compliance, double pressed) {
        const size_t first = plan_.element.size();
        if (!std::isfinite(compliance)) return {first, first};
        if (pressed > 0) {
            ElementPlan& plan = add_plan(kLinkElement, part);
            plan.compliance[0] = compliance / pressed;
            plan.form = compliance > 0 ? ElementForm::folded : ElementForm::rows;
        }
        if (pressed < 1) add_pulling(part, compliance / (1 - pressed));
        return {first, plan_.element.size()};
    }

    void add_links() {
        const double pressed = fabric_.compression;
        const Links warp = add_link_sets(SoftPart::stretch, fabric_.stretch_compliance[0], pressed);
        const Links weft = add_link_sets(SoftPart::stretch, fabric_.stretch_compliance[1], pressed);
        const Links shear = add_link_sets(SoftPart::shear, fabric_.shear_compliance, pressed);
        const Links bend = add_link_sets(SoftPart::bend, fabric_.bend_compliance, 1);
        for (const MeshEdge& edge : edges_) {
            const Thread thread = thread_of(edge);
            const Links& along = thread == Thread::warp ? warp : thread == Thread::weft ? weft : shear;
            for (size_t i = along.first; i < along.end; ++i) add_edge(plan_.element[i], edge);
            if (edge.across[1] == kNone) continue;
            // Across a diagonal lies the other diagonal of the same cell.
            const Links& across = thread == Thread::shear ? shear : bend;
            for (size_t i = across.first; i < across.end; ++i)
                add_link(plan_.element[i], edge.across[0], edge.across[1], edge.triangle[0], edge.triangle[1]);
        }
        if (solve_ == JointSolve::swept && fabric_.tear_strain == 0) add_long_links();
    }

    // What sweeps carry corrections far with, beside links that are stiffer than the shortest substeps hold: they make
    // a cloth up to twice as stiff, which is less than these leave. Of their own yield they are not asked. A cloth that
    // may tear goes without: a tear would have to part them.
    void add_long_links() {
        const double compliance = std::max(fabric_.stretch_compliance[0], fabric_.stretch_compliance[1]);
        const double mass = std::reduce(plan_.soft.mass.begin(), plan_.soft.mass.end()) / mesh_.rest.size();
        if (compliance > fabric_.shortest_substep * fabric_.shortest_substep * 2 / mass) return;
        Array<ThreadLink> threads(memory_);
        for (const MeshEdge& edge : edges_)
            if (thread_of(edge) != Thread::shear) threads.push_back({edge.a, edge.b});
        Array<LongLink> links(memory_);
        find_long_links(mesh_.rest, threads, kMostStages - 1, links);
        uint32_t level = kNone;
        for (const LongLink& link : links) {
            if (std::exchange(level, link.level) != link.level) {
                ElementPlan& plan = add_pulling(SoftPart::bound, compliance);
                plan.stage = static_cast<uint8_t>(kMostStages - 1 - level);
                plan.tolerance = 0;
            }
            const uint32_t ends[2] = {link.a, link.b};
            plan_.element.back().add(ends, {&link.length, 1}, link.links);
        }
    }

    void add_limits() {
        ElementPlan& plan = add_pulling(SoftPart::limit, fabric_.limit_compliance);
        for (const MeshEdge& edge : edges_) add_edge(plan, edge, 1 + fabric_.strain_limit);
    }

    // Of what keeps its thickness: E' = E/(1 - nu^2), nu' = nu/(1 - nu).
    bool find_sheet(double (&compliance)[9]) const {
        const double t = fabric_.thickness, nu = fabric_.poisson;
        OrthotropicSheet sheet{
            {fabric_.stretch_stiffness[0] / t, fabric_.stretch_stiffness[1] / t}, nu, fabric_.shear_stiffness / t};
        if (fabric_.plane_strain) {
            for (double& young : sheet.young) young /= 1 - nu * nu;
            sheet.poisson_12 = nu / (1 - nu);
        }
        return orthotropic_sheet(sheet, compliance);
    }
    // Of one of the sheet's elements, by its strain.
    ElementPlan* add_sheet(const ElementType& green, const ElementType& corotated) {
        double compliance[9];
        if (!find_sheet(compliance)) return nullptr;
        ElementPlan& plan = add_plan(fabric_.strain == SheetStrain::green ? green : corotated, SoftPart::stretch);
        plan.form = ElementForm::folded;
        std::copy_n(compliance, 9, plan.compliance);
        return &plan;
    }

    const char* add_quads() {
        ElementPlan* plan = add_sheet(kGreenQuad4, kCorotatedQuad4);
        if (!plan) return kUnstable;
        for (uint32_t t = 0; t < triangles(); t += 2) {
            const uint32_t vertex[4] = {corners(t)[0], corners(t)[1], corners(t)[2], corners(t + 1)[2]};
            const Vec3 x[4] = {rest(vertex[0]), rest(vertex[1]), rest(vertex[2]), rest(vertex[3])};
            const Vec3 along = warp({x[0], x[1], x[2]}, t);
            GaussPoint<4, 2> point[4];
            if (!quad4_points(x, along, point) && !quad4_points(x, x[1] - x[0], point))
                return "quads: one is not convex at rest";
            for (const GaussPoint<4, 2>& at : point)
                plan->add(vertex, {&at.g[0][0], 8}, 1 / (fabric_.thickness * at.weight));
        }
        return nullptr;
    }

    const char* add_triangles() {
        ElementPlan* sheet = add_sheet(kGreenTri3, kCorotatedTri3);
        if (!sheet) return kUnstable;
        ElementPlan& plan = *sheet;
        const double t = fabric_.thickness;
        for (uint32_t i = 0; i < triangles(); ++i) {
            const uint32_t corner[3] = {3 * i, 3 * i + 1, 3 * i + 2};
            plan.add({corners(i), 3}, {&point_[i].g[0][0], 6}, 1 / (t * point_[i].weight), corner);
        }
        return nullptr;
    }

    // An edge of length e between areas A bends by theta with 1/2 B e^2/A theta^2: of equilateral triangles the plate's
    // energy, 2/sqrt(3) B an edge (Seung and Nelson 1988), and of cells of two right triangles that along their rows.
    void add_bends() {
        ElementPlan& flat = add_plan(kQuadraticBendElement, SoftPart::bend);
        for (int r = 0; r < 3; ++r) flat.compliance[4 * r] = 1 / fabric_.bending_stiffness;
        flat.form = ElementForm::folded;
        ElementPlan& folded = add_plan(kDihedralElement, SoftPart::bend);
        folded.compliance[0] = 1 / fabric_.bending_stiffness;
        folded.form = ElementForm::folded;
        ElementPlan& flat_plan = plan_.element[1];
        for (const MeshEdge& edge : edges_) {
            if (edge.across[1] == kNone) continue;
            const uint32_t vertex[4] = {edge.a, edge.b, edge.across[0], edge.across[1]}, *t = edge.triangle;
            const uint32_t corner[4] = {corner_at(t[0], edge.a), corner_at(t[0], edge.b),
                                        corner_at(t[0], edge.across[0]), corner_at(t[1], edge.across[1])};
            const Vec3 x[4] = {rest(vertex[0]), rest(vertex[1]), rest(vertex[2]), rest(vertex[3])};
            const Pose pose[4] = {{x[0]}, {x[1]}, {x[2]}, {x[3]}};
            const double none = 0;
            double angle, weight[4], area;
            kDihedralElement.row.evaluate(&none, pose, &angle, nullptr);
            if (std::abs(angle) < kFlat && quadratic_bend_weights(x, weight, area))
                flat_plan.add(vertex, weight, area, corner);
            else
                folded.add(vertex, {&angle, 1}, area_of(edge) / (x[1] - x[0]).squaredNorm(), corner);
        }
    }
    double area_of(const MeshEdge& edge) const {
        return point_[edge.triangle[0]].weight + point_[edge.triangle[1]].weight;
    }

    const ClothMesh& mesh_;
    const Fabric& fabric_;
    JointSolve solve_;
    SoftPlan& plan_;
    Memory& memory_;
    Array<MeshEdge> edges_;
    Array<GaussPoint<3, 2>> point_;  // of each triangle
};

}  // namespace

const char* plan_cloth(const ClothMesh& mesh, ClothKind kind, const Fabric& fabric, JointSolve solve, SoftPlan& plan) {
    return ClothPlanner(mesh, fabric, solve, plan).run(kind);
}

}  // namespace taut
