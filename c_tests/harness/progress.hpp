// A progress bar that takes itself off the screen.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "progress/progress.h"

namespace harness {

/// Drawn on standard error while that is a terminal, silent otherwise.
class Progress {
public:
    Progress(std::uint64_t total, const std::string& label) : bar_(progress_new(total, label.c_str())) {}

    void set_label(const std::string& label) { progress_set_label(bar_.get(), label.c_str()); }

    /// From any thread.
    void advance(std::uint64_t steps = 1) { progress_advance(bar_.get(), steps); }

private:
    struct Finish {
        void operator()(ProgressBar* bar) const { progress_finish(bar); }
    };
    std::unique_ptr<ProgressBar, Finish> bar_;
};

}  // namespace harness
