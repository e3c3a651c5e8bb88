// Ctrl-C and SIGTERM. The run is asked to stop; most stages look at that some ten times a second. A few do not (a large
// picture being compressed, a texture being decoded) or not always (the tree of rays of very many triangles): where the
// run has not stopped after a grace period, what it has written so far is removed and the process ends itself, within a
// second in all.
#pragma once

#include <semaphore.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "lumel/context.h"

namespace lumel::cli {

// One at a time; lives as long as the run.
class Interrupt {
public:
    explicit Interrupt(Context& context);
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    // Removes what the run has written so far; called, on another thread, right before the process ends itself.
    void set_cleaner(std::function<void()> remove_partial_output);
    // From here on the output is moved into place and the run is not stopped any more. False if it was asked to stop
    // already.
    bool begin_commit();

private:
    void watch();

    Context& context_;
    std::mutex mutex_;
    std::condition_variable ended_changed_;
    std::function<void()> clean_;
    bool ended_ = false, committing_ = false;
    std::thread watcher_;
};

}  // namespace lumel::cli
