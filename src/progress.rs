//! Progress on standard error, and Ctrl-C.
//!
//! Nothing is shown if standard error is not a terminal, nor during the first second of a study. The remaining time is
//! estimated from the number of steps if that is known.
//!
//! The work runs on a separate thread ([`ProgressWatch::over`]). After Ctrl-C it stops between two steps; if a step
//! takes long, the program ends without waiting for it. Work that has stopped, or has taken all its steps, is waited
//! for, however long it takes to draw and write what was computed: a second Ctrl-C ends the program at once.

use std::io::{self, IsTerminal};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use foldwell::run::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const PATIENCE: Duration = Duration::from_secs(1);
/// Time for which the program waits after Ctrl-C for the current step to end, and interval between two checks.
const GRACE: Duration = Duration::from_millis(600);
const GLANCE: Duration = Duration::from_millis(20);
/// Stack size of the working thread in bytes: the usual one of the first thread of a program.
const STACK: usize = 8 << 20;

/// Shows the progress of a run, and stops it after Ctrl-C.
pub(crate) struct ProgressWatch {
    interrupted: Arc<AtomicBool>,
    /// Whether the work has been told to stop, or has taken all steps.
    ending: AtomicBool,
    shown: Option<Mutex<ShownProgress>>,
}

struct ShownProgress {
    bar: ProgressBar,
    study: String,
    since: Instant,
}

impl ProgressWatch {
    /// Starts to listen for Ctrl-C; shows nothing if `quiet`.
    pub(crate) fn new(quiet: bool) -> Self {
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = interrupted.clone();
        // if no handler can be set, Ctrl-C ends the program at once, as by default
        let _ = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(130); // the second Ctrl-C does not wait for the step to end
            }
        });
        let shown = (!quiet && std::io::stderr().is_terminal()).then(|| Mutex::new(ShownProgress::new()));
        Self { interrupted, ending: AtomicBool::new(false), shown }
    }

    /// Whether Ctrl-C was pressed.
    pub(crate) fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Runs some work on a separate thread and returns its result; `None` if Ctrl-C was pressed and the work does not
    /// reach the end of its step soon after that. A panic of the work is passed on.
    pub(crate) fn over<T: Send + 'static>(
        self: &Arc<Self>,
        work: impl FnOnce(&Self) -> T + Send + 'static,
    ) -> io::Result<Option<T>> {
        let (sender, receiver) = channel();
        let watch = self.clone();
        let work = move || {
            // fails if the result is no longer awaited
            let _ = sender.send(work(&watch));
        };
        let worker = thread::Builder::new().name("run".into()).stack_size(STACK).spawn(work)?;
        let (mut stopped, mut announced): (Option<Instant>, bool) = (None, false);
        loop {
            match receiver.recv_timeout(GLANCE) {
                Ok(found) => return Ok(Some(found)),
                Err(RecvTimeoutError::Disconnected) => match worker.join() {
                    Err(panic) => std::panic::resume_unwind(panic),
                    Ok(()) => return Ok(None),
                },
                Err(RecvTimeoutError::Timeout) if self.interrupted() => {
                    let is_late = stopped.get_or_insert_with(Instant::now).elapsed() > GRACE;
                    if is_late && !self.ending.load(Ordering::Relaxed) {
                        return Ok(None);
                    }
                    if is_late && !announced {
                        self.announce_writing();
                        announced = true;
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// Shows a step; returns `Break` after Ctrl-C.
    pub(crate) fn step(&self, progress: &Progress) -> ControlFlow<()> {
        let (stops, all_taken) = (self.interrupted(), progress.all_taken());
        self.ending.store(stops || all_taken, Ordering::Relaxed);
        if let Some(shown) = self.shown.as_ref().filter(|_| !all_taken) {
            shown.lock().unwrap_or_else(PoisonError::into_inner).step(progress);
        }
        if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Says in place of the progress bar why the program has not ended yet.
    fn announce_writing(&self) {
        if self.shown.is_some() {
            self.finish();
            eprintln!("stopped; what was computed is being written, Ctrl-C again ends at once");
        }
    }

    /// Removes the progress bar.
    pub(crate) fn finish(&self) {
        if let Some(shown) = &self.shown {
            shown.lock().unwrap_or_else(PoisonError::into_inner).bar.finish_and_clear();
        }
    }
}

impl ShownProgress {
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

/// Returns the text of the progress bar: study, per cent of the way, and residual.
fn message(progress: &Progress) -> String {
    let mut text = progress.study.clone();
    if progress.part.is_finite() {
        text += &format!("  {:.0} %", 100.0 * progress.part.clamp(0.0, 1.0));
    }
    if progress.residual.is_finite() {
        text += &format!("  residual {:.1e}", progress.residual);
    }
    text
}

/// Returns a bar with the remaining time if the number of steps is known, otherwise a spinner with the elapsed time.
fn bar(steps: Option<usize>) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(steps.map(|steps| steps as u64), ProgressDrawTarget::hidden());
    let template = match steps {
        Some(_) => "{msg}  [{bar:30}] {pos}/{len}  {eta} left",
        None => "{spinner} {msg}  step {pos}, {elapsed}",
    };
    // if the template is invalid, the default style is kept
    bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: without a terminal nothing is shown; steps go on until Ctrl-C is pressed and stop then.
    #[test]
    fn a_watch_stops_after_an_interrupt() {
        let watch = ProgressWatch {
            interrupted: Arc::default(),
            ending: AtomicBool::new(false),
            shown: Some(Mutex::new(ShownProgress::new())),
        };
        let progress = Progress { study: "a".into(), step: 1, of: None, residual: 0.1, part: f64::NAN };
        assert_eq!(watch.step(&progress), ControlFlow::Continue(()));
        assert!(watch.shown.as_ref().unwrap().lock().unwrap().bar.is_hidden());
        watch.interrupted.store(true, Ordering::Relaxed);
        assert_eq!(watch.step(&progress), ControlFlow::Break(()));
    }

    /// Claim: the result of the work is returned; a panic of the work is passed on; work that goes on after Ctrl-C is
    /// left alone and is told to stop. If it were not left alone, the second work here would never end.
    #[test]
    fn work_is_waited_for_unless_interrupted() {
        let watch =
            Arc::new(ProgressWatch { interrupted: Arc::default(), ending: AtomicBool::new(false), shown: None });
        assert_eq!(watch.over(|_| 7).unwrap(), Some(7));
        let lost = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| watch.over(|_| -> u8 { panic!("lost") })));
        assert_eq!(lost.unwrap_err().downcast_ref::<&str>(), Some(&"lost"));
        let (hold, held) = channel::<()>();
        let stuck = move |watch: &ProgressWatch| {
            watch.interrupted.store(true, Ordering::Relaxed);
            held.recv().is_ok()
        };
        assert_eq!(watch.over(stuck).unwrap(), None);
        drop(hold);
        assert_eq!(watch.over(|watch| watch.interrupted()).unwrap(), Some(true), "it ends soon");
    }

    /// Claim: work that was told to stop, or has taken all steps when Ctrl-C is pressed, is waited for longer than a step
    /// that does not end: what it has computed is not lost.
    #[test]
    fn work_that_has_stopped_may_write_for_long() {
        for of in [None, Some(0)] {
            let watch =
                Arc::new(ProgressWatch { interrupted: Arc::default(), ending: AtomicBool::new(false), shown: None });
            let writes_for_long = move |watch: &ProgressWatch| {
                watch.interrupted.store(of.is_none(), Ordering::Relaxed);
                let stopped =
                    watch.step(&Progress { study: "a".into(), step: 1, of, residual: 0.1, part: f64::NAN }).is_break();
                watch.interrupted.store(true, Ordering::Relaxed);
                thread::sleep(3 * GRACE);
                stopped
            };
            assert_eq!(watch.over(writes_for_long).unwrap(), Some(of.is_none()));
        }
    }

    /// Claim: the residual and the part of the way are shown if they are known.
    #[test]
    fn messages() {
        let progress = Progress { study: "a".into(), step: 2, of: None, residual: 1e-3, part: f64::NAN };
        assert_eq!(message(&progress), "a  residual 1.0e-3");
        assert_eq!(message(&Progress { part: 0.425, ..progress.clone() }), "a  42 %  residual 1.0e-3");
        assert_eq!(message(&Progress { residual: f64::NAN, ..progress }), "a");
    }

    /// Claim: both templates are valid.
    #[test]
    fn templates_are_right() {
        for steps in [None, Some(7)] {
            assert_eq!(bar(steps).length(), steps.map(|n| n as u64));
        }
    }
}
