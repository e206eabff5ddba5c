#include <taut/decomposition.h>

#include <cmath>

#include "api/shape_build.h"
#include "api/shape_def.h"
#include "collision/decomposition.h"

using namespace taut;

namespace {

constexpr double kDefaultTolerance = 1.0 / 40;  // of the longest side
constexpr double kNoVolume = 1e-12;             // of the longest side cubed: what sums of volumes round by

bool check_decomposition(Check& check, const taut_decomposition_def& def) {
    check.count("vertex_count", def.vertex_count, 4, UINT32_MAX)
        .count("triangle_count", def.triangle_count, 1, TAUT_DECOMPOSITION_MAX_TRIANGLES)
        .pointer("vertices", def.vertices)
        .pointer("indices", def.indices)
        .count("max_parts", def.max_parts, 1, TAUT_DECOMPOSITION_MAX_PARTS)
        .count("max_vertices", def.max_vertices, 4, TAUT_HULL_MAX_VERTICES)
        .zero_or("tolerance", def.tolerance, kShapeSize)
        .boolean("close_holes", def.close_holes)
        .zero("reserved", def.reserved);
    for (uint32_t i = 0; check && i < def.vertex_count; ++i)
        check.vector("vertices", def.vertices[i], kShapeCoordinate);
    for (uint32_t i = 0; check && i < 3 * def.triangle_count; ++i)
        check.count("indices", def.indices[i], 0, def.vertex_count - 1);
    return static_cast<bool>(check);
}

// Releases what was baked, unless all of it is handed over.
class BakedParts {
public:
    BakedParts(taut_baked* parts) : parts_(parts) {}
    ~BakedParts() {
        for (uint32_t i = 0; i < count; ++i) taut_baked_release(parts_[i]);
    }
    BakedParts(const BakedParts&) = delete;
    BakedParts& operator=(const BakedParts&) = delete;

    taut_result add(const collision::ConvexPart& part, const taut_allocator* allocator) {
        taut_hull_def hull;
        taut_hull_def_init(&hull);
        taut_vec3 points[TAUT_HULL_MAX_VERTICES];
        for (const Vec3f& v : part.hull->vertices) points[hull.point_count++] = {v.x(), v.y(), v.z()};
        hull.points = points;
        const taut_result result = taut_bake_hull(&hull, allocator, &parts_[count]);
        if (result == TAUT_OK) ++count;
        return result;
    }

    uint32_t count = 0;

private:
    taut_baked* parts_;
};

taut_result bake_parts(const char* call, const taut_decomposition_def& def, const taut_allocator* allocator,
                       taut_baked* parts, uint32_t* count, taut_decomposition_info& info) {
    taut_hooks hooks{};
    if (allocator)
        hooks.allocate = allocator->allocate, hooks.free = allocator->free,
        hooks.memory_user_data = allocator->user_data;
    Memory memory(hooks);
    Array<Vec3f> vertices(memory);
    for (uint32_t i = 0; i < def.vertex_count; ++i)
        vertices.emplace_back(def.vertices[i].x, def.vertices[i].y, def.vertices[i].z);
    collision::TriangleSoup soup(memory);
    const collision::WeldCounts counts =
        collision::weld(vertices, {def.indices, 3 * size_t{def.triangle_count}}, def.close_holes != 0, soup, memory);
    if (counts.open_edges > 0 && def.close_holes == 0)
        return refuse(TAUT_INVALID_ARGUMENT,
                      "%s: the mesh is open at %u edges, expected two triangles at each, going round the same way",
                      call, counts.open_edges);
    if (soup.triangles() == 0) return refuse(TAUT_INVALID_ARGUMENT, "%s: no triangle has an area", call);
    const collision::ClosedSolid solid(soup, memory);
    const double longest = (solid.box().hi - solid.box().lo).maxCoeff();
    if (!(std::fabs(solid.signed_volume()) > kNoVolume * longest * longest * longest))
        return refuse(TAUT_INVALID_ARGUMENT, "%s: the mesh encloses no volume", call);
    const double tolerance =
        def.tolerance > 0 ? double(def.tolerance) : std::max(kDefaultTolerance * longest, double(TAUT_SHAPE_MIN_SIZE));
    const Array<collision::ConvexPart> found = collision::decompose(
        soup, solid, {tolerance, def.max_parts, static_cast<int>(def.max_vertices), TAUT_SHAPE_MIN_SIZE}, memory);
    taut_baked own[TAUT_DECOMPOSITION_MAX_PARTS];
    BakedParts baked(own);
    double departure = 0, shortfall = 0;
    for (const collision::ConvexPart& part : found) {
        if (const taut_result result = baked.add(part, allocator); result != TAUT_OK)
            return refuse(result, "%s: baking a part: %s", call, taut_result_name(result));
        departure = std::max(departure, part.departure);
        shortfall = std::max(shortfall, part.shortfall);
    }
    if (baked.count == 0) return refuse(TAUT_INVALID_ARGUMENT, "%s: the mesh makes no hull", call);
    const collision::MassProperties mass = solid.mass_properties();
    info = {baked.count,         counts.without_area,
            counts.open_edges,   to_float(departure),
            to_float(shortfall), {to_float(mass.mass), to_vec3(mass.centre), to_sym3(mass.inertia)}};
    std::copy_n(own, baked.count, parts);
    *count = baked.count;
    baked.count = 0;
    return TAUT_OK;
}

}  // namespace

void taut_decomposition_def_init_sized(taut_decomposition_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_decomposition_def& own) {
        init_shape_def(&own, {0, 0, nullptr, nullptr, 0, 32, TAUT_HULL_MAX_VERTICES, 0, 0, 0});
    });
}

taut_result taut_bake_decomposition_sized(const taut_decomposition_def* given, const taut_allocator* allocator,
                                          taut_baked* parts, uint32_t capacity, uint32_t* count,
                                          taut_decomposition_info* first, uint32_t size) {
    Check check("taut_bake_decomposition");
    taut_decomposition_def def;
    if (!check.pointer("count", count) || !check.pointer("parts", parts) ||
        !take_def(check, given, taut_decomposition_def_init, def) || !check_decomposition(check, def))
        return check.result();
    if (allocator && !allocator->allocate != !allocator->free)
        return refuse(TAUT_INVALID_ARGUMENT, "%s: allocate and free: one of them is null, expected both or neither",
                      check.call());
    if (capacity < def.max_parts) {
        *count = def.max_parts;
        return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least max_parts, %u", check.call(), capacity,
                      def.max_parts);
    }
    return contain(check.call(), [&] {
        taut_decomposition_info info{};
        const taut_result result = bake_parts(check.call(), def, allocator, parts, count, info);
        if (result == TAUT_OK && first) *RecordOut<taut_decomposition_info>(first, size) = info;
        return result;
    });
}
