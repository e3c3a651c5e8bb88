// A persistent pool and parallel_for over a fixed partition. What a chunk computes may depend on its range only, so the
// bits do not depend on the number of threads; reduce per-chunk results in chunk order.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "lumel/context.h"

namespace lumel {

class ThreadPool {
public:
    explicit ThreadPool(unsigned threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    [[nodiscard]] unsigned size() const;

    // Runs task(worker) once on each worker 0..size()-1 and waits; worker 0 is the calling thread. All flush denormals
    // to zero while they are at it, whatever the mode of the caller. Not reentrant.
    void run(const std::function<void(unsigned worker)>& task);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

struct ChunkRange {
    std::size_t index;       // of the chunk: 0 .. ceil(count/grain)-1
    std::size_t begin, end;  // items
    unsigned worker;         // 0 .. threads-1, for scratch memory only
};

// Calls body for each chunk of `grain` consecutive items of [0, count). Chunks are claimed in order by free workers.
// Returns false if the context was cancelled before all chunks ran. `stage` reports progress where it is not empty;
// `rays` (optional) counts the rays traced so far, for the progress report.
bool parallel_for(Context& context, std::size_t count, std::size_t grain,
                  const std::function<void(const ChunkRange&)>& body, std::string_view stage = {},
                  const std::function<std::uint64_t()>& rays = {});

}  // namespace lumel
