#include "base/parallel.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "base/check.h"
#include "base/denormals.h"

namespace lumel {

struct ThreadPool::Impl {
    std::vector<std::thread> threads;  // workers 1..n-1
    std::mutex mutex;
    std::condition_variable start, done;
    const std::function<void(unsigned)>* task = nullptr;
    std::uint64_t generation = 0;
    unsigned running = 0;
    bool quit = false;

    void work(unsigned worker) {
        const FlushDenormals flush;
        std::uint64_t seen = 0;
        std::unique_lock lock(mutex);
        for (;;) {
            start.wait(lock, [&] { return quit || generation != seen; });
            if (quit) return;
            seen = generation;
            const auto* current = task;
            lock.unlock();
            (*current)(worker);
            lock.lock();
            if (--running == 0) done.notify_one();
        }
    }
};

ThreadPool::ThreadPool(unsigned threads) : impl_(std::make_unique<Impl>()) {
    for (unsigned worker = 1; worker < std::max(1u, threads); ++worker)
        impl_->threads.emplace_back([this, worker] { impl_->work(worker); });
}

ThreadPool::~ThreadPool() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->quit = true;
    }
    impl_->start.notify_all();
    for (std::thread& thread : impl_->threads) thread.join();
}

unsigned ThreadPool::size() const { return static_cast<unsigned>(impl_->threads.size()) + 1; }

void ThreadPool::run(const std::function<void(unsigned)>& task) {
    {
        const std::lock_guard lock(impl_->mutex);
        LUMEL_CHECK(impl_->running == 0, impl_->running);
        impl_->task = &task;
        impl_->running = static_cast<unsigned>(impl_->threads.size());
        ++impl_->generation;
    }
    impl_->start.notify_all();
    {
        const FlushDenormals flush;
        task(0);
    }
    std::unique_lock lock(impl_->mutex);
    impl_->done.wait(lock, [&] { return impl_->running == 0; });
}

bool parallel_for(Context& context, std::size_t count, std::size_t grain,
                  const std::function<void(const ChunkRange&)>& body, std::string_view stage,
                  const std::function<std::uint64_t()>& rays) {
    LUMEL_CHECK(grain > 0, grain);
    const std::size_t chunks = (count + grain - 1) / grain;
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> finished{0};
    const auto report = [&] {
        const double done = static_cast<double>(finished.load(std::memory_order_relaxed));
        context.report(stage, chunks == 0 ? 1.0 : done / static_cast<double>(chunks), rays ? rays() : 0);
    };
    context.pool().run([&](unsigned worker) {
        auto last_report = std::chrono::steady_clock::now();
        for (;;) {
            if (context.cancelled()) return;
            const std::size_t chunk = next.fetch_add(1, std::memory_order_relaxed);
            if (chunk >= chunks) return;
            body({chunk, chunk * grain, std::min(count, (chunk + 1) * grain), worker});
            finished.fetch_add(1, std::memory_order_relaxed);
            if (worker != 0 || stage.empty()) continue;
            const auto now = std::chrono::steady_clock::now();
            if (now - last_report > std::chrono::milliseconds(100)) {
                last_report = now;
                report();
            }
        }
    });
    if (!stage.empty()) report();
    return finished.load() == chunks;
}

}  // namespace lumel
