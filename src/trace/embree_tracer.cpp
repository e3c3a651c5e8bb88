// The ray tracing back end: Embree, API 3 or 4 (LUMEL_EMBREE_MAJOR). The only file that includes it.
//
// Rays go to Embree in packets of eight. A filter on every geometry decides which hits count: not the triangle that the
// ray starts on, not where the material lets it through, and of equally near triangles the one with the lowest id.
#if LUMEL_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/denormals.h"
#include "trace/tracer.h"

namespace lumel {
namespace {

constexpr std::size_t kPacket = 8;         // rays per Embree call
constexpr std::size_t kPacketsAtOnce = 8;  // packed before the clock starts, unpacked after it stops

// ---- What differs between the two APIs ------------------------------------------------------------------------------

#if LUMEL_EMBREE_MAJOR == 4
using QueryContext = RTCRayQueryContext;
void init(QueryContext& context) { rtcInitRayQueryContext(&context); }
void intersect(const int* valid, RTCScene scene, QueryContext& context, RTCRayHit8& packet) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect8(valid, scene, &packet, &arguments);
}
void occlude(const int* valid, RTCScene scene, QueryContext& context, RTCRay8& packet) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded8(valid, scene, &packet, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
void init(QueryContext& context) { rtcInitIntersectContext(&context); }
void intersect(const int* valid, RTCScene scene, QueryContext& context, RTCRayHit8& packet) {
    rtcIntersect8(valid, scene, &context, &packet);
}
void occlude(const int* valid, RTCScene scene, QueryContext& context, RTCRay8& packet) {
    rtcOccluded8(valid, scene, &context, &packet);
}
#endif

// ---- Owned handles --------------------------------------------------------------------------------------------------

template <class Handle, void (*release)(Handle)>
class Owned {
public:
    explicit Owned(Handle handle = nullptr) : handle_(handle) {}
    ~Owned() { reset(); }
    Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Owned& operator=(Owned&& other) noexcept {
        reset();
        handle_ = std::exchange(other.handle_, nullptr);
        return *this;
    }
    [[nodiscard]] Handle get() const { return handle_; }

private:
    void reset() {
        if (handle_) release(handle_);
        handle_ = nullptr;
    }
    Handle handle_;
};
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using Geometry = Owned<RTCGeometry, rtcReleaseGeometry>;
using Buffer = Owned<RTCBuffer, rtcReleaseBuffer>;
using SceneHandle = Owned<RTCScene, rtcReleaseScene>;

// ---- Counting -------------------------------------------------------------------------------------------------------

// A few counters on cache lines of their own; threads spread over them by their id, so that they rarely meet.
class Counters {
public:
    void add(std::uint64_t rays, std::uint64_t invalid, std::uint64_t nanoseconds) {
        Slot& slot = slots_[std::hash<std::thread::id>{}(std::this_thread::get_id()) % kSlots];
        slot.rays.fetch_add(rays, std::memory_order_relaxed);
        slot.nanoseconds.fetch_add(nanoseconds, std::memory_order_relaxed);
        if (invalid > 0) slot.invalid.fetch_add(invalid, std::memory_order_relaxed);
    }
    [[nodiscard]] TraceStatistics sum() const {
        TraceStatistics total;
        std::uint64_t nanoseconds = 0;
        for (const Slot& slot : slots_) {
            total.rays += slot.rays.load(std::memory_order_relaxed);
            total.invalid += slot.invalid.load(std::memory_order_relaxed);
            nanoseconds += slot.nanoseconds.load(std::memory_order_relaxed);
        }
        total.seconds = 1e-9 * static_cast<double>(nanoseconds);
        return total;
    }

private:
    static constexpr std::size_t kSlots = 61;  // prime: thread ids are addresses, multiples of a power of two
    struct alignas(64) Slot {
        std::atomic<std::uint64_t> rays{0}, invalid{0}, nanoseconds{0};
    };
    std::array<Slot, kSlots> slots_;
};

class Stopwatch {
public:
    [[nodiscard]] std::uint64_t nanoseconds() const {
        return static_cast<std::uint64_t>(
            std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start_).count());
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// ---- The filter -----------------------------------------------------------------------------------------------------

// What the filter knows of one packet. Embree's context comes first: the filter is handed a pointer to it.
struct Query {
    QueryContext context;
    std::span<const Ray> rays;               // RTCRay::id is the index
    std::array<float, kPacket> t;            // of the nearest hit so far
    std::array<std::uint32_t, kPacket> hit;  // its world triangle
};

// Triangles of one Embree geometry. Those with MASK or BLEND materials have one of their own: the others need no
// lookup.
struct Part {
    std::vector<std::uint32_t> world_triangle;  // of each Embree primitive
    const SurfaceReader* surfaces = nullptr;    // null: all opaque
};

bool lets_through(const Part& part, const Ray& ray, std::uint32_t triangle, float b1, float b2) {
    if (triangle == ray.skip) return true;
    return part.surfaces && !stops_ray(part.surfaces->opacity(triangle, b1, b2), ray.alpha_key, triangle);
}

template <bool nearest>
void filter(const RTCFilterFunctionNArguments* arguments) {
    const Part& part = *static_cast<const Part*>(arguments->geometryUserPtr);
    Query& query = *reinterpret_cast<Query*>(arguments->context);
    const unsigned n = arguments->N;
    for (unsigned i = 0; i < n; ++i) {
        if (arguments->valid[i] == 0) continue;
        const unsigned id = RTCRayN_id(arguments->ray, n, i);
        const std::uint32_t triangle = part.world_triangle[RTCHitN_primID(arguments->hit, n, i)];
        const float b1 = RTCHitN_u(arguments->hit, n, i), b2 = RTCHitN_v(arguments->hit, n, i);
        if (lets_through(part, query.rays[id], triangle, b1, b2)) {
            arguments->valid[i] = 0;
        } else if constexpr (nearest) {
            const float t = RTCRayN_tfar(arguments->ray, n, i);
            if (t == query.t[id] && triangle > query.hit[id]) {
                arguments->valid[i] = 0;
            } else {
                query.t[id] = t;
                query.hit[id] = triangle;
            }
        }
    }
}

// ---- Packing --------------------------------------------------------------------------------------------------------

void clear_lane(RTCRay8& packet, std::size_t lane) {
    packet.org_x[lane] = packet.org_y[lane] = packet.org_z[lane] = packet.tnear[lane] = 0.0f;
    packet.dir_x[lane] = packet.dir_y[lane] = 0.0f;
    packet.dir_z[lane] = 1.0f;
    packet.tfar[lane] = packet.time[lane] = 0.0f;
    packet.mask[lane] = 0;
    packet.id[lane] = static_cast<unsigned>(lane);
    packet.flags[lane] = 0;
}

void set_lane(RTCRay8& packet, std::size_t lane, const Ray& ray) {
    packet.org_x[lane] = ray.origin.x;
    packet.org_y[lane] = ray.origin.y;
    packet.org_z[lane] = ray.origin.z;
    packet.tnear[lane] = ray.tmin;
    packet.dir_x[lane] = ray.direction.x;
    packet.dir_y[lane] = ray.direction.y;
    packet.dir_z[lane] = ray.direction.z;
    packet.time[lane] = 0.0f;
    packet.tfar[lane] = ray.tmax;
    packet.mask[lane] = 0xffffffffu;
    packet.id[lane] = static_cast<unsigned>(lane);
    packet.flags[lane] = 0;
}

struct PacketMask {
    alignas(32) std::array<int, kPacket> valid;  // -1 or 0
};

// Fills a packet and its mask; returns how many rays broke the precondition.
std::uint64_t pack(std::span<const Ray> rays, RTCRay8& packet, PacketMask& mask, Query& query) {
    std::uint64_t invalid = 0;
    init(query.context);
    query.rays = rays;
    query.t.fill(std::numeric_limits<float>::infinity());
    query.hit.fill(kNone);
    for (std::size_t lane = 0; lane < kPacket; ++lane) {
        const bool traceable = lane < rays.size() && is_traceable(rays[lane]);
        mask.valid[lane] = traceable ? -1 : 0;
        if (traceable) {
            set_lane(packet, lane, rays[lane]);
        } else {
            clear_lane(packet, lane);
            invalid += lane < rays.size() ? 1 : 0;
        }
    }
    return invalid;
}

// ---- Building -------------------------------------------------------------------------------------------------------

// One instruction set for every machine that has it, so that their bits agree.
const char* pinned_isa() {
#if defined(__x86_64__) || defined(__i386__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "avx2";
    if (__builtin_cpu_supports("avx")) return "avx";
    if (__builtin_cpu_supports("sse4.2")) return "sse4.2";
    return "sse2";
#else
    return "";  // the one that there is
#endif
}

std::string describe(RTCDevice device, const char* isa) {
    const auto number = [device](RTCDeviceProperty property) {
        return std::to_string(rtcGetDeviceProperty(device, property));
    };
    const std::string version = number(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." +
                                number(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
                                number(RTC_DEVICE_PROPERTY_VERSION_PATCH);
    return "Embree " + version + ", isa " + (*isa ? isa : "default");
}

constexpr const char* kMemoryRemedy = "use a machine with more memory or a smaller scene";

Error embree_error(RTCError code, const std::string& doing) {
    if (code == RTC_ERROR_CANCELLED) return cancelled_error();
    const std::string message = "Embree failed " + doing + " (error " + std::to_string(static_cast<int>(code)) + ")";
    if (code == RTC_ERROR_UNSUPPORTED_CPU) return {ErrorCode::unsupported, message, {}, {}};
    return {ErrorCode::out_of_memory, message, {}, kMemoryRemedy};
}

// Of the device; null: of the attempt to make one.
Error last_error(RTCDevice device, const std::string& doing) { return embree_error(rtcGetDeviceError(device), doing); }

// Embree reads 16 bytes at each 12-byte vertex, hence the room behind the last one.
Buffer make_vertex_buffer(RTCDevice device, std::span<const Vec3> positions) {
    static_assert(sizeof(Vec3) == 12);
    Buffer buffer(rtcNewBuffer(device, positions.size_bytes() + 16));
    void* data = buffer.get() ? rtcGetBufferData(buffer.get()) : nullptr;
    if (!data) return Buffer();
    if (!positions.empty()) std::memcpy(data, positions.data(), positions.size_bytes());
    return buffer;
}

class EmbreeTracer final : public Tracer {
public:
    EmbreeTracer(const WorldGeometry& geometry, SurfaceReader surfaces) : geometry_(geometry), surfaces_(surfaces) {}

    Status build(Context& context);

    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override;
    [[nodiscard]] TraceStatistics statistics() const override { return counters_.sum(); }
    [[nodiscard]] std::string_view description() const override { return description_; }

private:
    void split_by_alpha();
    Status add_part(Part& part, RTCBuffer vertices);
    void trace_block(std::span<const Ray> rays, std::span<Hit> hits) const;
    void trace_block(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;
    [[nodiscard]] Hit unpack(const RTCRayHit8& packet, std::size_t lane) const;

    const WorldGeometry& geometry_;
    SurfaceReader surfaces_;
    std::string description_;
    std::array<Part, 2> parts_;  // opaque, alpha; in the order of Embree's geometry ids, which skip empty parts
    std::array<const Part*, 2> part_of_geometry_{};
    Device device_;
    SceneHandle scene_;
    mutable Counters counters_;
};

void EmbreeTracer::split_by_alpha() {
    for (std::uint32_t triangle = 0; triangle < geometry_.triangle_count(); ++triangle) {
        const bool alpha = (geometry_.triangles[triangle].flags & kNeedsAlpha) != 0;
        parts_[alpha ? 1 : 0].world_triangle.push_back(triangle);
    }
    parts_[1].surfaces = &surfaces_;
}

Status EmbreeTracer::add_part(Part& part, RTCBuffer vertices) {
    if (part.world_triangle.empty()) return success();
    Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    if (!geometry.get()) return last_error(device_.get(), "making a geometry");
    rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices, 0, sizeof(Vec3),
                         geometry_.positions.size());
    auto* indices =
        static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                            3 * sizeof(std::uint32_t), part.world_triangle.size()));
    if (!indices) return last_error(device_.get(), "allocating indices");
    for (const std::uint32_t triangle : part.world_triangle)
        indices = std::ranges::copy(geometry_.triangles[triangle].vertices, indices).out;
    rtcSetGeometryUserData(geometry.get(), &part);
    rtcSetGeometryIntersectFilterFunction(geometry.get(), filter<true>);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), filter<false>);
    rtcCommitGeometry(geometry.get());
    const unsigned id = rtcAttachGeometry(scene_.get(), geometry.get());
    LUMEL_CHECK(id < part_of_geometry_.size(), id);
    part_of_geometry_[id] = &part;
    return success();
}

// What Embree's builder calls as it goes on. Of a build on one thread that is the thread that asked for it; of another
// Embree's it need not be, and progress is for the coordinating thread alone.
class BuildMonitor {
public:
    explicit BuildMonitor(Context& context) : context_(context) {}

    // False stops the build. Spatial splits make more work than the share counts: it may pass 1.
    static bool look(void* monitor, double share) { return static_cast<BuildMonitor*>(monitor)->look(share); }

private:
    bool look(double share) {
        if (std::this_thread::get_id() == thread_ && share > share_) {
            share_ = share;
            context_.report("acceleration", std::min(share, 1.0));
        }
        return !context_.cancelled();
    }

    Context& context_;
    std::thread::id thread_ = std::this_thread::get_id();
    double share_ = 0.0;
};

// Embree builds on one thread, so that the shape of its tree cannot depend on how threads share the work: what a ray
// meets among surfaces within rounding of one another may depend on the order in which the tree visits them.
Status EmbreeTracer::build(Context& context) {
    const char* isa = pinned_isa();
    const std::string config = "threads=1" + (*isa ? ",isa=" + std::string(isa) : std::string());
    device_ = Device(rtcNewDevice(config.c_str()));
    if (!device_.get()) return last_error(nullptr, "starting");
    description_ = describe(device_.get(), isa);
    scene_ = SceneHandle(rtcNewScene(device_.get()));
    if (!scene_.get()) return last_error(device_.get(), "making a scene");
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);

    split_by_alpha();
    const Buffer vertices = make_vertex_buffer(device_.get(), geometry_.positions);
    if (!vertices.get()) return last_error(device_.get(), "allocating vertices");
    for (Part& part : parts_)
        if (Status status = add_part(part, vertices.get()); !status.ok()) return status;
    if (context.cancelled()) return embree_error(RTC_ERROR_CANCELLED, {});
    BuildMonitor monitor(context);
    rtcSetSceneProgressMonitorFunction(scene_.get(), BuildMonitor::look, &monitor);
    rtcCommitScene(scene_.get());
    rtcSetSceneProgressMonitorFunction(scene_.get(), nullptr, nullptr);
    if (const RTCError code = rtcGetDeviceError(device_.get()); code != RTC_ERROR_NONE)
        return embree_error(code, "building");
    context.report("acceleration", 1.0);
    return success();
}

// ---- Tracing --------------------------------------------------------------------------------------------------------

Hit EmbreeTracer::unpack(const RTCRayHit8& packet, std::size_t lane) const {
    if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return {};
    Hit hit;
    hit.triangle = part_of_geometry_[packet.hit.geomID[lane]]->world_triangle[packet.hit.primID[lane]];
    hit.t = packet.ray.tfar[lane];
    hit.b1 = packet.hit.u[lane];
    hit.b2 = packet.hit.v[lane];
    const float towards = packet.hit.Ng_x[lane] * packet.ray.dir_x[lane] +
                          packet.hit.Ng_y[lane] * packet.ray.dir_y[lane] +
                          packet.hit.Ng_z[lane] * packet.ray.dir_z[lane];
    const bool mirrored = (geometry_.triangles[hit.triangle].flags & kMirrored) != 0;
    hit.back_face = (towards > 0.0f) != mirrored;
    return hit;
}

void EmbreeTracer::trace_block(std::span<const Ray> rays, std::span<Hit> hits) const {
    std::array<RTCRayHit8, kPacketsAtOnce> packets;
    std::array<PacketMask, kPacketsAtOnce> masks;
    std::array<Query, kPacketsAtOnce> queries;
    const std::size_t count = (rays.size() + kPacket - 1) / kPacket;
    std::uint64_t invalid = 0;
    for (std::size_t p = 0; p < count; ++p) {
        const std::size_t first = p * kPacket;
        const auto part = rays.subspan(first, std::min(kPacket, rays.size() - first));
        invalid += pack(part, packets[p].ray, masks[p], queries[p]);
        std::fill_n(packets[p].hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(packets[p].hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
    }
    const Stopwatch stopwatch;
    for (std::size_t p = 0; p < count; ++p)
        intersect(masks[p].valid.data(), scene_.get(), queries[p].context, packets[p]);
    counters_.add(rays.size(), invalid, stopwatch.nanoseconds());
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = unpack(packets[i / kPacket], i % kPacket);
}

void EmbreeTracer::trace_block(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    std::array<RTCRay8, kPacketsAtOnce> packets;
    std::array<PacketMask, kPacketsAtOnce> masks;
    std::array<Query, kPacketsAtOnce> queries;
    const std::size_t count = (rays.size() + kPacket - 1) / kPacket;
    std::uint64_t invalid = 0;
    for (std::size_t p = 0; p < count; ++p) {
        const std::size_t first = p * kPacket;
        const auto part = rays.subspan(first, std::min(kPacket, rays.size() - first));
        invalid += pack(part, packets[p], masks[p], queries[p]);
    }
    const Stopwatch stopwatch;
    for (std::size_t p = 0; p < count; ++p)
        occlude(masks[p].valid.data(), scene_.get(), queries[p].context, packets[p]);
    counters_.add(rays.size(), invalid, stopwatch.nanoseconds());
    // Embree marks an occluded ray by tfar = -infinity.
    for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = packets[i / kPacket].tfar[i % kPacket] < 0.0f ? 1 : 0;
}

void EmbreeTracer::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
    LUMEL_CHECK(rays.size() == hits.size(), rays.size(), hits.size());
    constexpr std::size_t kBlock = kPacket * kPacketsAtOnce;
    for (std::size_t first = 0; first < rays.size(); first += kBlock) {
        const std::size_t count = std::min(kBlock, rays.size() - first);
        trace_block(rays.subspan(first, count), hits.subspan(first, count));
    }
}

void EmbreeTracer::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    LUMEL_CHECK(rays.size() == blocked.size(), rays.size(), blocked.size());
    constexpr std::size_t kBlock = kPacket * kPacketsAtOnce;
    for (std::size_t first = 0; first < rays.size(); first += kBlock) {
        const std::size_t count = std::min(kBlock, rays.size() - first);
        trace_block(rays.subspan(first, count), blocked.subspan(first, count));
    }
}

}  // namespace

// Embree reports its own want of memory; our index lists come on top.
Result<std::unique_ptr<Tracer>> make_embree_tracer(const WorldGeometry& geometry, SurfaceReader surfaces,
                                                   Context& context) {
    const FlushDenormals flush;
    try {
        auto tracer = std::make_unique<EmbreeTracer>(geometry, surfaces);
        if (Status status = tracer->build(context); !status.ok()) return std::move(status).error();
        return std::unique_ptr<Tracer>(std::move(tracer));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "no memory for the ray tracer's triangles", {}, kMemoryRemedy};
    }
}

}  // namespace lumel
