#include "interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <utility>

#include "command.h"

namespace lumel::cli {
namespace {

constexpr std::chrono::milliseconds kGrace{500};

// The only state that a signal handler can reach.
std::atomic<Context*> g_context{nullptr};
sem_t g_wake;

extern "C" void on_signal(int) {
    const int saved = errno;
    if (Context* context = g_context.load()) {
        context->request_cancel();
        sem_post(&g_wake);
    }
    errno = saved;
}

}  // namespace

Interrupt::Interrupt(Context& context) : context_(context) {
    sem_init(&g_wake, 0, 0);
    g_context = &context_;
    watcher_ = std::thread([this] { watch(); });
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

Interrupt::~Interrupt() {
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    g_context = nullptr;
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    ended_changed_.notify_all();
    sem_post(&g_wake);
    watcher_.join();
    // The semaphore stays: a handler that began before the lines above may still post it.
}

void Interrupt::set_cleaner(std::function<void()> remove_partial_output) {
    const std::lock_guard lock(mutex_);
    clean_ = std::move(remove_partial_output);
}

bool Interrupt::begin_commit() {
    const std::lock_guard lock(mutex_);
    committing_ = !context_.cancelled();
    return committing_;
}

void Interrupt::watch() {
    while (sem_wait(&g_wake) != 0) {
    }
    std::unique_lock lock(mutex_);
    ended_changed_.wait_for(lock, kGrace, [this] { return ended_; });
    if (ended_ || committing_) return;
    if (clean_) clean_();
    std::fprintf(stderr, "\n%s\n", kCancelledText);
    ::_exit(kFailed);
}

}  // namespace lumel::cli
