// What every stage is given besides its input: threads, progress, cancellation and the place for warnings.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lumel {

// Questionable data: counted, located, reported; never silently repaired.
struct Diagnostic {
    std::string code;                   // stable, kebab-case: "uv-overlap"
    std::string message;                // one sentence, says what Lumel did about it
    std::uint64_t count = 0;            // how many items
    std::vector<std::string> examples;  // at most kMaxExamples locations
};

class Diagnostics {
public:
    static constexpr std::size_t kMaxExamples = 8;

    // Merges with an earlier diagnostic of the same code. Not thread-safe: call from the coordinating thread.
    void add(std::string_view code, std::string_view message, std::string_view where, std::uint64_t count = 1);

    [[nodiscard]] const std::vector<Diagnostic>& all() const { return items_; }
    [[nodiscard]] std::uint64_t count(std::string_view code) const;

private:
    std::vector<Diagnostic> items_;
};

struct Progress {
    std::string_view stage;  // "load", "unwrap", "trace", ...
    double fraction = 0.0;   // 0..1 of this stage
    std::uint64_t rays = 0;  // since the start of the stage, 0 where none are traced
};

class ThreadPool;  // base/parallel.h

// One per run. Stages take it by reference; it outlives them.
class Context {
public:
    // threads: 0 means one per hardware thread.
    explicit Context(unsigned threads = 0);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    [[nodiscard]] unsigned threads() const;
    [[nodiscard]] ThreadPool& pool() { return *pool_; }

    // Called on the coordinating thread, at most some ten times a second.
    std::function<void(const Progress&)> on_progress;
    void report(std::string_view stage, double fraction, std::uint64_t rays = 0) const;

    // Stages look at this at least every 100 ms of work. Safe from a signal handler.
    void request_cancel() { cancel_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool cancelled() const { return cancel_.load(std::memory_order_relaxed); }

    Diagnostics diagnostics;

private:
    std::unique_ptr<ThreadPool> pool_;
    std::atomic<bool> cancel_{false};
};

}  // namespace lumel
