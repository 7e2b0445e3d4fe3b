//! A build that tells how far it is.
//!
//! The build runs on a thread of its own, so that the callback runs on the caller's, and may unwind (a C++ exception
//! too) without ever meeting a frame of the build.

use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::builder::Geometry;
use super::{BuildError, BuildOptions, Scene, build};
use crate::accel::Watch;

/// Cancels and waits for the build when it is dropped early, because the callback said so or unwinds.
struct Job {
    watch: Arc<Watch>,
    thread: Option<JoinHandle<()>>,
}

impl Drop for Job {
    fn drop(&mut self) {
        self.watch.cancel();
        if let Some(thread) = self.thread.take() {
            // Its panic has been told already, by the channel that closed.
            let _ = thread.join();
        }
    }
}

pub(super) fn build_watched(
    geometries: Vec<Arc<Geometry>>,
    options: BuildOptions,
    on_progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Scene, BuildError> {
    /// Often enough for a progress bar, rare enough not to slow the build.
    const INTERVAL: Duration = Duration::from_millis(10);

    if !on_progress(0.0) {
        return Err(BuildError::Cancelled);
    }
    let watch = Arc::new(Watch::default());
    let (sender, receiver) = mpsc::channel();
    let build_watch = Arc::clone(&watch);
    let thread = thread::Builder::new()
        .name("gnomon-build".to_owned())
        .spawn(move || {
            let result = build::build(&geometries, &options, &build_watch);
            // Nobody listens any more once the callback has unwound.
            let _ = sender.send(result);
        })
        .map_err(|error| BuildError::Threads(error.to_string()))?;
    let job = Job { watch, thread: Some(thread) };

    let result = loop {
        match receiver.recv_timeout(INTERVAL) {
            Ok(result) => break result,
            Err(RecvTimeoutError::Timeout) => {
                if !on_progress(job.watch.done()) {
                    // Dropping the job cancels the build and waits for its end.
                    return Err(BuildError::Cancelled);
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(BuildError::Internal("its thread panicked".to_owned()));
            }
        }
    };
    match result {
        Ok(scene) if on_progress(1.0) => Ok(scene),
        Ok(_) => Err(BuildError::Cancelled),
        Err(error) => Err(error),
    }
}
