//! Long work beside Python: other threads go on, Ctrl-C and the end of the interpreter stop it, and a callback hears of
//! its progress.

use crate::errors::bug;
use foldwell::run::{Observer, Progress};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::io;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two looks at signals.
const PATIENCE: Duration = Duration::from_millis(50);
/// Stack size of the working thread in bytes, as in the program.
const STACK: usize = 8 << 20;
/// Longest time that the end of the interpreter waits for threads of Python.
const FAREWELL: Duration = Duration::from_secs(5);

/// Whether the interpreter is about to end.
static ENDING: AtomicBool = AtomicBool::new(false);
/// Number of threads of Python that wait for work.
static AT_WORK: AtomicUsize = AtomicUsize::new(0);

/// A message of the working thread to the waiting one.
enum News<R> {
    /// A step, and what the working thread waits for: it goes on when this sender is dropped.
    Progress(Progress, Sender<()>),
    /// It has ended, with its result or the words of a panic.
    Done(Result<R, String>),
}

/// Does some work on a thread of its own while the calling thread, which lets other Python threads run, calls
/// `progress(study, step, of, residual)` after every step, for which the work waits. If the callback returns `False`,
/// the work stops after that step and its result is returned. At Ctrl-C, at an exception in the callback and when the
/// interpreter ends, the exception is raised at once; the thread, which never touches Python, ends after its step by
/// itself.
pub(crate) fn watched<R: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Observer<'_>) -> R + Send + 'static,
) -> PyResult<R> {
    let callback = progress.map(|callback| callback.clone().unbind());
    let stop = Arc::new(AtomicBool::new(false));
    let receiver = spawned(work, callback.is_some(), stop.clone())?;
    AT_WORK.fetch_add(1, Ordering::SeqCst);
    let waited = py.detach(move || wait(&receiver, callback.as_ref(), &stop));
    AT_WORK.fetch_sub(1, Ordering::SeqCst);
    waited?.map_err(|words| bug(py, format!("an error of foldwell itself, please report it: {words}")))
}

/// Starts the work, which sends its progress if someone listens, and its end.
fn spawned<R: Send + 'static>(
    work: impl FnOnce(Observer<'_>) -> R + Send + 'static,
    listens: bool,
    stop: Arc<AtomicBool>,
) -> io::Result<Receiver<News<R>>> {
    let (sender, receiver) = mpsc::channel();
    let worker = move || {
        let observer = |progress: &Progress| {
            if listens && !progress.all_taken() {
                let (told, waiting) = mpsc::channel();
                let _ = sender.send(News::Progress(progress.clone(), told)); // nobody hears it after Ctrl-C
                let _ = waiting.recv();
            }
            if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let done = catch_unwind(AssertUnwindSafe(|| work(&observer))).map_err(|panic| {
            let words = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
            words.unwrap_or("no words").to_owned()
        });
        let _ = sender.send(News::Done(done));
    };
    thread::Builder::new().stack_size(STACK).spawn(worker).map(|_| receiver)
}

/// Waits for the end of the work, or for a reason not to wait for it.
fn wait<R>(
    receiver: &Receiver<News<R>>,
    callback: Option<&Py<PyAny>>,
    stop: &AtomicBool,
) -> PyResult<Result<R, String>> {
    loop {
        let step = match receiver.recv_timeout(PATIENCE) {
            Ok(News::Done(done)) => return Ok(done),
            Ok(News::Progress(progress, told)) => Some((progress, told)), // dropped when it is known whether to stop
            Err(_) => None,
        };
        let heard = Python::attach(|py| tell(py, callback, step.as_ref().map(|(progress, _)| progress)));
        let ending = ENDING.load(Ordering::Relaxed).then(|| PyKeyboardInterrupt::new_err("the interpreter ends"));
        if !matches!(heard, Ok(true)) || ending.is_some() {
            stop.store(true, Ordering::Relaxed);
            heard?;
            ending.map_or(Ok(()), Err)?;
        }
    }
}

/// Looks at signals and calls the callback after a step; returns whether to go on.
fn tell(py: Python<'_>, callback: Option<&Py<PyAny>>, step: Option<&Progress>) -> PyResult<bool> {
    py.check_signals()?;
    let (Some(callback), Some(progress)) = (callback, step) else { return Ok(true) };
    let residual = Some(progress.residual).filter(|residual| !residual.is_nan());
    let said = callback.bind(py).call1((&progress.study, progress.step, progress.of, residual))?;
    Ok(said.is_none() || said.is_truthy()?)
}

/// Ends the waiting for work; the package calls this when the interpreter ends.
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
