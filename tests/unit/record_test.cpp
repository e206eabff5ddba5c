// What a recording says of a call that changed the world and is in no list, as one does that lacks TAUT_RECORD.
#include <gtest/gtest.h>

#include <cstring>

#include "api/host/recording.h"
#include "record/recorded.h"

using namespace taut_test;

TEST(Recording, NamesACallThatIsNotRecorded) {
    taut_world_def def;
    taut_world_def_init(&def);
    taut_world world{};
    ASSERT_EQ(taut_world_create(&def, &world), TAUT_OK);
    Recording recording;
    const taut_record_def how = recording.def();
    ASSERT_EQ(taut_world_record(world, &how), TAUT_OK);
    ASSERT_EQ(taut_world_step(world), TAUT_OK);
    taut::note_change("taut_world_of_tomorrow", static_cast<uint32_t>(world.bits));
    ASSERT_EQ(taut_world_step(world), TAUT_OK);
    ASSERT_EQ(taut_world_destroy(world), TAUT_OK);
    EXPECT_FALSE(taut::recording());
    Replay replay(recording.bytes);
    EXPECT_TRUE(replay.next());
    EXPECT_FALSE(replay.next());
    EXPECT_EQ(replay.result, TAUT_UNSUPPORTED);
    EXPECT_NE(std::strstr(taut_last_error(), "after call 1 came taut_world_of_tomorrow"), nullptr) << taut_last_error();
}
