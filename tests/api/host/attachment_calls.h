// Calls of attachment.h.
#pragma once

#include "host.h"

namespace taut_test {

class AttachmentCalls : protected virtual Host {
protected:
    void attach_any() {
        if (live(attachments_, taut_attachment_is_valid) >= kMostAttachments) return;
        const size_t w = pick_world();
        taut_attachment_def def;
        taut_attachment_def_init(&def);
        spoil(def.struct_size);
        def.kind = static_cast<taut_attachment_kind>(byte() % (one_in(16) ? 4 : 3));
        def.a = anchor(w);
        def.b = anchor(w);
        if (one_in(2)) def.length = real(0, 3);
        if (one_in(2)) def.compliance = real(0, one_in(8) ? 1e6 : 0.01), def.damping = real(0, 100);
        if (one_in(3)) def.break_force = real(0, 1000);
        if (one_in(8)) def.break_torque = real(0, 1000);
        def.collide_connected = byte() & 1;
        spoil(def.collide_connected);
        def.solve = static_cast<taut_joint_solve>(byte() % (one_in(16) ? 4 : 3));
        if (one_in(3)) def.pulls = 1;
        spoil(def.pulls);
        if (one_in(3)) def.limit = real(0, 5), def.limit_compliance = one_in(2) ? real(0, 0.01) : 0;
        taut_attachment out = {0};
        if (run("taut_world_add_attachment", [&] { return taut_world_add_attachment(worlds_[w], &def, &out); }))
            keep(attachments_, out, w);
    }

    void detach_any() {
        if (!one_in(2)) return;
        const taut_attachment attachment = pick(attachments_, pick_world());
        if (run("taut_attachment_remove", [&] { return taut_attachment_remove(attachment); }))
            expect(!taut_attachment_is_valid(attachment), "a removed attachment that lives");
    }

    void read_attached() {
        const size_t w = pick_world();
        const taut_attachment attachment = pick(attachments_, w);
        taut_pos a, b;
        if (ask("taut_attachment_get_points", [&] { return taut_attachment_get_points(attachment, &a, &b); }))
            expect(finite(a) && finite(b), "a point that is not finite");
        float error;
        if (ask("taut_attachment_get_error", [&] { return taut_attachment_get_error(attachment, &error); }))
            expect(error >= 0, "an error that is none");
        taut_vec3 force, torque;
        if (ask("taut_attachment_get_force", [&] { return taut_attachment_get_force(attachment, &force); }))
            expect(!std::isnan(force.x + force.y + force.z), "a force that is none");
        ask("taut_attachment_get_torque", [&] { return taut_attachment_get_torque(attachment, &torque); });
        uint64_t data = word();
        run("taut_attachment_set_user_data", [&] { return taut_attachment_set_user_data(attachment, data); });
        ask("taut_attachment_get_user_data", [&] { return taut_attachment_get_user_data(attachment, &data); });
        taut_attachment_def def;
        if (ask("taut_attachment_get_def", [&] { return taut_attachment_get_def(attachment, &def); })) {
            for (const taut_anchor* end : {&def.a, &def.b})
                for (uint32_t n = 0; n < end->count; ++n)
                    expect(taut_body_is_valid(end->bodies[n]), "an attachment on a dead body");
            const size_t of = world_of(attachments_, attachment, w);
            taut_pos at;
            expect(ask("taut_world_get_anchor_point",
                       [&] { return taut_world_get_anchor_point(worlds_[of], &def.a, &at); }),
                   "an anchor that is read but not taken");
        }
        std::vector<taut_attachment_state> states(byte());
        uint32_t count = 0;
        if (ask("taut_world_get_attachments", [&] {
                return taut_world_get_attachments(worlds_[w], states.data(), static_cast<uint32_t>(states.size()),
                                                  &count);
            }))
            expect(count == live(attachments_, taut_attachment_is_valid, w), "attachments that are not counted");
    }

    void write_attached() {
        const taut_attachment attachment = pick(attachments_, pick_world());
        const float a = real(0, one_in(8) ? 1e6 : 0.01), b = real(0, 100), length = real(1e-4, 5);
        run("taut_attachment_set_compliance", [&] { return taut_attachment_set_compliance(attachment, a, b); });
        run("taut_attachment_set_length", [&] { return taut_attachment_set_length(attachment, length); });
        run("taut_attachment_set_break",
            [&] { return taut_attachment_set_break(attachment, 1e4f * a, one_in(4) ? b : 0); });
    }

private:
    static constexpr size_t kMostAttachments = 12;

    taut_anchor anchor(size_t w) {
        taut_anchor out;
        taut_anchor_init(&out);
        if (one_in(4)) {
            out.points[0] = pos(10);
            return out;
        }
        out.count = one_in(32) ? 5 : 1 + byte() % 4;
        float sum = 0;
        for (uint32_t n = 0; n < 4; ++n) {
            out.bodies[n] = pick_body(w);
            if (one_in(2)) out.points[n] = pos(1);
            out.weights[n] = n + 1 < out.count ? real(-1, 1) : 1 - sum;
            sum += out.weights[n];
        }
        if (one_in(64)) out.reserved = word();
        return out;
    }
};

}  // namespace taut_test
