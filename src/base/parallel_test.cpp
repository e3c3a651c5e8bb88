// The pool and parallel_for: every item once, the same chunks for any number of threads, cancellation, progress.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

namespace lumel {
namespace {

TEST(ThreadPool, RunsEachWorkerOnce) {
    for (const unsigned threads : {1u, 2u, 8u}) {
        ThreadPool pool(threads);
        ASSERT_EQ(pool.size(), threads);
        // Often enough for a worker that sleeps through a start to be missed.
        for (int round = 0; round < 200; ++round) {
            std::vector<int> calls(threads, 0);
            pool.run([&](unsigned worker) { ++calls[worker]; });
            EXPECT_EQ(calls, std::vector<int>(threads, 1));
        }
    }
}

TEST(ThreadPool, CallerIsWorkerZero) {
    ThreadPool pool(2);
    std::vector<std::thread::id> ids(2);
    pool.run([&](unsigned worker) { ids[worker] = std::this_thread::get_id(); });
    EXPECT_EQ(ids[0], std::this_thread::get_id());
    EXPECT_NE(ids[1], std::this_thread::get_id());
}

// A product that is subnormal, seen by the compiler at run time only.
float subnormal() {
    volatile float tiny = 1e-30f;
    return tiny * 1e-10f;
}

// Whatever thread made the pool and whatever thread calls it, all workers compute alike; the caller keeps its own mode.
TEST(ThreadPool, FlushesDenormalsInItsTasksAlone) {
#if !defined(__SSE2__)
    GTEST_SKIP() << "denormals are flushed on x86 only";
#endif
    ASSERT_GT(subnormal(), 0.0f);
    ThreadPool pool(2);
    EXPECT_GT(subnormal(), 0.0f) << "the pool changed the mode of the thread that made it";
    std::array<float, 2> seen{1, 1};
    std::thread([&] { pool.run([&](unsigned worker) { seen[worker] = subnormal(); }); }).join();
    EXPECT_EQ(seen, (std::array<float, 2>{0, 0}));
    seen = {1, 1};
    pool.run([&](unsigned worker) { seen[worker] = subnormal(); });
    EXPECT_EQ(seen, (std::array<float, 2>{0, 0}));
    EXPECT_GT(subnormal(), 0.0f) << "the pool changed the mode of its caller";
}

TEST(ThreadParallelFor, VisitsEveryItemOnce) {
    for (const unsigned threads : {1u, 2u, 8u}) {
        Context context(threads);
        for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 1000u}) {
            std::vector<int> visits(count, 0);
            EXPECT_TRUE(parallel_for(context, count, 8, [&](const ChunkRange& chunk) {
                for (std::size_t i = chunk.begin; i < chunk.end; ++i) ++visits[i];
            }));
            EXPECT_EQ(visits, std::vector<int>(count, 1));
        }
    }
}

// A sum in float depends on its order: it is the same because the chunks and the order of the reduction are.
TEST(ThreadParallelFor, PartialSumsHaveTheSameBitsForAnyNumberOfThreads) {
    std::vector<float> items(10000);
    for (std::size_t i = 0; i < items.size(); ++i) items[i] = 1.0f / static_cast<float>(i + 1);
    const auto sum = [&](unsigned threads) {
        Context context(threads);
        constexpr std::size_t kGrain = 37;
        std::vector<float> partial((items.size() + kGrain - 1) / kGrain);
        parallel_for(context, items.size(), kGrain, [&](const ChunkRange& chunk) {
            float total = 0.0f;
            for (std::size_t i = chunk.begin; i < chunk.end; ++i) total += items[i];
            partial[chunk.index] = total;
        });
        return std::accumulate(partial.begin(), partial.end(), 0.0f);
    };
    const float one = sum(1);
    EXPECT_NEAR(one, 9.7876f, 1e-3f);  // H(10000); float rounding over 10,000 terms stays below 1e-4
    EXPECT_EQ(one, sum(2));
    EXPECT_EQ(one, sum(8));
}

TEST(ThreadParallelFor, CancelStopsBetweenChunks) {
    for (const unsigned threads : {1u, 4u}) {
        Context context(threads);
        std::atomic<std::size_t> chunks{0};
        const bool all = parallel_for(context, 1000, 1, [&](const ChunkRange&) {
            if (++chunks == 10) context.request_cancel();
        });
        EXPECT_FALSE(all);
        EXPECT_GE(chunks.load(), 10u);
        EXPECT_LT(chunks.load(), 10u + threads);  // each other worker ends the chunk it is in
    }
}

TEST(ThreadParallelFor, ReportsFromTheCallingThreadAndEndsAtOne) {
    Context context(2);
    std::vector<double> fractions;
    std::set<std::thread::id> reporters;
    std::uint64_t rays_reported = 0;
    context.on_progress = [&](const Progress& progress) {
        EXPECT_EQ(progress.stage, "trace");
        fractions.push_back(progress.fraction);
        reporters.insert(std::this_thread::get_id());
        rays_reported = progress.rays;
    };
    std::atomic<std::uint64_t> rays{0};
    parallel_for(
        context, 100, 1,
        [&](const ChunkRange&) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));  // 250 ms in all: two or so reports on the way
            ++rays;
        },
        "trace", [&] { return rays.load(); });
    ASSERT_GE(fractions.size(), 2u);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.back(), 1.0);
    EXPECT_EQ(rays_reported, 100u);
    EXPECT_EQ(reporters, std::set<std::thread::id>{std::this_thread::get_id()});
}

}  // namespace
}  // namespace lumel
