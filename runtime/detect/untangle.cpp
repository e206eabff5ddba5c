#include "detect/untangle.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr float kRate = 15;  // edges that a vertex goes in a second

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

void ask(SurfaceShift& shift, const Vec3f& way) {
    shift.sum += way;
    shift.most = std::max(shift.most, way.norm());
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

void find_shifts(const SurfaceScene& scene, Array<SurfaceContact>& found) {
    SurfaceContacts& surfaces = scene.pairs.surfaces;
    surfaces.shift.clear();
    if (surfaces.crossing.empty()) return;
    surfaces.shift.resize(scene.nodes.slots());
    const float part = std::min(1.0f, kRate * static_cast<float>(scene.time));
    for (const SurfaceCrossing& of : surfaces.crossing) {
        const Crossing crossing(scene.softs, of);
        const Vec3f way = part * crossing.length() * crossing.way();
        const Soft &soft = scene.softs.record[of.soft], &other = scene.softs.record[of.other];
        for (const uint32_t vertex : scene.softs.mesh[of.soft].edge[of.edge].vertex)
            ask(surfaces.shift[soft.node[vertex]], way);
        for (int k = 0; k < 3; ++k)
            ask(surfaces.shift[other.node[other.triangle[3 * size_t{of.face} + static_cast<size_t>(k)]]],
                (-2.0f / 3) * way);
    }
    constexpr int kTangled = 3;  // nodes
    std::erase_if(found, [&](const SurfaceContact& contact) {
        const auto shifts = [&](uint32_t node) { return node != kNone && surfaces.shift[node].most > 0; };
        return std::ranges::count_if(contact.node, shifts) >= kTangled;
    });
}

void untangle(const SurfaceScene& scene, Nodes& nodes) {
    const Array<SurfaceShift>& shifts = scene.pairs.surfaces.shift;
    for (uint32_t node = 0; node < shifts.size(); ++node) {
        const SurfaceShift& shift = shifts[node];
        const float length = shift.sum.norm();
        if (!(length > 0) || !nodes.solved(node)) continue;
        nodes.motion[node].x += (std::min(1.0f, shift.most / length) * shift.sum).cast<double>();
    }
}

}  // namespace taut
