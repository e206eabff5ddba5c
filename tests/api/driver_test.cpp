// Random hosts: any order of calls with any arguments leaves the worlds whole. A failure prints its seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "driver.h"
#include "host/recording.h"
#include "starts.h"

using namespace taut_test;

namespace {

class RandomHost : public testing::TestWithParam<uint64_t> {};

// The calls of a seed as recordings of its worlds, for taut-replay.
void leave_recordings(uint64_t seed, int calls, const std::string& folder) {
    const std::string prefix = folder + "/host_seed" + std::to_string(seed);
    RecordingFiles files(prefix);
    Driver driver(
        random_source(seed), [](const char*, const char*) {}, [&](taut_world world) { files.add(world); });
    for (int number = 0; number < calls; ++number) driver.call();
    std::printf("recordings of its worlds: %s_*.taut\n", prefix.c_str());
}

// With TAUT_RECORD_HOST=FOLDER what kills the process is recorded there; what else is found leaves its recordings
// anyway.
TEST_P(RandomHost, BreaksNothing) {
    if (few_starts() && GetParam() % 3 != 0) GTEST_SKIP() << "takes five seconds with sanitizers";
    if (const char* folder = std::getenv("TAUT_RECORD_HOST")) leave_recordings(GetParam(), 3000, folder);
    int number = 0;
    bool broken = false;
    Driver driver(random_source(GetParam()), [&](const char* call, const char* what) {
        broken = true;
        ADD_FAILURE() << "seed " << GetParam() << ", call " << number << ", " << call << ": " << what;
    });
    for (; number < 3000 && !broken; ++number) driver.call();
    if (broken) leave_recordings(GetParam(), number, testing::TempDir());
    // Both roads were travelled.
    EXPECT_GT(driver.accepted, 1000u);
    EXPECT_GT(driver.refused, 300u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomHost, testing::Range<uint64_t>(1, 41));
// Broke something once.
INSTANTIATE_TEST_SUITE_P(Known, RandomHost, testing::Values<uint64_t>(1011));

using Bytes = std::vector<uint8_t>;

// What the fuzzer kept, in the order of names: tests/api/fuzz/corpus.
const std::vector<Bytes>& corpus() {
    static const std::vector<Bytes> kept = [] {
        std::vector<std::filesystem::path> paths;
        for (const auto& entry : std::filesystem::directory_iterator(TAUT_FUZZ_CORPUS)) paths.push_back(entry.path());
        std::sort(paths.begin(), paths.end());
        std::vector<Bytes> out;
        for (const std::filesystem::path& path : paths) {
            std::ifstream file(path, std::ios::binary);
            out.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
        }
        return out;
    }();
    return kept;
}

// Some bytes changed, cut out, repeated or taken from another of the kept, a few times.
Bytes mutated(Bytes bytes, uint64_t seed) {
    ByteSource random = random_source(seed);
    const auto below = [&](size_t end) {
        uint32_t value = 0;
        random(&value, sizeof value);
        return end > 0 ? value % end : 0;
    };
    for (size_t edits = 1 + below(8); edits > 0; --edits) {
        const size_t at = below(bytes.size()), length = std::min(1 + below(64), bytes.size() - at);
        const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        const auto end = begin + static_cast<std::ptrdiff_t>(length);
        switch (below(4)) {
            case 0:
                random(&*begin, length);
                break;
            case 1:
                bytes.erase(begin, end);
                break;
            case 2: {
                const Bytes again(begin, end);
                bytes.insert(begin, again.begin(), again.end());
                break;
            }
            case 3: {
                const Bytes& other = corpus()[below(corpus().size())];
                std::copy_n(other.begin(), std::min(length, other.size()), begin);
                break;
            }
        }
    }
    return bytes;
}

// The kept input of this index, as it is or mutated by a seed above 0.
class FuzzedHost : public testing::TestWithParam<std::tuple<size_t, uint64_t>> {};

TEST_P(FuzzedHost, BreaksNothing) {
    const auto [index, seed] = GetParam();
    const Bytes bytes = seed > 0 ? mutated(corpus()[index], 1000 * index + seed) : corpus()[index];
    bool broken = false;
    Driver driver(source_of(bytes), [&](const char* call, const char* what) {
        broken = true;
        ADD_FAILURE() << call << ": " << what;
    });
    while (!broken && driver.call()) {
    }
    EXPECT_GT(driver.accepted, 0u);
}

INSTANTIATE_TEST_SUITE_P(Corpus, FuzzedHost,
                         testing::Combine(testing::Range<size_t>(0, corpus().size()), testing::Range<uint64_t>(0, 21)));

}  // namespace
