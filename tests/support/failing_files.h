// A process that dies, or whose disk fails, after so many renames and removals of files.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <functional>
#include <limits>

namespace lumel::test {

inline constexpr int kNever = std::numeric_limits<int>::max();
inline constexpr int kDied = 77;
inline int steps_left = kNever;
inline bool fails_then = false;  // every step from there on, instead of dying

// False: the step fails.
inline bool may_step() {
    if (steps_left == kNever || steps_left-- > 0) return true;
    if (!fails_then) ::_exit(kDied);
    steps_left = 0;
    errno = EIO;
    return false;
}

// Does something in a process of its own that is stopped after so many steps. True: it came to its end before that.
inline bool in_a_process(int steps, bool fails, const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        steps_left = steps;
        fails_then = fails;
        work();
        ::_exit(steps_left == 0 && fails ? kDied : 0);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == kDied)) << status;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace lumel::test

// The standard library renames and removes by these, which stand before those of the C library here.
extern "C" {
[[gnu::visibility("default"), gnu::used]] inline int rename(const char* from, const char* to) noexcept {
    return lumel::test::may_step() ? ::renameat(AT_FDCWD, from, AT_FDCWD, to) : -1;
}
[[gnu::visibility("default"), gnu::used]] inline int remove(const char* path) noexcept {
    if (!lumel::test::may_step()) return -1;
    if (::unlink(path) == 0) return 0;
    return errno == EISDIR || errno == EPERM ? ::rmdir(path) : -1;
}
}
