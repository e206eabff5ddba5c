// Slots of the table of worlds: a generation is given out once, whatever becomes of its world.
#include "state/world_slot.h"

#include <gtest/gtest.h>

#include "state/handle.h"

namespace taut::test {
namespace {

TEST(WorldSlot, GivesEachGenerationOnceAndThenRetires) {
    WorldSlot slot;
    for (uint32_t generation = 1; generation <= kMaxWorldGeneration; ++generation) {
        ASSERT_TRUE(slot.take());
        ASSERT_FALSE(slot.take());
        ASSERT_EQ(slot.generation(), generation);
        const uint32_t id = make_world_id(1, generation);
        ASSERT_FALSE(slot.lives(id));
        slot.begin_life();
        ASSERT_TRUE(slot.lives(id));
        ASSERT_FALSE(slot.lives(make_world_id(1, generation - 1)));
        ASSERT_EQ(slot.lock(id, true), WorldSlot::Lock::held);
        ASSERT_EQ(slot.lock(id, false), WorldSlot::Lock::busy);
        slot.end_life();
        ASSERT_FALSE(slot.lives(id));
        slot.release();
    }
    EXPECT_FALSE(slot.take());
    for (uint32_t generation = 1; generation <= kMaxWorldGeneration; ++generation)
        ASSERT_FALSE(slot.lives(make_world_id(1, generation)));
}

TEST(WorldSlot, TakesBackTheGenerationOfAWorldThatWasNotMade) {
    WorldSlot slot;
    for (int i = 0; i < 20000; ++i) {
        ASSERT_TRUE(slot.take());
        ASSERT_EQ(slot.generation(), 1u);
        slot.give_back();
    }
}

TEST(WorldSlot, IdsFitInHandles) {
    const uint32_t id = make_world_id(kWorldSlots - 1, kMaxWorldGeneration);
    EXPECT_EQ(world_slot_of(id), kWorldSlots - 1);
    HandleBits bits{};
    ASSERT_TRUE(unpack_handle(pack_handle({kMaxSlots, 0xffff, id}), bits));
    EXPECT_EQ(bits.index, kMaxSlots);
    EXPECT_EQ(bits.generation, 0xffffu);
    EXPECT_EQ(bits.world, id);
}

TEST(WorldSlot, HasManyReadersOrOneWriter) {
    WorldSlot slot;
    ASSERT_TRUE(slot.take());
    slot.begin_life();
    const uint32_t id = make_world_id(1, 1);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(slot.lock(id, false), WorldSlot::Lock::held);
    EXPECT_EQ(slot.lock(id, true), WorldSlot::Lock::busy);
    for (int i = 0; i < 100; ++i) slot.unlock(false);
    EXPECT_EQ(slot.lock(id, true), WorldSlot::Lock::held);
    slot.unlock(true);
    EXPECT_EQ(slot.lock(make_world_id(1, 2), true), WorldSlot::Lock::stale);
}

}  // namespace
}  // namespace taut::test
