// A host that means no good: calls the interface in any order with valid and invalid arguments, as a stream of bytes
// tells it, and checks after each call what must hold whatever the call was. The seeded test and the fuzzer share it.
#pragma once

#include "host/attachment_calls.h"
#include "host/body_calls.h"
#include "host/cable_calls.h"
#include "host/collider_calls.h"
#include "host/joint_add_calls.h"
#include "host/joint_calls.h"
#include "host/mover_calls.h"
#include "host/near_calls.h"
#include "host/query_calls.h"
#include "host/record_calls.h"
#include "host/shape_calls.h"
#include "host/sleep_calls.h"
#include "host/soft_calls.h"
#include "host/world_calls.h"

namespace taut_test {

class Driver : private CableCalls,
               private ShapeCalls,
               private BodyCalls,
               private ColliderCalls,
               private JointAddCalls,
               private JointCalls,
               private AttachmentCalls,
               private WorldCalls,
               private QueryCalls,
               private NearCalls,
               private MoverCalls,
               private SleepCalls,
               private SoftCalls,
               private RecordCalls {
public:
    // broken: told the call and what is wrong with it. created: told each world when nothing has happened to it yet.
    Driver(ByteSource source, std::function<void(const char* call, const char* what)> broken,
           std::function<void(taut_world)> created = nullptr) {
        source_ = std::move(source);
        broken_ = std::move(broken);
        created_ = std::move(created);
        for (size_t w = 0; w < 2; ++w) create(w);
    }
    ~Driver() {
        for (taut_world world : worlds_) taut_world_destroy(world);
        release_all();
    }

    // One call. False: the source ran dry.
    bool call() {
        using Action = void (Driver::*)();
        // What is listed more than once is called more often.
        static constexpr Action actions[] = {
            &Driver::add_shape,
            &Driver::add_shape,
            &Driver::add_shape,
            &Driver::add_scaled_shape,
            &Driver::remove_shape,
            &Driver::read_shape,
            &Driver::add_body,
            &Driver::add_body,
            &Driver::add_body,
            &Driver::add_body,
            &Driver::add_particle,
            &Driver::add_particle,
            &Driver::read_body,
            &Driver::read_states,
            &Driver::write_body,
            &Driver::write_body,
            &Driver::write_body,
            &Driver::change_body,
            &Driver::change_body,
            &Driver::look_at_body,
            &Driver::read_lists,
            &Driver::push_body,
            &Driver::push_body,
            &Driver::add_collider,
            &Driver::add_collider,
            &Driver::remove_collider,
            &Driver::read_collider,
            &Driver::write_collider,
            &Driver::write_collider,
            &Driver::add_joint,
            &Driver::add_joint,
            &Driver::remove_joint,
            &Driver::read_joint,
            &Driver::write_joint,
            &Driver::add_cable,
            &Driver::remove_cable,
            &Driver::read_cable,
            &Driver::reel_cable,
            &Driver::cast_ray,
            &Driver::cast_rays,
            &Driver::cast_shape,
            &Driver::overlap,
            &Driver::measure,
            &Driver::draw,
            &Driver::ask_one,
            &Driver::put_to_sleep,
            &Driver::set_continuous,
            &Driver::write_world,
            &Driver::read_world,
            &Driver::read_events,
            &Driver::read_lint,
            &Driver::step,
            &Driver::step,
            &Driver::step,
            &Driver::step,
            &Driver::step,
            &Driver::advance,
            &Driver::replace_world,
            &Driver::check_counts,
            &Driver::save_or_restore,
            &Driver::attach_any,
            &Driver::attach_any,
            &Driver::detach_any,
            &Driver::read_attached,
            &Driver::write_attached,
            &Driver::bake_any,
            &Driver::decompose_any,
            &Driver::add_baked_shape,
            &Driver::add_soft,
            &Driver::remove_soft,
            &Driver::read_cloth,
            &Driver::read_solid,
            &Driver::write_soft,
            &Driver::read_surfaces,
            &Driver::let_go,
            &Driver::move_character,
            &Driver::drive_vehicle,
            &Driver::use_ragdoll,
            &Driver::record_any,
            &Driver::replay_any,
            &Driver::put_in_fluid,
            &Driver::blow_up,
        };
        uint8_t which = 0;
        if (!source_(&which, 1)) return false;
        (this->*actions[which % (sizeof actions / sizeof *actions)])();
        return !dry_;
    }

    using Host::accepted;
    using Host::refused;
};

// A source that runs dry with its bytes, which outlive it.
inline ByteSource source_of(std::span<const uint8_t> bytes) {
    return [bytes, at = size_t{0}](void* out, size_t wanted) mutable {
        if (bytes.size() - at < wanted) return false;
        std::memcpy(out, bytes.data() + at, wanted);
        at += wanted;
        return true;
    };
}

// A source without end: splitmix64.
inline ByteSource random_source(uint64_t seed) {
    return [state = seed](void* out, size_t size) mutable {
        for (size_t i = 0; i < size; ++i) {
            state += 0x9e3779b97f4a7c15;
            uint64_t z = state;
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
            z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
            static_cast<uint8_t*>(out)[i] = static_cast<uint8_t>((z ^ (z >> 31)) >> 24);
        }
        return true;
    };
}

}  // namespace taut_test
