//! Progress on standard error, and Ctrl-C.
//!
//! Nothing is shown where standard error is no terminal, and nothing during the first second of a study.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use foldwell::run::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const PATIENCE: Duration = Duration::from_secs(1);

/// Shows how far a run is, and stops it after Ctrl-C.
pub struct Watch {
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
        self.bar.set_message(format!("{}  residual {:.1e}", progress.study, progress.residual));
    }
}

/// A bar with the time left where the number of steps is known, otherwise a spinner with the time so far.
fn bar(steps: Option<usize>) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(steps.map(|steps| steps as u64), ProgressDrawTarget::hidden());
    let template = match steps {
        Some(_) => "{msg}  [{bar:30}] {pos}/{len}  {eta} left",
        None => "{spinner} {msg}  step {pos}  {elapsed}",
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

    /// Both templates are understood.
    #[test]
    fn templates_are_right() {
        for steps in [None, Some(7)] {
            assert_eq!(bar(steps).length(), steps.map(|n| n as u64));
        }
    }
}
