#include "detect/untangle.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr float kPart = 0.25f;  // of its length by which an edge counts as on the wrong side of what it cuts

// Of one crossing, in the frame of the face's mesh.
class Crossing {
public:
    Crossing(const Softs& softs, const SurfaceCrossing& of)
        : edge_(softs.mesh[of.soft].edge[of.edge]),
          soft_(softs.record[of.soft]),
          mesh_(softs.mesh[of.soft]),
          face_(&softs.record[of.other].triangle[3 * size_t{of.face}]),
          other_(softs.mesh[of.other]),
          apart_((mesh_.origin - other_.origin).cast<float>()) {}

    // Along which the edge goes to shorten the cut, unit, or 0:
    //   G = sum over its triangles of R - (R . E) / (E . N) N,  R along the cut, into the triangle
    Vec3f way() const {
        const Vec3f from = at(edge_.vertex[0]), along = at(edge_.vertex[1]) - from, normal = normal_of_face();
        const float across = along.dot(normal);
        Vec3f sum = Vec3f::Zero();
        for (const uint32_t t : edge_.triangle) {
            if (t == kNone || across == 0) continue;
            const uint32_t* corner = &soft_.triangle[3 * size_t{t}];
            const Vec3f own = (at(corner[1]) - at(corner[0])).cross(at(corner[2]) - at(corner[0]));
            Vec3f cut = normal.cross(own);
            const float length = cut.norm();
            if (!(length > 0)) continue;
            const Vec3f middle = (1.0f / 3) * (at(corner[0]) + at(corner[1]) + at(corner[2]));
            // What of the way inwards is across the edge, within the triangle.
            const Vec3f inwards = own.cross(along) * (own.cross(along).dot(middle - from) < 0 ? -1.0f : 1.0f);
            cut *= (cut.dot(inwards) < 0 ? -1 : 1) / length;
            sum += cut - (cut.dot(along) / across) * normal;
        }
        const float length = sum.norm();
        return length > 0 ? Vec3f((1 / length) * sum) : Vec3f(Vec3f::Zero());
    }
    float length() const { return (at(edge_.vertex[1]) - at(edge_.vertex[0])).norm(); }

private:
    Vec3f at(uint32_t vertex) const { return apart_ + mesh_.x[vertex]; }
    Vec3f normal_of_face() const {
        const Vec3f& a = other_.x[face_[0]];
        return (other_.x[face_[1]] - a).cross(other_.x[face_[2]] - a).normalized();
    }

    const SurfaceEdge& edge_;
    const Soft& soft_;
    const SurfaceMesh& mesh_;
    const uint32_t* face_;
    const SurfaceMesh& other_;
    Vec3f apart_;
};

// An end of an edge is to go along a way, and a face that it cuts against it: as a contact without friction, which
// pushes no faster than others that overlap.
SurfaceContact push_apart(const SurfaceScene& scene, const SurfaceCrossing& of, uint32_t end, const Vec3f& way,
                          float depth) {
    const Soft &soft = scene.softs.record[of.soft], &other = scene.softs.record[of.other];
    SurfaceContact contact;
    contact.a = feature_of(of.soft, SurfacePart::cut, 2 * of.edge + end);
    contact.b = feature_of(of.other, SurfacePart::face, of.face);
    contact.node[0] = soft.node[scene.softs.mesh[of.soft].edge[of.edge].vertex[end]];
    contact.weight[0] = 1;
    for (size_t k = 0; k < 3; ++k) {
        contact.node[k + 1] = other.node[other.triangle[3 * size_t{of.face} + k]];
        contact.weight[k + 1] = -1.0f / 3;
    }
    contact.normal = way;
    contact.gap = -depth;
    contact.collider[0] = scene.softs.mesh[of.soft].collider;
    contact.collider[1] = scene.softs.mesh[of.other].collider;
    return contact;
}

// Of two surfaces: sum w_i n . x_i >= 0 [m].
bool is_on_its_side(const SurfaceScene& scene, const SurfaceContact& contact) {
    Vec3 apart = Vec3::Zero();
    for (size_t n = 0; n < std::size(contact.node); ++n)
        if (contact.node[n] != kNone) apart += static_cast<double>(contact.weight[n]) * scene.place_of(contact.node[n]);
    return apart.dot(contact.normal.cast<double>()) >= 0;
}

}  // namespace

bool goes_through(const Vec3f& p, const Vec3f& q, const Vec3f (&face)[3]) {
    const Vec3f a = face[1] - face[0], b = face[2] - face[0], normal = a.cross(b);
    const float above = normal.dot(p - face[0]), below = normal.dot(q - face[0]);
    if (!((above > 0 && below < 0) || (above < 0 && below > 0))) return false;
    const Vec3f at = p + (above / (above - below)) * (q - p) - face[0];
    const float s = at.cross(b).dot(normal), t = a.cross(at).dot(normal), whole = normal.squaredNorm();
    return s >= 0 && t >= 0 && s + t <= whole;
}

void untangle(const SurfaceFinder& finder, Array<SurfaceContact>& found) {
    const SurfaceScene& scene = finder.scene();
    SurfaceContacts& surfaces = scene.pairs.surfaces;
    const auto stays = [&](const SurfaceContact& was) {
        return part_of(was.a) == SurfacePart::cut && !finder.renews(was);
    };
    if (surfaces.crossing.empty() && std::ranges::none_of(finder.all_before(), stays)) return;
    Array<uint32_t>& tangled = surfaces.near;  // by node
    tangled.assign(scene.nodes.slots(), 0);
    for (const SurfaceCrossing& of : surfaces.crossing) {
        const Soft &soft = scene.softs.record[of.soft], &other = scene.softs.record[of.other];
        for (const uint32_t vertex : scene.softs.mesh[of.soft].edge[of.edge].vertex) tangled[soft.node[vertex]] = 1;
        for (size_t k = 0; k < 3; ++k) tangled[other.node[other.triangle[3 * size_t{of.face} + k]]] = 1;
    }
    for (const SurfaceContact& was : finder.all_before())
        for (const uint32_t node : was.node)
            if (node != kNone && stays(was)) tangled[node] = 1;
    constexpr int kTangled = 3;  // nodes
    // Those in touch before, and still on their sides, have these from a time without a tangle: in a rope under tension
    // more would follow through the hole that they leave.
    std::erase_if(found, [&](const SurfaceContact& contact) {
        return std::ranges::count_if(contact.node, [&](uint32_t n) { return n != kNone && tangled[n]; }) >= kTangled &&
               !(finder.before(contact.a, contact.b) && is_on_its_side(scene, contact));
    });
    for (const SurfaceCrossing& of : surfaces.crossing) {
        const Crossing crossing(scene.softs, of);
        const Vec3f way = crossing.way();
        if (way == Vec3f::Zero()) continue;
        for (uint32_t end = 0; end < 2; ++end) {
            const SurfaceContact contact = push_apart(scene, of, end, way, kPart * crossing.length());
            if (std::ranges::any_of(contact.node, [&](uint32_t node) { return scene.nodes.solved(node); }))
                found.push_back(contact);
        }
    }
}

}  // namespace taut
