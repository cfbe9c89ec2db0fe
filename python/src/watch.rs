//! Long work beside Python: other threads go on, Ctrl-C and the end of the interpreter stop it, and a callback hears of its
//! progress.

use crate::errors::bug;
use foldwell::run::{Observer, Progress};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two looks at signals.
const PATIENCE: Duration = Duration::from_millis(50);
/// Longest time that the end of the interpreter waits for work to stop.
const FAREWELL: Duration = Duration::from_secs(20);

/// Whether the interpreter is about to end.
static ENDING: AtomicBool = AtomicBool::new(false);
/// Number of pieces of work that are going on.
static AT_WORK: AtomicUsize = AtomicUsize::new(0);

/// Does some work on a thread of its own while the calling thread, which lets other Python threads run, calls
/// `progress(study, step, of, residual)` after every step. The work is stopped if the callback returns `False` or raises
/// an exception, or at Ctrl-C; exceptions are raised here.
pub(crate) fn watched<R: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Observer<'_>) -> R + Send,
) -> PyResult<R> {
    let callback = progress.map(|callback| callback.clone().unbind());
    let listens = callback.is_some();
    let stop = AtomicBool::new(false);
    let (sender, receiver) = mpsc::channel::<Progress>();
    AT_WORK.fetch_add(1, Ordering::SeqCst);
    let stop = &stop;
    let (done, heard) = py.detach(move || {
        thread::scope(|scope| {
            let worker = scope.spawn(move || {
                let observer = |progress: &Progress| {
                    if listens {
                        let _ = sender.send(progress.clone()); // the receiver lives longer
                    }
                    let stopped = stop.load(Ordering::Relaxed) || ENDING.load(Ordering::Relaxed);
                    if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                };
                let done = work(&observer);
                drop(sender);
                done
            });
            let mut heard = Ok(());
            loop {
                let said = match receiver.recv_timeout(PATIENCE) {
                    Ok(progress) => Python::attach(|py| tell(py, callback.as_ref(), &progress)),
                    Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals().map(|()| true)),
                    Err(RecvTimeoutError::Disconnected) => break,
                };
                if heard.is_ok() && !matches!(said, Ok(true)) {
                    stop.store(true, Ordering::Relaxed);
                    heard = said.map(|_| ());
                }
            }
            (worker.join(), heard)
        })
    });
    AT_WORK.fetch_sub(1, Ordering::SeqCst);
    heard?;
    done.map_err(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        bug(py, format!("an error of foldwell itself, please report it: {}", words.unwrap_or("no words")))
    })
}

/// Calls the callback; returns whether to go on.
fn tell(py: Python<'_>, callback: Option<&Py<PyAny>>, progress: &Progress) -> PyResult<bool> {
    py.check_signals()?;
    let Some(callback) = callback else { return Ok(true) };
    let residual = Some(progress.residual).filter(|residual| !residual.is_nan());
    let said = callback.bind(py).call1((&progress.study, progress.step, progress.of, residual))?;
    Ok(said.is_none() || said.is_truthy()?)
}

/// Stops all work and waits for it; the package calls this when the interpreter ends.
#[pyfunction]
pub(crate) fn stop_all(py: Python<'_>) {
    ENDING.store(true, Ordering::SeqCst);
    py.detach(|| {
        let clock = Instant::now();
        while AT_WORK.load(Ordering::SeqCst) > 0 && clock.elapsed() < FAREWELL {
            thread::sleep(Duration::from_millis(5));
        }
    });
}
