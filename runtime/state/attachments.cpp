#include "state/attachments.h"

#include <algorithm>
#include <cmath>

#include "state/constraint_view.h"

namespace taut {
namespace {

// A node of an anchor, or a place of one, on its own.
Anchor part_of(uint32_t node, const Vec3& point) {
    Anchor out;
    if (node == kNone) {
        out.point[0] = point;
        return out;
    }
    out.count = 1;
    out.node[0] = node;
    out.weight[0] = 1;
    out.point[0] = point;
    return out;
}

void add(AttachedWay& way, const Anchor& anchor, double sign) {
    if (anchor.count == 0) way.rest += sign * anchor.point[0];
    for (uint32_t n = 0; n < anchor.count; ++n) {
        const double weight = sign * anchor.weight[n];
        const auto end = way.term.begin() + way.count;
        const auto at = std::find_if(way.term.begin(), end, [&](const auto& t) { return t.node == anchor.node[n]; });
        if (at == end) way.term[way.count++] = {anchor.node[n], 0, Vec3::Zero()};
        at->weight += weight;
        at->moment += weight * anchor.point[n];
    }
}

}  // namespace

Vec3 point_of(const Nodes& nodes, const Anchor& anchor) {
    if (anchor.count == 0) return anchor.point[0];
    Vec3 sum = Vec3::Zero();
    for (uint32_t n = 0; n < anchor.count; ++n) {
        const Pose at = pose_of(nodes, anchor.node[n]);
        sum += anchor.weight[n] * (at.x + at.R * anchor.point[n]);
    }
    return sum;
}

AttachedWay way_between(const Anchor& from, const Anchor& to) {
    AttachedWay way;
    add(way, from, -1);
    add(way, to, 1);
    const auto end = std::remove_if(way.term.begin(), way.term.begin() + way.count,
                                    [](const auto& t) { return t.weight == 0 && t.moment.isZero(0); });
    way.count = static_cast<uint32_t>(end - way.term.begin());
    return way;
}

AttachedWay way_of(const Attachment& attachment, uint32_t i) {
    if (attachment.kind != AttachmentKind::fixed) return way_between(attachment.end[0], attachment.end[1]);
    const Anchor &soft = attachment.end[attachment.held_end], &hard = attachment.end[1 - attachment.held_end];
    const Anchor held = part_of(soft.node[i], Vec3::Zero());
    const Anchor place = part_of(hard.count > 0 ? hard.node[0] : kNone, attachment.place[i]);
    return attachment.held_end == 1 ? way_between(place, held) : way_between(held, place);
}

AttachmentLoad load_of(const Nodes& nodes, const Elements& elements, const Attachment& attachment) {
    AttachmentLoad load;
    const ElementSet& set = elements.set[attachment.set];
    const Vec3 a = point_of(nodes, attachment.end[0]), b = point_of(nodes, attachment.end[1]);
    const Vec3 about = attachment.held_end == 1 ? b : a;
    for (uint32_t i = 0; i < attachment.elements(); ++i) {
        const uint32_t e = attachment.element[i];
        if (set.fresh[e]) continue;
        const double* lambda = set.lambda_of(e);
        if (attachment.kind == AttachmentKind::distance) {
            load.force += *lambda * (b - a).normalized();
            continue;
        }
        const Vec3 force = Vec3::Map(lambda);
        load.force += force;
        if (attachment.kind == AttachmentKind::fixed)
            load.torque += (nodes.motion[attachment.end[attachment.held_end].node[i]].x - about).cross(force);
    }
    if (attachment.limit_set != kNone) {
        const ElementSet& limit = elements.set[attachment.limit_set];
        const uint32_t e = attachment.limit_element;
        if (!limit.fresh[e]) load.force += *limit.lambda_of(e) * (b - a).normalized();
    }
    return load;
}

double gap_of(const Nodes& nodes, const Elements& elements, const Attachment& attachment) {
    double most = 0;
    for (uint32_t i = 0; i < attachment.elements(); ++i) {
        double c[kMaxRows] = {}, squared = 0;
        const ConstraintView view = view_of(elements.set[attachment.set], attachment.element[i]);
        view.read(nodes, c);
        if (attachment.pulls) c[0] = std::max(0.0, c[0]);
        for (int r = 0; r < view.type->rows; ++r) squared += c[r] * c[r];
        most = std::max(most, std::sqrt(squared));
    }
    return most;
}

}  // namespace taut
