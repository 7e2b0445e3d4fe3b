/* A progress bar on standard error; silent unless that is a terminal. */
#ifndef GNOMON_PROGRESS_H
#define GNOMON_PROGRESS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ProgressBar ProgressBar;

/* A bar over `total` steps; give it back to progress_finish(). The label is UTF-8 and copied. */
ProgressBar* progress_new(uint64_t total, const char* label);

/* Says what is being done now. */
void progress_set_label(const ProgressBar* bar, const char* label);

/* Counts `steps` more as done; from any thread. */
void progress_advance(const ProgressBar* bar, uint64_t steps);

/* Takes the bar off the screen and frees it. */
void progress_finish(ProgressBar* bar);

#ifdef __cplusplus
}
#endif

#endif
