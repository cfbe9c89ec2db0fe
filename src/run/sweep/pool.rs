//! The threads of a sweep: each takes the next point when it is done with its last one.

use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use crate::run::RunError;

/// Stack size of a thread in bytes: the usual one of the first thread of a program.
const STACK: usize = 8 << 20;

/// A number of threads, and the number of those that each point has.
pub(super) struct Pool {
    workers: usize,
    /// The number of threads that a point has for itself: more than one where there are few points.
    pub(super) threads_of_point: usize,
}

impl Pool {
    /// A pool of `threads` threads, or of as many as there are processors, for this number of points.
    pub(super) fn new(threads: Option<usize>, points: usize) -> Self {
        let threads = threads.unwrap_or_else(|| thread::available_parallelism().map_or(1, NonZero::get));
        let workers = threads.min(points).max(1);
        Self { workers, threads_of_point: (threads / workers).max(1) }
    }

    /// Does some work for each point; ends early if it breaks or fails. One worker works on the calling thread.
    pub(super) fn over(
        &self,
        points: &[usize],
        work: impl Fn(usize) -> Result<ControlFlow<()>, RunError> + Sync,
    ) -> Result<ControlFlow<()>, RunError> {
        let (next, ended) = (AtomicUsize::new(0), Mutex::new(Ok(ControlFlow::Continue(()))));
        let worker = || {
            while let Some(&point) = points.get(next.fetch_add(1, Ordering::Relaxed)) {
                let found = work(point);
                if !matches!(found, Ok(ControlFlow::Continue(()))) {
                    next.store(points.len(), Ordering::Relaxed);
                    let mut ended = ended.lock().unwrap_or_else(PoisonError::into_inner);
                    if ended.is_ok() {
                        *ended = found;
                    }
                }
            }
        };
        if self.workers > 1 {
            thread::scope(|scope| {
                let named = |k: usize| thread::Builder::new().name(format!("points {k}")).stack_size(STACK);
                // where the system gives no threads, the work below is done by this one
                (0..self.workers).for_each(|k| _ = named(k).spawn_scoped(scope, worker));
            });
        }
        worker();
        ended.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}
