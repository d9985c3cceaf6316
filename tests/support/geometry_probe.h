// A small world on the device, asked through shaders/lib/traversal.glsl and lib/primitives.glsl, and by brute
// force.
#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "host/geometry/bvh.h"
#include "host/scene/classes.h"
#include "host/scene/records.h"
#include "host/geometry/unrolled_traversal.h"
#include "host/geometry/world.h"
#include "tests/support/device_fixture.h"
#include "tests/support/micro_probe.h"

namespace etendue {

struct ProbeRay {
    glm::vec3 origin;
    float t_max;
    glm::vec3 direction;
    float unused = 0;
};

struct ProbeHit {
    float t;
    glm::vec2 uv;
    uint32_t primitive, instance;
};

struct ProbeTrace {
    ProbeHit hit;                                                 // by the hierarchy
    ProbeHit expected;                                            // by trying every primitive
    uint32_t occluded;                                            // by find_occlusion
    glm::vec3 position, error, geometric_normal, shading_normal;  // of `hit`
    glm::vec3 onward;  // where a ray that goes straight on leaves the surface
};

class GeometryProbe {
  public:
    GeometryProbe();
    void add_triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
    // `parameters` of the class as a scene gives them, `local` its box. A patch is cut into its pieces.
    void add_shape(const std::string& class_name, const nlohmann::json& parameters, const Box& local,
                   const glm::dmat4& world_from_local);
    uint32_t add_cell(const std::vector<glm::vec3>& corners);      // for the parameter of that name
    const MicroTables& places() const { return micro_.places(); }  // of files that parameters have named
    uint32_t add_mesh(const std::vector<glm::vec3>& vertices);     // three a triangle, for instances
    void add_instance(uint32_t mesh, const glm::dmat4& world_from_local);

    // Builds the hierarchies and compiles what the world needs.
    void build();
    // Puts straight code in the place of the hierarchy (host/geometry/unrolled_traversal.h), after build().
    UnrolledTraversal unroll();

    // `brute_force` = false leaves `expected` undefined and takes a fraction of the time.
    std::vector<ProbeTrace> trace(const std::vector<ProbeRay>& rays, bool brute_force = true);
    std::vector<ProbeHit> find_hits(const std::vector<ProbeRay>& rays);  // by the kernel of that name

    // Of a kernel that includes lib/primitives.glsl; `buffers` are the kernel's own.
    Kernel kernel(const std::string& name, const std::string& text, BufferTable buffers,
                  const std::string& defines = "");

    const std::vector<PrimitiveRecord>& primitives() const { return world_.primitives; }

  private:
    struct Mesh {
        std::vector<PrimitiveRecord> triangles;
        Box bounds;
    };
    void place(const glm::dmat4& world_from_local, PrimitiveKind kind, const Box& local);

    ClassRegistry registry_;
    RecordBuffer records_;
    MicroProbe micro_;
    std::vector<std::pair<const ClassInfo*, uint32_t>> shapes_;  // class and index in it, by transform
    std::vector<Mesh> meshes_;
    std::vector<uint32_t> instance_meshes_;  // by transform
    std::vector<PrimitiveRecord> placed_;
    std::vector<Box> boxes_;
    SceneDescription scene_;
    World world_;
    ShaderSources sources_;
    Features features_;
    Buffer nodes_, primitives_, transforms_, geometry_;
};

// Sphere of 2^(2 n) * 20 triangles around the origin by subdividing an icosahedron.
std::vector<glm::vec3> icosphere(int subdivisions, float radius);

}  // namespace etendue
