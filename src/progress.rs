//! Progress on standard error, and Ctrl-C.
//!
//! Nothing is shown where standard error is no terminal, and nothing during the first second of a study. The time left
//! is an estimate from the number of steps where that is known.
//!
//! Work is done on a thread of its own ([`Watch::over`]): it stops between two steps where it is asked to, and where a step
//! takes long the program ends without it.

use std::io;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use foldwell::run::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const PATIENCE: Duration = Duration::from_secs(1);
/// How long work may go on after Ctrl-C until its step ends, and how often it is looked at meanwhile.
const GRACE: Duration = Duration::from_millis(600);
const GLANCE: Duration = Duration::from_millis(20);
/// Memory for the calls of the work, in bytes: what the first thread of a program usually has.
const STACK: usize = 8 << 20;

/// Shows how far a run is, and stops it after Ctrl-C.
pub(crate) struct Watch {
    interrupted: Arc<AtomicBool>,
    shown: Option<Mutex<Shown>>,
}

struct Shown {
    bar: ProgressBar,
    study: String,
    since: Instant,
}

impl Watch {
    /// Begins to listen for Ctrl-C; `quiet`: shows nothing.
    pub(crate) fn new(quiet: bool) -> Self {
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = interrupted.clone();
        // where no handler can be set, Ctrl-C ends the program at once, as it does by default
        let _ = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(130); // the second Ctrl-C does not wait for the step to end
            }
        });
        let shown = (!quiet && console_is_terminal()).then(|| Mutex::new(Shown::new()));
        Self { interrupted, shown }
    }

    /// Whether Ctrl-C was pressed.
    pub(crate) fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Does some work on a thread of its own and gives what comes of it; `None` where Ctrl-C was pressed and the work does
    /// not end soon after it. A panic of the work is one here.
    pub(crate) fn over<T: Send + 'static>(
        self: &Arc<Self>,
        work: impl FnOnce(&Self) -> T + Send + 'static,
    ) -> io::Result<Option<T>> {
        let (sender, receiver) = channel();
        let watch = self.clone();
        let work = move || {
            // nobody waits for it any more where this fails
            let _ = sender.send(work(&watch));
        };
        let worker = thread::Builder::new().name("run".into()).stack_size(STACK).spawn(work)?;
        let mut stopped: Option<Instant> = None;
        loop {
            match receiver.recv_timeout(GLANCE) {
                Ok(found) => return Ok(Some(found)),
                Err(RecvTimeoutError::Disconnected) => match worker.join() {
                    Err(panic) => std::panic::resume_unwind(panic),
                    Ok(()) => return Ok(None),
                },
                Err(RecvTimeoutError::Timeout) if self.interrupted() => {
                    if stopped.get_or_insert_with(Instant::now).elapsed() > GRACE {
                        return Ok(None);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// Takes note of a step; breaks after Ctrl-C.
    pub(crate) fn step(&self, progress: &Progress) -> ControlFlow<()> {
        if let Some(shown) = &self.shown {
            shown.lock().unwrap_or_else(PoisonError::into_inner).step(progress);
        }
        if self.interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Removes what is shown.
    pub(crate) fn finish(&self) {
        if let Some(shown) = &self.shown {
            shown.lock().unwrap_or_else(PoisonError::into_inner).bar.finish_and_clear();
        }
    }
}

fn console_is_terminal() -> bool {
    std::io::IsTerminal::is_terminal(&std::io::stderr())
}

impl Shown {
    fn new() -> Self {
        Self { bar: ProgressBar::hidden(), study: String::new(), since: Instant::now() }
    }

    fn step(&mut self, progress: &Progress) {
        if self.study != progress.study {
            self.bar.finish_and_clear();
            *self = Self { study: progress.study.clone(), ..Self::new() };
        }
        if self.since.elapsed() < PATIENCE {
            return;
        }
        if self.bar.is_hidden() {
            self.bar = bar(progress.of).with_elapsed(self.since.elapsed());
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position(progress.step as u64);
        self.bar.set_message(message(progress));
    }
}

/// Study and residual.
fn message(progress: &Progress) -> String {
    if progress.residual.is_finite() {
        format!("{}  residual {:.1e}", progress.study, progress.residual)
    } else {
        progress.study.clone()
    }
}

/// A bar with the time left where the number of steps is known, otherwise a spinner with the time so far.
fn bar(steps: Option<usize>) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(steps.map(|steps| steps as u64), ProgressDrawTarget::hidden());
    let template = match steps {
        Some(_) => "{msg}  [{bar:30}] {pos}/{len}  {eta} left",
        None => "{spinner} {msg}  step {pos}, {elapsed}",
    };
    // a template that is not understood leaves the default style
    bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without a terminal nothing is shown; a step goes on until Ctrl-C was pressed, and no longer.
    #[test]
    fn a_watch_stops_after_an_interrupt() {
        let watch = Watch { interrupted: Arc::default(), shown: Some(Mutex::new(Shown::new())) };
        let progress = Progress { study: "a".into(), step: 1, of: None, residual: 0.1 };
        assert_eq!(watch.step(&progress), ControlFlow::Continue(()));
        assert!(watch.shown.as_ref().unwrap().lock().unwrap().bar.is_hidden());
        watch.interrupted.store(true, Ordering::Relaxed);
        assert_eq!(watch.step(&progress), ControlFlow::Break(()));
    }

    /// Claim: what the work gives comes back; a panic of the work is not lost; work that goes on after Ctrl-C is left alone,
    /// and what it sees of it is that it should stop. Without leaving it alone the second one here would never end.
    #[test]
    fn work_is_waited_for_unless_interrupted() {
        let watch = Arc::new(Watch { interrupted: Arc::default(), shown: None });
        assert_eq!(watch.over(|_| 7).unwrap(), Some(7));
        let lost = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| watch.over(|_| -> u8 { panic!("lost") })));
        assert_eq!(lost.unwrap_err().downcast_ref::<&str>(), Some(&"lost"));
        let (hold, held) = channel::<()>();
        let stuck = move |watch: &Watch| {
            watch.interrupted.store(true, Ordering::Relaxed);
            held.recv().is_ok()
        };
        assert_eq!(watch.over(stuck).unwrap(), None);
        drop(hold);
        assert_eq!(watch.over(|watch| watch.interrupted()).unwrap(), Some(true), "it ends soon");
    }

    /// The residual is shown where there is one.
    #[test]
    fn messages() {
        let progress = Progress { study: "a".into(), step: 2, of: None, residual: 1e-3 };
        assert_eq!(message(&progress), "a  residual 1.0e-3");
        assert_eq!(message(&Progress { residual: f64::NAN, ..progress }), "a");
    }

    /// Both templates are understood.
    #[test]
    fn templates_are_right() {
        for steps in [None, Some(7)] {
            assert_eq!(bar(steps).length(), steps.map(|n| n as u64));
        }
    }
}
