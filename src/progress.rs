//! Progress on standard error, and Ctrl-C.
//!
//! Nothing is shown where standard error is no terminal, and nothing during the first second of a study. The time left
//! is always an estimate: from the number of steps where it is known, otherwise from the decrease of the residual; where
//! nothing can be said there is a question mark.
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
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

const PATIENCE: Duration = Duration::from_secs(1);
/// How long work may go on after Ctrl-C until its step ends, and how often it is looked at meanwhile.
const GRACE: Duration = Duration::from_millis(600);
const GLANCE: Duration = Duration::from_millis(20);
/// Memory for the calls of the work, in bytes: what the first thread of a program usually has.
const STACK: usize = 8 << 20;
/// Steps from which the time left is estimated.
const RECENT: usize = 4;
/// An estimate of more steps than this is none.
const MOST_STEPS: u32 = 100;

/// Shows how far a run is, and stops it after Ctrl-C.
pub struct Watch {
    interrupted: Arc<AtomicBool>,
    shown: Option<Mutex<Shown>>,
}

struct Shown {
    bar: ProgressBar,
    study: String,
    since: Instant,
    /// Time of every step since the study began, and the residual after it.
    seen: Vec<(Duration, f64)>,
}

impl Watch {
    /// Begins to listen for Ctrl-C; `quiet`: shows nothing.
    pub fn new(quiet: bool) -> Self {
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
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Does some work on a thread of its own and gives what comes of it; `None` where Ctrl-C was pressed and the work does
    /// not end soon after it. A panic of the work is one here.
    pub fn over<T: Send + 'static>(
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
    pub fn step(&self, progress: &Progress) -> ControlFlow<()> {
        if let Some(shown) = &self.shown {
            shown.lock().unwrap_or_else(PoisonError::into_inner).step(progress);
        }
        if self.interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Removes what is shown.
    pub fn finish(&self) {
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
        Self { bar: ProgressBar::hidden(), study: String::new(), since: Instant::now(), seen: Vec::new() }
    }

    fn step(&mut self, progress: &Progress) {
        if self.study != progress.study {
            self.bar.finish_and_clear();
            *self = Self { study: progress.study.clone(), ..Self::new() };
        }
        self.seen.push((self.since.elapsed(), progress.residual));
        if self.since.elapsed() < PATIENCE {
            return;
        }
        if self.bar.is_hidden() {
            self.bar = bar(progress.of).with_elapsed(self.since.elapsed());
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_position(progress.step as u64);
        self.bar.set_message(message(progress, &self.seen));
    }
}

/// Study and residual, and where the number of steps is not known the time left.
fn message(progress: &Progress, seen: &[(Duration, f64)]) -> String {
    let mut text = progress.study.clone();
    if progress.residual.is_finite() {
        text += &format!("  residual {:.1e}", progress.residual);
    }
    if progress.of.is_none() {
        let left = progress.target.and_then(|target| time_left(seen, target));
        text += &left.map_or("  ? left".to_owned(), |left| format!("  about {:#} left", HumanDuration(left)));
    }
    text
}

/// Estimate of the time until the residual is at its target: the steps that are still expected, each as long as the
/// last few. `None` where the last step made the residual no smaller, or the target is too far away to tell.
fn time_left(seen: &[(Duration, f64)], target: f64) -> Option<Duration> {
    let recent = &seen[seen.len().saturating_sub(RECENT)..];
    let (first, last) = (recent.first()?, recent.last()?);
    let gains: Vec<f64> = recent.windows(2).map(|pair| (pair[0].1 / pair[1].1).ln()).collect();
    let steps = steps_left(&gains, (last.1 / target).ln())?;
    Some((last.0 - first.0) * steps / gains.len() as u32)
}

/// Steps until the logarithm of the residual has fallen by `open`, where the last steps made it fall by `gains`.
///
/// Every step is taken to gain as much more than the one before it as the last one did: as much in linear convergence,
/// twice as much in quadratic convergence, and nothing outside of these.
fn steps_left(gains: &[f64], open: f64) -> Option<u32> {
    let (&last, before) = gains.split_last()?;
    let growth = before.last().filter(|before| **before > 0.0).map_or(1.0, |before| (last / before).clamp(1.0, 2.0));
    let (mut gain, mut gained) = (last, 0.0);
    for steps in 0..=MOST_STEPS {
        if gained >= open {
            return Some(steps);
        }
        gain *= growth;
        gained += if gain > 0.0 { gain } else { return None };
    }
    None
}

/// A bar with the time left where the number of steps is known, otherwise a spinner with the time so far; there the
/// message has the estimate.
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
        let progress = Progress { study: "a".into(), step: 1, of: None, residual: 0.1, target: None };
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

    /// A step every two seconds with these residuals.
    fn steps(residuals: &[f64]) -> Vec<(Duration, f64)> {
        residuals.iter().enumerate().map(|(k, residual)| (Duration::from_secs(2 * k as u64), *residual)).collect()
    }

    /// Claim: the estimate is right where the convergence is what it is taken for. Linear, a decade a step, six decades
    /// to go: six steps. Quadratic, 1e-1, 1e-2, 1e-4: then 1e-8 and 1e-16, two steps. From 1e-1 over 1e-2 to 1e-8 is
    /// more than quadratic and taken for that: one step. Only the last two gains decide.
    #[test]
    fn steps_are_extrapolated() {
        let left = |residuals: &[f64]| time_left(&steps(residuals), 1e-12).map(|left| left.as_secs_f64());
        assert_eq!(left(&[1e-3, 1e-4, 1e-5, 0.999e-6]), Some(12.0));
        assert_eq!(left(&[1.0, 1e-1, 1e-2, 1e-4]), Some(4.0));
        assert_eq!(left(&[1e-1, 1e-2, 1e-8]), Some(2.0));
        assert_eq!(left(&[5.0, 7.0, 1.0, 1e-3, 0.999e-6, 0.999e-9]), Some(2.0));
        assert_eq!(left(&[1e-1, 1e-13]), Some(0.0));
    }

    /// Claim: the time of a step is that of the last ones: three steps of one second after a first one of a minute.
    #[test]
    fn a_slow_beginning_is_forgotten() {
        let seen = [(0, 1e-1), (60, 1e-2), (61, 1e-3), (62, 1e-4), (63, 0.999e-5)];
        let seen = seen.map(|(seconds, residual)| (Duration::from_secs(seconds), residual));
        assert_eq!(time_left(&seen, 1e-12), Some(Duration::from_secs(7)));
    }

    /// Claim: nothing is said after one step, where the residual does not fall or is no number, and where hundreds of
    /// steps would be needed; nor where there is no target.
    #[test]
    fn where_nothing_can_be_said() {
        for residuals in [&[][..], &[0.1], &[0.1, 0.1], &[0.1, 0.2], &[0.1, f64::NAN], &[f64::NAN, 0.1], &[0.1, 0.099]]
        {
            assert_eq!(time_left(&steps(residuals), 1e-12), None, "{residuals:?}");
        }
        let progress = |target| Progress { study: "a".into(), step: 2, of: None, residual: 1e-3, target };
        let seen = steps(&[1e-1, 1e-2, 1e-3]);
        assert_eq!(message(&progress(None), &seen), "a  residual 1.0e-3  ? left");
        assert_eq!(message(&progress(Some(0.9e-6)), &seen), "a  residual 1.0e-3  about 8s left");
        let counted = Progress { of: Some(9), residual: f64::NAN, ..progress(None) };
        assert_eq!(message(&counted, &[]), "a");
    }

    /// Both templates are understood.
    #[test]
    fn templates_are_right() {
        for steps in [None, Some(7)] {
            assert_eq!(bar(steps).length(), steps.map(|n| n as u64));
        }
    }
}
