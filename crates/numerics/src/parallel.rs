//! Data-parallel loops with the same bits for any number of threads.
//!
//! Results are computed in parallel and consumed in order by the calling thread. Which threads take part is decided by
//! the caller, not by this library, and nothing about it is global to the process:
//!
//! - inside [`Threads::install`] the pool of those [`Threads`], which is started by the first loop that is large enough
//!   for it;
//! - on a thread of a rayon pool (`rayon::ThreadPool::install`) that pool;
//! - anywhere else the calling thread alone. Rayon's own global pool is never started.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::cell::RefCell;
use std::sync::{Arc, OnceLock};

/// Number of elements below which a loop over elements stays on the calling thread (measured:
/// `cargo bench --bench iteration -- threads`).
pub const FEWEST_SHARED_ELEMENTS: usize = 2048;
/// Elements whose results are kept at the same time until they are consumed.
const ELEMENTS_PER_WAVE: usize = 1024;
/// Fewest elements of a wave that one thread takes at once.
const ELEMENTS_PER_TASK: usize = 64;
/// Consecutive pieces of long work that share one worker state.
const PIECES_PER_STATE: usize = 8;

thread_local! {
    /// The threads installed around what this thread is doing.
    static INSTALLED: RefCell<Option<Threads>> = const { RefCell::new(None) };
}

/// A number of threads, and the pool of them once a loop has needed it. Clones share the pool; it ends with the last of
/// them.
///
/// ```
/// use foldwell_numerics::parallel::{self, Threads};
/// let threads = Threads::new(Some(2));
/// let squares = threads.install(|| parallel::map_with_state(5, || (), |(), k| k * k));
/// assert_eq!(squares, [0, 1, 4, 9, 16]);
/// ```
#[derive(Clone, Debug)]
pub struct Threads(Arc<LazyPool>);

#[derive(Debug)]
struct LazyPool {
    /// Number of threads; 0: as many as there are processors.
    wanted: usize,
    pool: OnceLock<Option<ThreadPool>>,
}

impl Threads {
    /// A pool of `threads` threads, or of as many as there are processors; none is started yet. With one thread none
    /// ever is.
    pub fn new(threads: Option<usize>) -> Self {
        Self(Arc::new(LazyPool { wanted: threads.unwrap_or(0), pool: OnceLock::new() }))
    }

    /// Does some work, on the calling thread; the loops of this module in it are shared out to these threads.
    pub fn install<R>(&self, work: impl FnOnce() -> R) -> R {
        let _restored_at_the_end = Restore(INSTALLED.replace(Some(self.clone())));
        work()
    }

    /// Whether the pool has been started.
    pub fn started(&self) -> bool {
        self.0.pool.get().is_some_and(Option::is_some)
    }

    /// The pool, started if need be; `None` for a single thread, or where the system gives no threads.
    fn pool(&self) -> Option<&ThreadPool> {
        if self.0.wanted == 1 {
            return None;
        }
        let name = |number| format!("pool {number}");
        let build = || ThreadPoolBuilder::new().num_threads(self.0.wanted).thread_name(name).build().ok();
        self.0.pool.get_or_init(build).as_ref()
    }
}

/// Puts back what was installed before, also when the work panics.
struct Restore(Option<Threads>);

impl Drop for Restore {
    fn drop(&mut self) {
        INSTALLED.set(self.0.take());
    }
}

/// Where a loop runs.
enum Executor {
    CallingThread,
    /// The rayon pool to which the calling thread belongs.
    CurrentPool,
    Pool(Threads),
}

impl Executor {
    /// The place for a loop; `worthwhile`: whether it is large enough to be shared out.
    fn of_loop(worthwhile: bool) -> Self {
        if !worthwhile {
            return Self::CallingThread;
        }
        if let Some(threads) = INSTALLED.with_borrow(Option::clone) {
            return if threads.pool().is_some() { Self::Pool(threads) } else { Self::CallingThread };
        }
        // asking for the number of threads outside of a pool would start the global one
        let in_a_pool = rayon::current_thread_index().is_some();
        if in_a_pool && rayon::current_num_threads() > 1 { Self::CurrentPool } else { Self::CallingThread }
    }

    /// Does work in this place, and tells it whether that has several threads.
    fn run<R: Send>(&self, work: impl FnOnce(bool) -> R + Send) -> R {
        match self {
            Self::CallingThread => work(false),
            Self::CurrentPool => work(true),
            Self::Pool(threads) => match threads.pool() {
                Some(pool) => pool.install(|| work(true)),
                None => work(false),
            },
        }
    }
}

/// Does work that shares out its parts by itself (`rayon::join`). Whether it may is what it is told: where it is
/// `worthwhile` and there is more than one thread; then it is done on one of these.
pub(crate) fn in_pool<R: Send>(worthwhile: bool, work: impl FnOnce(bool) -> R + Send) -> R {
    Executor::of_loop(worthwhile).run(work)
}

/// Does the work in the `foreground` on the calling thread, and that in the `background` on another one at the same
/// time if there is one to share with and this is `worthwhile`; then it waits for both. Otherwise the background is
/// left out: it is for work whose result is computed anyway when it is asked for.
pub fn meanwhile<'a, R>(worthwhile: bool, background: impl FnOnce() + Send + 'a, foreground: impl FnOnce() -> R) -> R {
    let place = Executor::of_loop(worthwhile);
    let pool = if let Executor::Pool(threads) = &place { threads.pool() } else { None };
    if pool.is_none() && !matches!(place, Executor::CurrentPool) {
        return foreground();
    }
    let both = |scope: &rayon::Scope<'a>| {
        scope.spawn(|_| background());
        foreground()
    };
    match pool {
        Some(pool) => pool.in_place_scope(both),
        None => rayon::in_place_scope(both),
    }
}

/// Calls `compute(k, &mut result)` and then `consume(k, &result)` for `k` in `0..count`, the latter in this order and
/// on the calling thread. Loops of fewer than [`FEWEST_SHARED_ELEMENTS`] stay on the calling thread altogether.
///
/// A result is used again for a later `k`, so that what it owns is not allocated anew.
pub fn compute_and_consume<T: Default + Send>(
    count: usize,
    compute: impl Fn(usize, &mut T) + Sync + Send,
    mut consume: impl FnMut(usize, &T),
) {
    let place = Executor::of_loop(count >= FEWEST_SHARED_ELEMENTS);
    if let Executor::CallingThread = place {
        let mut result = T::default();
        for k in 0..count {
            compute(k, &mut result);
            consume(k, &result);
        }
        return;
    }
    let mut results: Vec<T> = (0..count.min(ELEMENTS_PER_WAVE)).map(|_| T::default()).collect();
    for start in (0..count).step_by(ELEMENTS_PER_WAVE) {
        let wave = &mut results[..ELEMENTS_PER_WAVE.min(count - start)];
        let elements = wave.par_iter_mut().with_min_len(ELEMENTS_PER_TASK).enumerate();
        place.run(|_| elements.for_each(|(k, result)| compute(start + k, result)));
        wave.iter().enumerate().for_each(|(k, result)| consume(start + k, result));
    }
}

/// The results of `compute(state, k)` for `k` in `0..count`, in this order; every worker has a state of its own from
/// `make_state`.
///
/// For pieces of work that take long: even two are shared out. The result must not depend on what the state was used
/// for before.
pub fn map_with_state<S, T: Send>(
    count: usize,
    make_state: impl Fn() -> S + Sync + Send,
    compute: impl Fn(&mut S, usize) -> T + Sync + Send,
) -> Vec<T> {
    in_pool(count > 1, |shared| {
        if shared {
            let pieces = (0..count).into_par_iter().with_min_len(PIECES_PER_STATE);
            return pieces.map_init(&make_state, &compute).collect();
        }
        let mut state = make_state();
        (0..count).map(|k| compute(&mut state, k)).collect()
    })
}
