#pragma once

namespace tbb {

struct task_arena {
    static constexpr int automatic = -1;
    explicit task_arena(int = automatic) {}
    template <class Work>
    void execute(const Work& work) {
        work();
    }
};

}  // namespace tbb
