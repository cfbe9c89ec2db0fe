//! Work on many elements by several threads, with the same bits for any number of threads.
//!
//! Results are computed in parallel and consumed in order by the caller's thread. The pool is started by the first
//! work that is large enough for it; small problems never start one.

use rayon::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Fewer elements than this are worked on by the calling thread (measured: `cargo bench --bench iteration -- threads`).
pub const LEAST: usize = 2048;
const WAVE: usize = 1024;
/// So many pieces of long work one after the other share a state.
const TOGETHER: usize = 8;

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

/// Calls `compute(k, &mut result)` and then `consume(k, &result)` for `k` in `0..count`, the latter in this order.
///
/// A result is a place that is used again for a later `k`: what it owns is not allocated anew.
pub fn ordered<T: Default + Send>(
    count: usize,
    compute: impl Fn(usize, &mut T) + Sync + Send,
    mut consume: impl FnMut(usize, &T),
) {
    let Some(pool) = (count >= LEAST).then(pool).flatten() else {
        let mut result = T::default();
        for k in 0..count {
            compute(k, &mut result);
            consume(k, &result);
        }
        return;
    };
    let mut results: Vec<T> = (0..count.min(WAVE)).map(|_| T::default()).collect();
    for start in (0..count).step_by(WAVE) {
        let wave = &mut results[..WAVE.min(count - start)];
        let work = wave.par_iter_mut().with_min_len(64).enumerate();
        pool.install(|| work.for_each(|(k, result)| compute(start + k, result)));
        wave.iter().enumerate().for_each(|(k, result)| consume(start + k, result));
    }
}

/// `compute(state, k)` for `k` in `0..count`, in this order; every worker has a state of its own, made when it begins.
///
/// For work that takes long: also few are shared out. The result must not depend on what the state was used for before.
pub fn each<S, T: Send>(
    count: usize,
    make: impl Fn() -> S + Sync + Send,
    compute: impl Fn(&mut S, usize) -> T + Sync + Send,
) -> Vec<T> {
    match (count > 1).then(pool).flatten() {
        None => {
            let mut state = make();
            (0..count).map(|k| compute(&mut state, k)).collect()
        }
        Some(pool) => {
            pool.install(|| (0..count).into_par_iter().with_min_len(TOGETHER).map_init(make, compute).collect())
        }
    }
}

/// The pool; `None` where one thread is wanted or a pool cannot be had.
fn pool() -> Option<&'static rayon::ThreadPool> {
    let threads = THREADS.load(Ordering::Relaxed);
    if threads == 1 {
        return None;
    }
    let name = |number| format!("pool {number}");
    POOL.get_or_init(|| rayon::ThreadPoolBuilder::new().num_threads(threads).thread_name(name).build().ok()).as_ref()
}
