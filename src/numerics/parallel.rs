//! Work on many elements by several threads, with the same bits for any number of threads.
//!
//! Results are computed in parallel and consumed in order by the caller's thread. The pool is started by the first
//! work that is large enough for it; small problems never start one.

use rayon::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Fewer elements than this are worked on by the calling thread (measured: `cargo bench --bench iteration -- threads`).
pub const LEAST: usize = 1024;
const WAVE: usize = 4096;

static THREADS: AtomicUsize = AtomicUsize::new(0);
static POOL: OnceLock<Option<rayon::ThreadPool>> = OnceLock::new();

/// Sets the number of threads; 0: as many as there are processors. Has an effect until the pool has started.
pub fn set_threads(threads: usize) {
    THREADS.store(threads, Ordering::Relaxed);
}

/// Whether a pool of threads has been started.
pub fn started() -> bool {
    POOL.get().is_some_and(Option::is_some)
}

/// Calls `consume(k, compute(k))` for `k` in `0..count`, in this order.
pub fn ordered<T: Send>(count: usize, compute: impl Fn(usize) -> T + Sync + Send, mut consume: impl FnMut(usize, T)) {
    let Some(pool) = (count >= LEAST).then(pool).flatten() else {
        (0..count).for_each(|k| consume(k, compute(k)));
        return;
    };
    for start in (0..count).step_by(WAVE) {
        let end = count.min(start + WAVE);
        let results: Vec<T> = pool.install(|| (start..end).into_par_iter().with_min_len(64).map(&compute).collect());
        results.into_iter().enumerate().for_each(|(k, result)| consume(start + k, result));
    }
}

/// The pool; `None` where one thread is wanted or a pool cannot be had.
fn pool() -> Option<&'static rayon::ThreadPool> {
    let threads = THREADS.load(Ordering::Relaxed);
    if threads == 1 {
        return None;
    }
    POOL.get_or_init(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()).as_ref()
}
