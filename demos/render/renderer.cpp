#include "renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "egl_context.h"
#include "hud_batch.h"
#include "program.h"
#include "shaders.h"

namespace render {

namespace {

constexpr int kZenithMapSize = 1024;
constexpr float kOverlayPull = 0.5f;  // [m]; see Pass::overlay
// Of a camera no further away than usual, else in proportion: how far one sees, the ground's half width, haze [1/m].
constexpr float kUsual = 30, kFar = 900, kGround = 600, kHaze = 0.009f;
constexpr float kGhost = 0.25f;  // share of a pixel that ghosts cover
constexpr int kSunUnit = 1, kZenithUnit = 2, kSunDepthUnit = 3, kAroundUnit = 4;
constexpr float kSunTangent = 0.015f;  // of its half angle: a light through thin clouds, three times as wide as the sun
constexpr float kAroundReach = 0.045f;                // of the distance of what is looked at
const Vec3 kSun = normalised({0.42f, 0.80f, 0.43f});  // towards the sun

// What the GPU reads for one instance.
struct PackedInstance {
    Vec3 position, scale;
    Quat rotation;
    Colour colour;
    float gloss;
};

struct GpuMesh {
    GLuint array = 0, vertices = 0;
    GLsizei count = 0;
};

GpuMesh upload(const std::vector<Vertex>& mesh, GLuint instances) {
    GpuMesh gpu;
    gpu.count = static_cast<GLsizei>(mesh.size());
    glGenVertexArrays(1, &gpu.array);
    glGenBuffers(1, &gpu.vertices);
    glBindVertexArray(gpu.array);
    glBindBuffer(GL_ARRAY_BUFFER, gpu.vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.size() * sizeof(Vertex)), mesh.data(), GL_STATIC_DRAW);
    for (GLuint i = 0; i < 2; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                              reinterpret_cast<const void*>(i * sizeof(Vec3)));
    }
    glBindBuffer(GL_ARRAY_BUFFER, instances);
    for (GLuint i = 2; i < 6; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribDivisor(i, 1);
    }
    return gpu;
}

// An array for surfaces, whose corners bring their colour; they are placed in the world already.
GpuMesh surface_array() {
    GpuMesh gpu;
    glGenVertexArrays(1, &gpu.array);
    glGenBuffers(1, &gpu.vertices);
    glBindVertexArray(gpu.array);
    glBindBuffer(GL_ARRAY_BUFFER, gpu.vertices);
    const struct {
        GLuint index;
        GLint count;
        size_t offset;
    } fields[] = {{0, 3, offsetof(SurfaceVertex, position)},
                  {1, 3, offsetof(SurfaceVertex, normal)},
                  {5, 4, offsetof(SurfaceVertex, colour)}};
    for (const auto& field : fields) {
        glEnableVertexAttribArray(field.index);
        glVertexAttribPointer(field.index, field.count, GL_FLOAT, GL_FALSE, sizeof(SurfaceVertex),
                              reinterpret_cast<const void*>(field.offset));
    }
    return gpu;
}
static_assert(offsetof(SurfaceVertex, gloss) == offsetof(SurfaceVertex, colour) + sizeof(Colour));

// Points the instance attributes of the bound array at the instances from first on (GL 3.3 has no base instance).
void point_at_instances(size_t first) {
    const struct {
        GLint count;
        size_t offset;
    } fields[] = {{3, offsetof(PackedInstance, position)},
                  {3, offsetof(PackedInstance, scale)},
                  {4, offsetof(PackedInstance, rotation)},
                  {4, offsetof(PackedInstance, colour)}};
    for (GLuint i = 0; i < 4; ++i)
        glVertexAttribPointer(2 + i, fields[i].count, GL_FLOAT, GL_FALSE, sizeof(PackedInstance),
                              reinterpret_cast<const void*>(first * sizeof(PackedInstance) + fields[i].offset));
}

}  // namespace

struct Renderer::Inside {
    explicit Inside(const RendererOptions& o)
        : options(o),
          target(o.width, o.height, o.samples),
          sun_map(o.shadow_size),
          zenith_map(kZenithMapSize),
          around(o.width, o.height),
          solid({shaders::kSolidVertex}, {shaders::kLight, shaders::kSolidFragment}),
          depth({shaders::kSolidVertex}, {shaders::kDepthFragment}),
          ground({shaders::kGroundVertex}, {shaders::kLight, shaders::kGroundFragment}),
          ground_depth({shaders::kGroundVertex}, {shaders::kDepthFragment}),
          around_found({shaders::kScreenVertex}, {shaders::kAroundFragment}),
          around_blur({shaders::kScreenVertex}, {shaders::kAroundBlur}),
          sky({shaders::kSkyVertex}, {shaders::kLight, shaders::kSkyFragment}),
          hud(o.width, o.height) {
        glGenVertexArrays(1, &empty_array);
        glGenBuffers(1, &instance_buffer);
        glGenSamplers(1, &plain_sampler);
        for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glSamplerParameteri(plain_sampler, filter, GL_NEAREST);
        glSamplerParameteri(plain_sampler, GL_TEXTURE_COMPARE_MODE, GL_NONE);
        for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
            glSamplerParameteri(plain_sampler, wrap, GL_CLAMP_TO_EDGE);
        for (const auto& mesh : {box_mesh(), sphere_mesh(24), sphere_mesh(6), cylinder_mesh(16), cylinder_mesh(64)})
            meshes.push_back(upload(mesh, instance_buffer));
        surface = surface_array();
        picture.width = o.width;
        picture.height = o.height;
        picture.rgb.resize(3 * static_cast<size_t>(o.width) * static_cast<size_t>(o.height));
        rows.resize(4 * static_cast<size_t>(o.width) * static_cast<size_t>(o.height));
        set_stage({});
    }
    ~Inside() {
        for (GpuMesh& mesh : meshes) {
            glDeleteVertexArrays(1, &mesh.array);
            glDeleteBuffers(1, &mesh.vertices);
        }
        glDeleteVertexArrays(1, &surface.array);
        glDeleteBuffers(1, &surface.vertices);
        glDeleteBuffers(1, &instance_buffer);
        glDeleteSamplers(1, &plain_sampler);
        glDeleteVertexArrays(1, &empty_array);
    }

    void set_stage(const Stage& s) {
        stage = s;
        Vec3 low = s.low, high = s.high;
        if (s.ground) low.y = std::min(low.y, s.ground_height);
        sun_map.fit(kSun * -1.0f, low, high);
        zenith_map.fit({0, -1, 0}, low, high);
    }

    void sort_instances(const std::vector<Instance>& list);
    void take_surfaces(const std::vector<SurfaceVertex>& list);
    void draw_pass(Program& program, Pass pass);
    void draw_depth(DepthMap& map);
    void draw_ground(Program& program, const Camera& camera);
    void draw_around(const Camera& camera);
    void set_light(Program& program, const Camera& camera);
    struct View {
        float far;         // [m]
        float across, up;  // tangents of half the field of view
        ViewAxes axes;
        Mat4 clip;
    };
    View view_of(const Camera& camera) const;
    void draw_world(const Camera& camera);
    void read_back();

    EglContext context;  // first: everything below needs it
    RendererOptions options;
    PictureTarget target;
    DepthMap sun_map, zenith_map;
    AroundMap around;
    Program solid, depth, ground, ground_depth, around_found, around_blur, sky;
    HudBatch hud;
    GLuint empty_array = 0, instance_buffer = 0;
    GLuint plain_sampler = 0;  // of depths as numbers
    std::vector<GpuMesh> meshes;
    GpuMesh surface;
    Stage stage;
    struct Run {
        uint32_t mesh;
        Pass pass;
        size_t first, count;
    };
    std::vector<Run> runs;  // of the uploaded instances, by pass and mesh
    std::vector<uint8_t> rows;
    Picture picture;
};

void Renderer::Inside::sort_instances(const std::vector<Instance>& list) {
    std::vector<uint32_t> order(list.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    auto key = [&](uint32_t i) { return std::pair(list[i].pass, list[i].mesh); };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    std::vector<PackedInstance> packed;
    runs.clear();
    for (uint32_t i : order) {
        const Instance& it = list[i];
        if (it.mesh >= meshes.size()) throw std::runtime_error("draw list names a mesh that was never added");
        if (runs.empty() || runs.back().mesh != it.mesh || runs.back().pass != it.pass)
            runs.push_back({it.mesh, it.pass, packed.size(), 0});
        ++runs.back().count;
        packed.push_back({it.position, it.scale, it.rotation, it.colour, it.gloss});
    }
    glBindBuffer(GL_ARRAY_BUFFER, instance_buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(packed.size() * sizeof(PackedInstance)), packed.data(),
                 GL_STREAM_DRAW);
}

void Renderer::Inside::take_surfaces(const std::vector<SurfaceVertex>& list) {
    surface.count = static_cast<GLsizei>(list.size());
    glBindBuffer(GL_ARRAY_BUFFER, surface.vertices);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(list.size() * sizeof(SurfaceVertex)), list.data(),
                 GL_STREAM_DRAW);
}

void Renderer::Inside::draw_pass(Program& program, Pass pass) {
    for (const Run& run : runs) {
        if (run.pass != pass) continue;
        program.set("bevelled", run.mesh == kMeshBox ? 1 : 0);
        glBindVertexArray(meshes[run.mesh].array);
        glBindBuffer(GL_ARRAY_BUFFER, instance_buffer);
        point_at_instances(run.first);
        glDrawArraysInstanced(GL_TRIANGLES, 0, meshes[run.mesh].count, static_cast<GLsizei>(run.count));
    }
    if (pass != Pass::solid || surface.count == 0) return;
    program.set("bevelled", 0);
    glBindVertexArray(surface.array);
    glVertexAttrib3f(2, 0, 0, 0);
    glVertexAttrib3f(3, 1, 1, 1);
    glVertexAttrib4f(4, 0, 0, 0, 1);
    glDrawArrays(GL_TRIANGLES, 0, surface.count);
}

void Renderer::Inside::draw_depth(DepthMap& map) {
    glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer);
    glViewport(0, 0, map.size, map.size);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_CLAMP);
    depth.use();
    depth.set("clip_from_world", map.clip_from_world);
    depth.set("pull", 0.0f);
    draw_pass(depth, Pass::solid);
    glDisable(GL_DEPTH_CLAMP);
}

Renderer::Inside::View Renderer::Inside::view_of(const Camera& camera) const {
    const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
    View view;
    view.far = kFar * std::max(1.0f, length(camera.target - camera.eye) / kUsual);
    view.up = std::tan(0.5f * camera.vertical_fov);
    view.across = view.up * aspect;
    view.axes = view_axes(normalised(camera.target - camera.eye));
    view.clip =
        perspective(camera.vertical_fov, aspect, near_plane(camera), view.far) * view_matrix(camera.eye, view.axes);
    return view;
}

void Renderer::Inside::draw_ground(Program& program, const Camera& camera) {
    if (!stage.ground) return;
    const View view = view_of(camera);
    program.set("clip_from_world", view.clip);
    program.set("eye", camera.eye);
    program.set("height", stage.ground_height);
    program.set("half_width", kGround / kFar * view.far);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(empty_array);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glEnable(GL_CULL_FACE);
}

// How far away everything is, then how much light what is near keeps off, then that without its pattern.
void Renderer::Inside::draw_around(const Camera& camera) {
    const View view = view_of(camera);
    const float reach = kAroundReach * length(camera.target - camera.eye);
    glViewport(0, 0, around.width, around.height);
    glBindFramebuffer(GL_FRAMEBUFFER, around.depth_framebuffer);
    glClear(GL_DEPTH_BUFFER_BIT);
    depth.use();
    depth.set("clip_from_world", view.clip);
    draw_pass(depth, Pass::solid);
    ground_depth.use();
    draw_ground(ground_depth, camera);

    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(empty_array);
    glActiveTexture(GL_TEXTURE0 + kAroundUnit);
    glBindFramebuffer(GL_FRAMEBUFFER, around.found_framebuffer);
    glBindTexture(GL_TEXTURE_2D, around.depths);
    around_found.use();
    around_found.set("depths", kAroundUnit);
    around_found.set("planes", near_plane(camera), view.far);
    around_found.set("tangents", view.across, view.up);
    around_found.set("around_reach", reach);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindFramebuffer(GL_FRAMEBUFFER, around.blurred_framebuffer);
    glBindTexture(GL_TEXTURE_2D, around.found);
    around_blur.use();
    around_blur.set("around", kAroundUnit);
    around_blur.set("around_reach", reach);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
}

void Renderer::Inside::set_light(Program& program, const Camera& camera) {
    program.use();
    program.set("sun", kSun);
    program.set("eye", camera.eye);
    program.set("haze", kHaze / std::max(1.0f, length(camera.target - camera.eye) / kUsual));
    program.set("sun_clip", sun_map.clip_from_world);
    program.set("zenith_clip", zenith_map.clip_from_world);
    program.set("texel", sun_map.texel, zenith_map.texel);
    program.set("sun_map", kSunUnit);
    program.set("zenith_map", kZenithUnit);
    program.set("sun_depths", kSunDepthUnit);
    program.set("sun_right", sun_map.axes.right);
    program.set("sun_up", sun_map.axes.up);
    program.set("sun_scale", sun_map.scale_x, sun_map.scale_y);
    program.set("sun_depth", sun_map.depth);
    program.set("sun_tangent", kSunTangent);
    program.set("around", kAroundUnit);
    program.set("around_reach", kAroundReach * length(camera.target - camera.eye));
}

void Renderer::Inside::draw_world(const Camera& camera) {
    const View view = view_of(camera);
    const std::pair<int, GLuint> maps[] = {{kSunUnit, sun_map.texture},
                                           {kZenithUnit, zenith_map.texture},
                                           {kSunDepthUnit, sun_map.texture},
                                           {kAroundUnit, around.blurred}};
    for (const auto& [unit, texture] : maps) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_2D, texture);
    }
    glBindSampler(kSunDepthUnit, plain_sampler);

    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    set_light(sky, camera);
    sky.set("right", view.axes.right * view.across);
    sky.set("up", view.axes.up * view.up);
    sky.set("back", view.axes.back);
    glBindVertexArray(empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);

    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    set_light(solid, camera);
    solid.set("clip_from_world", view.clip);
    solid.set("viewer", camera.eye);
    solid.set("unlit", 0);
    solid.set("pull", 0.0f);
    solid.set("cover", 1.0f);
    draw_pass(solid, Pass::solid);

    set_light(ground, camera);
    draw_ground(ground, camera);

    solid.use();
    solid.set("cover", kGhost);
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    draw_pass(solid, Pass::ghost);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    solid.set("cover", 1.0f);
    solid.set("unlit", 1);
    solid.set("pull", kOverlayPull);
    draw_pass(solid, Pass::overlay);
    glBindSampler(kSunDepthUnit, 0);
}

void Renderer::Inside::read_back() {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.resolved);
    glReadPixels(0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
    if (GLenum error = glGetError(); error != GL_NO_ERROR)
        throw std::runtime_error("OpenGL error " + std::to_string(error) + " while drawing");
    size_t width = static_cast<size_t>(options.width), height = static_cast<size_t>(options.height);
    for (size_t y = 0; y < height; ++y) {
        const uint8_t* from = rows.data() + 4 * width * (height - 1 - y);
        uint8_t* to = picture.rgb.data() + 3 * width * y;
        for (size_t x = 0; x < width; ++x, from += 4, to += 3) to[0] = from[0], to[1] = from[1], to[2] = from[2];
    }
}

Renderer::Renderer(const RendererOptions& options) : inside_(std::make_unique<Inside>(options)) {}
Renderer::~Renderer() = default;

std::string Renderer::description() const {
    const EglContext& c = inside_->context;
    std::string text = "GL: " + c.renderer() + ", " + (c.software() ? "software" : "hardware") + ", through EGL " +
                       c.platform() + "\nGL: version " + c.version() + ", " + std::to_string(samples()) +
                       " samples a pixel";
    if (samples() < inside_->options.samples)
        text += " (the driver offers no more; " + std::to_string(inside_->options.samples) + " were wanted)";
    return text;
}

std::string Renderer::gl_renderer() const { return inside_->context.renderer(); }
int Renderer::samples() const { return inside_->target.samples; }
bool Renderer::software() const { return inside_->context.software(); }

uint32_t Renderer::add_mesh(const std::vector<Vertex>& mesh) {
    inside_->meshes.push_back(upload(mesh, inside_->instance_buffer));
    return static_cast<uint32_t>(inside_->meshes.size() - 1);
}

void Renderer::set_stage(const Stage& stage) { inside_->set_stage(stage); }

const Picture& Renderer::draw(const DrawList& list) {
    Inside& in = *inside_;
    in.sort_instances(list.instances);
    in.take_surfaces(list.surfaces);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    in.draw_depth(in.sun_map);
    in.draw_depth(in.zenith_map);
    in.draw_around(list.camera);

    int width = in.options.width, height = in.options.height;
    glBindFramebuffer(GL_FRAMEBUFFER, in.target.drawn);
    glViewport(0, 0, width, height);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    in.draw_world(list.camera);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, in.target.drawn);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, in.target.resolved);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, in.target.resolved);
    in.hud.draw(list);
    glDisable(GL_FRAMEBUFFER_SRGB);
    in.read_back();
    return in.picture;
}

}  // namespace render
